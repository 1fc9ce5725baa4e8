// Balls as the device has them (balls/mod.rs): group 1; and how they are lit.
#import light

@group(1) @binding(0) var<uniform> style: BallUniforms;
@group(1) @binding(1) var colours: texture_2d<f32>;
@group(1) @binding(2) var<storage, read> balls: array<BallInstance>;

struct Hit {
    position: vec3f,
    normal: vec3f,
}

// Position and radius as drawn.
fn sphere(number: u32) -> vec4f {
    let ball = balls[number];
    let centre = vec3f(ball.x, ball.y, ball.z);
    return vec4f(centre, max(ball.radius, style.least * pixel_at(centre)));
}

// The same for all corners of a ball that is none, beyond what is seen.
const NOWHERE = vec4f(2.0, 2.0, 2.0, 1.0);

fn is_there(number: u32) -> bool {
    return balls[number].radius >= 0.0;
}

fn colour_of(number: u32) -> vec3f {
    let part = clamp((balls[number].value - style.low) / (style.high - style.low), 0.0, 1.0);
    return textureLoad(colours, vec2i(i32(part * 255.0 + 0.5), 0), 0).rgb;
}

// Corners of the triangle with sides of the same length round a circle of radius 1. A ball is one triangle rather than the two of a
// square: it covers a third more, and costs half as much to set up, which is what many small balls cost. All are drawn in one go, for
// software in place of a GPU is slow at instances of few corners: a ball's number is that of its corner, over 3.
fn corner_of(vertex: u32) -> vec2f {
    let side = f32(vertex % 3u) - 1.0;
    return vec2f(sqrt(3.0) * side, select(-1.0, 2.0, side == 0.0));
}

// How a sphere is seen: the line of sight through its middle, what is to the right and up, and the radius of its outline.
struct Round {
    sight: vec3f,
    right: vec3f,
    up: vec3f,
    reach: f32,
}

fn round_of(ball: vec4f) -> Round {
    let sight = ray_through(ball.xyz).direction;
    // The cone of lines that touch the sphere cuts the plane through its centre in a larger circle.
    let distance = length(ball.xyz - view.eye.xyz);
    let wider = distance / sqrt(max(distance * distance - ball.w * ball.w, 1e-12));
    let aside = select(vec3f(0.0, 0.0, 1.0), vec3f(1.0, 0.0, 0.0), abs(sight.z) > 0.9);
    let right = normalize(cross(sight, aside));
    return Round(sight, right, cross(right, sight), ball.w * select(1.0, wider, view.eye.w > 0.5));
}

// From the middle of a sphere to the nearest point of a line of sight.
fn beside(sight: Ray, ball: vec4f) -> vec3f {
    let from_centre = sight.origin - ball.xyz;
    return from_centre - dot(from_centre, sight.direction) * sight.direction;
}

// Where a line of sight meets a sphere, or its rim where it just misses.
fn hit(sight: Ray, ball: vec4f) -> Hit {
    let aside = beside(sight, ball);
    let inside = max(ball.w * ball.w - dot(aside, aside), 0.0);
    let normal = (aside - sqrt(inside) * sight.direction) / ball.w;
    return Hit(ball.xyz + ball.w * normal, normal);
}

fn shaded(found: Hit, colour: vec3f, sight: Ray, pixel: vec2f) -> Drawn {
    let shine = sunshine(found.position, found.normal, pixel);
    return Drawn(vec4f(coated(colour, found.normal, -sight.direction, shine, style.gloss), 1.0), depth_at(found.position));
}

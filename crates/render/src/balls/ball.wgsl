// Balls as the device has them (balls/mod.rs): group 1; and how they are lit.
#import light

struct Ball {
    x: f32,
    y: f32,
    z: f32,
    radius: f32,
    value: f32,
}

struct Style {
    // The numbers of the first and last colour; part of light that the coat mirrors; least radius, pixels.
    low: f32,
    high: f32,
    gloss: f32,
    least: f32,
}

@group(1) @binding(0) var<uniform> style: Style;
@group(1) @binding(1) var colours: texture_2d<f32>;
@group(1) @binding(2) var<storage, read> balls: array<Ball>;

struct Hit {
    place: vec3f,
    normal: vec3f,
}

// Place and radius as drawn.
fn sphere(number: u32) -> vec4f {
    let ball = balls[number];
    let centre = vec3f(ball.x, ball.y, ball.z);
    return vec4f(centre, max(ball.radius, style.least * pixel_at(centre)));
}

fn colour_of(number: u32) -> vec3f {
    let part = clamp((balls[number].value - style.low) / (style.high - style.low), 0.0, 1.0);
    return textureLoad(colours, vec2i(i32(part * 255.0 + 0.5), 0), 0).rgb;
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

struct Drawn {
    @location(0) colour: vec4f,
    @builtin(frag_depth) depth: f32,
}

fn shaded(found: Hit, colour: vec3f, sight: Ray, pixel: vec2f) -> Drawn {
    let shine = sunshine(found.place, found.normal, pixel);
    return Drawn(vec4f(coated(colour, found.normal, -sight.direction, shine, style.gloss), 1.0), depth_at(found.place));
}

// Balls: a square facing the eye for each, the sphere found pixel by pixel along the line of sight. Flat discs on paper.
#import light

struct Style {
    // The numbers of the first and last colour; part of light that the coat mirrors; least radius, pixels.
    low: f32,
    high: f32,
    gloss: f32,
    least: f32,
}

@group(1) @binding(0) var<uniform> style: Style;
@group(1) @binding(1) var colours: texture_2d<f32>;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) place: vec3f,
    @location(1) @interpolate(flat) ball: vec4f,
    @location(2) @interpolate(flat) colour: vec3f,
}

struct Hit {
    place: vec3f,
    normal: vec3f,
}

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @location(0) ball: vec4f,
    @location(1) value: f32,
) -> Corner {
    let centre = ball.xyz;
    let radius = max(ball.w, style.least * pixel_at(centre));
    let sight = ray_through(centre);
    // The cone of lines that touch the sphere cuts the plane through its centre in a larger circle.
    var reach = radius;
    if view.eye.w > 0.5 {
        let distance = length(centre - view.eye.xyz);
        reach = radius * distance / sqrt(max(distance * distance - radius * radius, 1e-12));
    }
    let aside = select(vec3f(0.0, 0.0, 1.0), vec3f(1.0, 0.0, 0.0), abs(sight.direction.z) > 0.9);
    let right = normalize(cross(sight.direction, aside));
    let up = cross(right, sight.direction);
    let corner = 2.0 * vec2f(f32(index & 1u), f32(index >> 1u)) - 1.0;
    let place = centre + reach * (corner.x * right + corner.y * up);
    let part = clamp((value - style.low) / (style.high - style.low), 0.0, 1.0);
    let colour = textureLoad(colours, vec2i(i32(part * 255.0 + 0.5), 0), 0).rgb;
    return Corner(view.clip_from_world * vec4f(place, 1.0), place, vec4f(centre, radius), colour);
}

// Where the line of sight through a place meets the sphere; nothing is drawn where it does not.
fn hit(place: vec3f, ball: vec4f) -> Hit {
    let sight = ray_through(place);
    let from_centre = sight.origin - ball.xyz;
    let along = dot(from_centre, sight.direction);
    let aside = from_centre - along * sight.direction;
    let inside = ball.w * ball.w - dot(aside, aside);
    if inside < 0.0 {
        discard;
    }
    let normal = (aside - sqrt(inside) * sight.direction) / ball.w;
    return Hit(ball.xyz + ball.w * normal, normal);
}

struct Drawn {
    @location(0) colour: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment(corner: Corner) -> Drawn {
    let found = hit(corner.place, corner.ball);
    if is_paper() {
        // A darker rim, a pixel of the finished picture wide and narrower on small ones.
        let edge = length(corner.place - corner.ball.xyz);
        let inner = corner.ball.w - min(2.4 * view.forward.w, 0.3 * corner.ball.w);
        let rim = smoothstep(inner - 0.5 * view.forward.w, inner + 0.5 * view.forward.w, edge);
        let large = smoothstep(1.5, 8.0, corner.ball.w / view.forward.w);
        return Drawn(vec4f(mix(corner.colour, 0.35 * corner.colour, rim * large), 1.0), depth_at(corner.ball.xyz));
    }
    let sight = ray_through(found.place);
    let shine = sunshine(found.place, found.normal, corner.clip.xy);
    let colour = coated(corner.colour, found.normal, -sight.direction, shine, style.gloss);
    return Drawn(vec4f(colour, 1.0), depth_at(found.place));
}

@fragment
fn throw_shadow(corner: Corner) -> @builtin(frag_depth) f32 {
    return depth_at(hit(corner.place, corner.ball).place);
}

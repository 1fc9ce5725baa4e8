// A particle as a quad that just covers it. Particles are balls, or flattened along a direction.
#import view

struct Sprite {
    @builtin(position) clip: vec4f,
    // A position on the quad, from the particle's middle.
    @location(0) offset: vec3f,
    @location(1) @interpolate(flat) middle: vec3f,
    @location(2) @interpolate(flat) radius: f32,
    @location(3) @interpolate(flat) normal: vec3f,
    @location(4) @interpolate(flat) flatness: f32,
    @location(5) @interpolate(flat) matter: vec4f,
    @location(6) @interpolate(flat) flow: vec2f,
}

// The quad round a particle, in the plane across the line of sight to its middle.
struct Quad {
    middle: vec3f,
    // From its middle to the middles of two sides.
    across: vec3f,
    up: vec3f,
    // Radius and flatness of what is drawn on it.
    radius: f32,
    flatness: f32,
}

// The quad round a particle of this radius.
fn quad_round(droplet: DropletInstance, radius: f32, flatness: f32) -> Quad {
    // No smaller than a pixel, or it would fall between them.
    let least = 0.75 * pixel_at(droplet.position);
    let wide = max(radius, least);
    let sight = ray_through(droplet.position).direction;
    let cosine = dot(droplet.normal, sight);
    let lean = cross(droplet.normal, sight);
    // Seen along its normal, any direction across will do.
    let other = select(vec3f(0.0, 1.0, 0.0), vec3f(1.0, 0.0, 0.0), abs(sight.x) < 0.6);
    let along = normalize(select(cross(sight, other), lean, dot(lean, lean) > 1e-8));
    let high = max(wide * sqrt(cosine * cosine + flatness * flatness * (1.0 - cosine * cosine)), least);
    // With perspective one sees past the middle: the outline is wider than the ball.
    let distance = max(length(droplet.position - view.eye.xyz), 1e-6);
    let sine = min(wide / distance, 0.95);
    let wider = select(1.0, inverseSqrt(1.0 - sine * sine), view.eye.w > 0.5);
    return Quad(
        droplet.position,
        wider * wide * along,
        wider * high * cross(sight, along),
        wide,
        max(flatness, least / wide * 0.1),
    );
}

// A position on the quad, `offset` from its middle.
fn sprite_at(droplet: DropletInstance, quad: Quad, offset: vec3f) -> Sprite {
    var out = Sprite();
    out.clip = view.clip_from_world * vec4f(quad.middle + offset, 1.0);
    out.offset = offset;
    out.middle = quad.middle;
    out.radius = quad.radius;
    out.normal = droplet.normal;
    out.flatness = quad.flatness;
    out.matter = droplet.matter;
    out.flow = droplet.flow;
    return out;
}

// Corner `index` of a quad, from its middle.
fn corner_of(quad: Quad, index: u32) -> vec3f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u)) * 2.0 - 1.0;
    return corner.x * quad.across + corner.y * quad.up;
}

// Where the line of sight through a position on the quad enters and leaves the particle, as lengths from that position; the first
// is greater than the second where it misses.
fn crossing(in: Sprite, direction: vec3f) -> vec2f {
    // In coordinates stretched along the normal the particle is a ball.
    let stretch = (1.0 / in.flatness - 1.0) * in.normal;
    let start = in.offset + dot(in.normal, in.offset) * stretch;
    let to = direction + dot(in.normal, direction) * stretch;
    let a = dot(to, to);
    let b = dot(start, to);
    let inside = b * b - a * (dot(start, start) - in.radius * in.radius);
    if inside < 0.0 {
        return vec2f(1.0, -1.0);
    }
    return (vec2f(-1.0, 1.0) * sqrt(inside) - b) / a;
}

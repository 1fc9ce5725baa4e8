// The nearest surface of all particles: its distance along the line of sight of the picture's middle.
#import droplet
#import fluid

struct Nearest {
    @location(0) distance: f32,
    @builtin(frag_depth) depth: f32,
}

@vertex
fn vertex(droplet: Droplet, @builtin(vertex_index) index: u32) -> Sprite {
    return sprite(droplet, index, droplet.radius, droplet.flatness);
}

@fragment
fn fragment(in: Sprite) -> Nearest {
    let direction = ray_through(in.middle + in.offset).direction;
    let hit = crossing(in, direction);
    if hit.x > hit.y {
        discard;
    }
    let place = in.middle + in.offset + hit.x * direction;
    if any(place.xy < fluid.within.xy) || any(place.xy > fluid.within.zw) {
        discard;
    }
    return Nearest(dot(place - view.eye.xyz, view.forward.xyz), depth_at(place));
}

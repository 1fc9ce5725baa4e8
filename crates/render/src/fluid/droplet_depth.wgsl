// The nearest surface of a particle: for sprites (fluid_depth.wgsl) and splats (splat_depth.wgsl).
#import droplet
#import fluid

// The quad on which a particle's surface is seen.
fn surface_quad(droplet: DropletInstance) -> Quad {
    return quad_round(droplet, droplet.radius, droplet.flatness);
}

struct Surface {
    place: vec3f,
    // Whether the line of sight meets it, within what is drawn.
    met: bool,
}

// The surface in the line of sight through a place on the quad.
fn surface_at(in: Sprite) -> Surface {
    let direction = ray_through(in.middle + in.offset).direction;
    let hit = crossing(in, direction);
    let place = in.middle + in.offset + hit.x * direction;
    let within = all(place.xy >= fluid.within.xy) && all(place.xy <= fluid.within.zw);
    return Surface(place, hit.x <= hit.y && within);
}

// Distance of a place along the line of sight of the picture's middle.
fn distance_of(place: vec3f) -> f32 {
    return dot(place - view.eye.xyz, view.forward.xyz);
}

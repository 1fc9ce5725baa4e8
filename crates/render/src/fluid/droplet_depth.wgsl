// The nearest surface of a particle: for sprites (fluid_depth.wgsl) and splats (splat_depth.wgsl).
#import droplet
#import fluid

// The quad on which a particle's surface is seen.
fn surface_quad(droplet: DropletInstance) -> Quad {
    return quad_round(droplet, droplet.radius, droplet.flatness);
}

struct Surface {
    position: vec3f,
    // Whether the line of sight meets it, within what is drawn.
    met: bool,
}

// The surface in the line of sight through a position on the quad.
fn surface_at(in: Sprite) -> Surface {
    let direction = ray_through(in.middle + in.offset).direction;
    let hit = crossing(in, direction);
    let position = in.middle + in.offset + hit.x * direction;
    let within = all(position.xy >= fluid.within.xy) && all(position.xy <= fluid.within.zw);
    return Surface(position, hit.x <= hit.y && within);
}

// Distance of a position along the line of sight of the picture's middle.
fn distance_of(position: vec3f) -> f32 {
    return dot(position - view.eye.xyz, view.forward.xyz);
}

// The nearest surface of all particles: its distance along the line of sight of the picture's middle.
#import droplet_depth

struct Nearest {
    @location(0) distance: f32,
    @builtin(frag_depth) depth: f32,
}

@vertex
fn vertex(droplet: DropletInstance, @builtin(vertex_index) index: u32) -> Sprite {
    let quad = surface_quad(droplet);
    return sprite_at(droplet, quad, corner_of(quad, index));
}

@fragment
fn fragment(in: Sprite) -> Nearest {
    let surface = surface_at(in);
    if !surface.met {
        discard;
    }
    return Nearest(distance_of(surface.position), depth_at(surface.position));
}

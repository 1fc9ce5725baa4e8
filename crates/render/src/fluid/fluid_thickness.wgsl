// How much water is in a line of sight, in metres, and foam, added up over all particles; then how well they cover it, and how it flows.
#import droplet_matter

@vertex
fn vertex(droplet: DropletInstance, @builtin(vertex_index) index: u32) -> Sprite {
    let quad = matter_quad(droplet);
    return sprite_at(droplet, quad, corner_of(quad, index));
}

struct Added {
    @location(0) matter: vec4f,
    // Velocity times how well it covers the position.
    @location(1) flow: vec4f,
}

@fragment
fn fragment(in: Sprite) -> Added {
    let matter = matter_at(in);
    return Added(matter, vec4f(matter.a * in.flow, 0.0, 0.0));
}

// How much water is in a line of sight, in metres, and foam, added up over all particles; last, how well they cover it.
#import droplet_matter

@vertex
fn vertex(droplet: DropletInstance, @builtin(vertex_index) index: u32) -> Sprite {
    let quad = matter_quad(droplet);
    return sprite_at(droplet, quad, corner_of(quad, index));
}

@fragment
fn fragment(in: Sprite) -> @location(0) vec4f {
    return matter_at(in);
}

// How much water of a particle is in a line of sight, in metres, and foam; what foam is to be divided by; last, how well it covers it.
// For sprites (fluid_thickness.wgsl) and splats (splat_thickness.wgsl).
#import droplet

// The length of a line of sight in water is bounded where it grazes the surface.
const LEAST_COSINE: f32 = 0.08;

// The quad on which a particle's water is spread.
fn matter_quad(droplet: DropletInstance) -> Quad {
    if droplet.matter.x > 0.0 {
        return quad_round(droplet, droplet.matter.z, 0.0);
    }
    return quad_round(droplet, droplet.radius, droplet.flatness);
}

// Its water in the line of sight through a position on the quad.
fn matter_at(in: Sprite) -> vec4f {
    let direction = ray_through(in.middle + in.offset).direction;
    if in.matter.x <= 0.0 {
        let hit = crossing(in, direction);
        let chord = max(hit.y - hit.x, 0.0);
        return vec4f(view.frame.z * chord, in.matter.y * chord, chord, select(0.0, 1.0, chord > 0.0));
    }
    // Where the line of sight meets the surface; the share of the column is the kernel's (poly6, Mueller et al. 2003).
    let cosine = dot(in.normal, direction);
    let slant = select(-1.0, 1.0, cosine > 0.0) * max(abs(cosine), LEAST_COSINE);
    let position = in.offset - dot(in.normal, in.offset) / slant * direction;
    let out = dot(position, position) / (in.radius * in.radius);
    let left = max(1.0 - out, 0.0);
    let share = left * left * left;
    return vec4f(in.matter.x * share / abs(slant), in.matter.y * share, share, share);
}

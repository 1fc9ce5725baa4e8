// Beyond a side held at a level, water moves with that before the side. Leaves the velocity in the place of the acceleration, which what
// has left has none of: `flood_drift` takes it from there. Twin of `Flood::carry_beyond` in `flood/exchange.rs`.
#import flood_water

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= status.particles {
        return;
    }
    let particle = particles[i];
    if particle.outside == 0u || parameters.rules[particle.outside - 1u] != STAGE {
        return;
    }
    let low = parameters.bounds.xz;
    let high = parameters.bounds.yw;
    let margin = min(vec2f(particle.h), 0.5 * (high - low));
    let inside = water_at(clamp(particle.place, low + margin, high - margin));
    let outward = array(vec2f(-1.0, 0.0), vec2f(1.0, 0.0), vec2f(0.0, -1.0), vec2f(0.0, 1.0))[particle.outside - 1u];
    // The outgoing invariant u + 2c is the same on both sides of the edge (Riemann).
    let faster = 2.0 * (sqrt(parameters.gravity * inside.x) - sqrt(parameters.gravity * particle.depth));
    particles[i].acceleration = inside.yz + faster * outward;
}

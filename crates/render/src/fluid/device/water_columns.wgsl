// Brings the particles into the order of their cells, as columns of water over the slope of the ground; those in the air come after
// those on the ground, and what is no particle is left out.
#import water_device

// Slope of the quad round a position, level where it has no ground. Twin of `HeightField::slope_at`.
fn ground_slope(position: vec2f) -> vec2f {
    let at = vec2u(max((position - water.ground_corner) * water.ground_per_metre, vec2f(0.0)));
    let quad = min(at, water.ground_nodes - 2u);
    let first = quad.y * water.ground_nodes.x + quad.x;
    let south = vec2f(heights[first], heights[first + 1u]);
    let north = vec2f(heights[first + water.ground_nodes.x], heights[first + water.ground_nodes.x + 1u]);
    if max(max(south.x, south.y), max(north.x, north.y)) >= NO_HEIGHT {
        return vec2f(0.0);
    }
    let east = 0.5 * (south.y - south.x + north.y - north.x);
    let up = 0.5 * (north.x - south.x + north.y - south.y);
    return vec2f(east, up) * water.ground_per_metre;
}

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= start[of_ground(water) + 1u] {
        return;
    }
    let particle = seen.all[order[i]];
    let position = vec3f(particle.position.xy, water.raise * particle.position.z) + water.shift;
    // As wide as the water that it stands for where particles are sparse.
    let width = sqrt(particle.volume / max(particle.depth, 1e-12));
    sites[i] = vec4f(position, clamp(width, particle.spacing, WIDEST * particle.spacing));
    motions[i] = vec4f(particle.velocity.xy, ground_slope(position.xy));
    matter[i] = vec4u(bitcast<u32>(particle.volume), particle.id, bitcast<vec2u>(particle.velocity.xy));
}

// Brings the particles into the order of their cells, as columns of water over the slope of the ground; those in the air come after
// those on the ground, and what is no particle is left out.
#import water_device

@group(0) @binding(0) var<uniform> water: Water;
@group(0) @binding(1) var<storage, read> seen: DeviceParticles;
@group(0) @binding(2) var<storage, read> start: array<u32>;
@group(0) @binding(3) var<storage, read> order: array<u32>;
// Heights of the ground, m, row by row from the south-west; NO_HEIGHT where there is none.
@group(0) @binding(4) var<storage, read> heights: array<f32>;
@group(0) @binding(5) var<storage, read_write> sites: array<vec4f>;
@group(0) @binding(6) var<storage, read_write> motions: array<vec4f>;
// Volume, m3, id, and velocity as it was before the water was calmed, m/s: their bits.
@group(0) @binding(7) var<storage, read_write> matter: array<vec4u>;

// Slope of the quad round a place, level where it has no ground. Twin of `HeightField::slope_at`.
fn ground_slope(place: vec2f) -> vec2f {
    let at = vec2u(max((place - water.ground_corner) * water.ground_per_metre, vec2f(0.0)));
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

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= start[of_ground(water) + 1u] {
        return;
    }
    let particle = seen.all[order[i]];
    let place = vec3f(particle.place.xy, water.raise * particle.place.z) + water.shift;
    sites[i] = vec4f(place, particle.spacing);
    motions[i] = vec4f(particle.velocity.xy, ground_slope(place.xy));
    matter[i] = vec4u(bitcast<u32>(particle.volume), particle.id, bitcast<vec2u>(particle.velocity.xy));
}

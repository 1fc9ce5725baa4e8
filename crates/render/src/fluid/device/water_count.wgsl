// Each particle counts itself in its cell.
#import water_device

@group(0) @binding(0) var<uniform> water: Water;
@group(0) @binding(1) var<storage, read> seen: DeviceParticles;
@group(0) @binding(2) var<storage, read> sizes: array<u32>;
@group(0) @binding(3) var<storage, read_write> counts: array<atomic<u32>>;
@group(0) @binding(4) var<storage, read_write> places: array<vec2u>;
@group(0) @binding(5) var<storage, read_write> keys: array<u32>;

fn cell_of(particle: DeviceParticle) -> u32 {
    if !(particle.volume > 0.0) || !(abs(particle.place.z) < NO_HEIGHT) {
        return of_ground(water) + 1u;
    }
    if !(particle.depth > 0.0) {
        return of_ground(water);
    }
    let cell = cell_at(water, particle.place.xy + water.shift.xy);
    return cell.y * water.columns + cell.x;
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= sizes[0] {
        return;
    }
    let particle = seen.all[id.x];
    let cell = cell_of(particle);
    places[id.x] = vec2u(cell, atomicAdd(&counts[cell], 1u));
    keys[id.x] = particle.id;
}

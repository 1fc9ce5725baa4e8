// Each particle counts itself in its cell.
#import water_device

fn cell_of(particle: DeviceParticle) -> u32 {
    if !(particle.volume > 0.0) || !(abs(particle.position.z) < NO_HEIGHT) {
        return of_ground(water) + 1u;
    }
    if !(particle.depth > 0.0) {
        return of_ground(water);
    }
    let cell = cell_at(water, particle.position.xy + water.shift.xy);
    return cell.y * water.columns + cell.x;
}

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= sizes.particles {
        return;
    }
    let particle = seen.all[id.x];
    let cell = cell_of(particle);
    cell_slots[id.x] = vec2u(cell, atomicAdd(&counts[cell], 1u));
    keys[id.x] = particle.id;
}

// Writes each particle to its index in sorted order.
#import declared

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) thread: vec3u) {
    let particle = thread.x;
    if particle < sizes.particles {
        let slot = cell_slots[particle];
        order[start[slot.x] + slot.y] = particle;
    }
}

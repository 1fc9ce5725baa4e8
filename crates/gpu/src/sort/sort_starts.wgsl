// Second half of the scan: adds what stands in the blocks before. The last entry is the number of particles.
#import declared

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) thread: vec3u) {
    let cell = thread.x;
    if cell < sizes.cells {
        start[cell] += totals[cell / SORT_BLOCK];
    }
    if cell == 0u {
        start[sizes.cells] = sizes.particles;
    }
}

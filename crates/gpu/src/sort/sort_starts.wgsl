// Second half of the scan: adds what stands in the blocks before. The last entry is the number of particles.
#import sort_groups

@group(0) @binding(0) var<storage, read> sizes: Sizes;
@group(0) @binding(1) var<storage, read_write> start: array<u32>;
@group(0) @binding(2) var<storage, read> totals: array<u32>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) thread: vec3u) {
    let cell = thread.x;
    if cell < sizes.cells {
        start[cell] += totals[cell / 1024u];
    }
    if cell == 0u {
        start[sizes.cells] = sizes.particles;
    }
}

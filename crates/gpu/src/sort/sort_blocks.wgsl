// First half of the scan: within each block of 1024 cells, how many particles stand in the cells before. Leaves the counts at zero.
#import sort_groups

@group(0) @binding(0) var<storage, read> sizes: Sizes;
@group(0) @binding(1) var<storage, read_write> counts: array<u32>;
@group(0) @binding(2) var<storage, read_write> start: array<u32>;
@group(0) @binding(3) var<storage, read_write> totals: array<u32>;

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    let first = group.x * 1024u + thread * 4u;
    var own: array<u32, 4>;
    var sum = 0u;
    for (var k = 0u; k < 4u; k++) {
        if first + k < sizes.cells {
            own[k] = counts[first + k];
            counts[first + k] = 0u;
            sum += own[k];
        }
    }
    let sums = sums_before(thread, sum);
    var before = sums.x;
    for (var k = 0u; k < 4u; k++) {
        if first + k < sizes.cells {
            start[first + k] = before;
            before += own[k];
        }
    }
    if thread == 0u {
        totals[group.x] = sums.y;
    }
}

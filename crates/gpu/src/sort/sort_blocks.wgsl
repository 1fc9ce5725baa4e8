// First half of the scan: within each block of 1024 cells, how many particles stand in the cells before. Leaves the counts at zero.
#import declared
#import sums_before

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    let first = group.x * SORT_BLOCK + thread * 4u;
    var own = array<u32, 4>();
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

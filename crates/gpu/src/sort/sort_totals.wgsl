// Turns the totals of the blocks into sums over the blocks before, in one group.
#import declared
#import sums_before

@compute @workgroup_size(GROUP)
fn main(@builtin(local_invocation_index) thread: u32) {
    let blocks = (sizes.cells + SORT_BLOCK - 1u) / SORT_BLOCK;
    var before = 0u;
    for (var first = 0u; first < blocks; first += GROUP) {
        let block = first + thread;
        let inside = block < blocks;
        var own = 0u;
        if inside {
            own = totals[block];
        }
        let sums = sums_before(thread, own);
        if inside {
            totals[block] = before + sums.x;
        }
        before += sums.y;
    }
}

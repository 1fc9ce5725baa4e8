// Turns the totals of the blocks into sums over the blocks before, in one group.
#import sort_groups

@group(0) @binding(0) var<storage, read> sizes: Sizes;
@group(0) @binding(1) var<storage, read_write> totals: array<u32>;

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_index) thread: u32) {
    let blocks = (sizes.cells + 1023u) / 1024u;
    var before = 0u;
    for (var first = 0u; first < blocks; first += 256u) {
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

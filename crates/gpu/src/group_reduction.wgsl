// Reduction over the threads of a group.
//
// The importing shader gives the type (`alias Reduced`) and how two of it are combined (`fn combine(a: Reduced, b: Reduced) -> Reduced`). The group has `GROUP` threads.
#import declared

var<workgroup> reduced: array<Reduced, GROUP>;

// The values of all threads combined, the same for every thread. To be called by all threads of the group.
fn reduce_group(thread: u32, own: Reduced) -> Reduced {
    reduced[thread] = own;
    for (var part = GROUP / 2u; part > 0u; part /= 2u) {
        workgroupBarrier();
        if thread < part {
            reduced[thread] = combine(reduced[thread], reduced[thread + part]);
        }
    }
    return workgroupUniformLoad(&reduced[0]);
}

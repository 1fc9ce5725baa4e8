// Reduction over the threads of a group.
//
// The importing shader gives the type (`alias Reduced`) and how two of it are combined (`fn combine(a: Reduced, b: Reduced) -> Reduced`). The group has `GROUP` threads.
// A thread combines `FAN` values at a time: fewer barriers than by two, which matters most where threads run one after another, as on software Vulkan.
#import declared

const FAN = 8u;

var<workgroup> reduced: array<Reduced, GROUP>;

// The values of all threads combined, the same for every thread. To be called by all threads of the group.
fn reduce_group(thread: u32, own: Reduced) -> Reduced {
    reduced[thread] = own;
    for (var count = GROUP; count > 1u;) {
        let left = (count + FAN - 1u) / FAN;
        workgroupBarrier();
        if thread < left {
            var sum = reduced[thread];
            for (var other = thread + left; other < count; other += left) {
                sum = combine(sum, reduced[other]);
            }
            reduced[thread] = sum;
        }
        count = left;
    }
    return workgroupUniformLoad(&reduced[0]);
}

// What the threads of a group have, taken together two by two.
//
// Who imports it says of what kind that is (`alias Summand`) and how two are taken together (`fn both(a: Summand, b: Summand) -> Summand`). The group has `GROUP` threads.
#import declared

var<workgroup> summands: array<Summand, GROUP>;

// What all have together, for every thread. To be called by all threads of the group.
fn over_group(thread: u32, own: Summand) -> Summand {
    summands[thread] = own;
    for (var part = GROUP / 2u; part > 0u; part /= 2u) {
        workgroupBarrier();
        if thread < part {
            summands[thread] = both(summands[thread], summands[thread + part]);
        }
    }
    return workgroupUniformLoad(&summands[0]);
}

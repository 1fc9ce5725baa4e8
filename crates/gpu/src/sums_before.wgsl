// Sums over the threads of a group of `GROUP`: where each writes to a list, in one order.
#import declared

var<workgroup> running: array<u32, GROUP>;

// The sum of `value` over the threads before this one, and over all (Hillis and Steele 1986).
fn sums_before(thread: u32, value: u32) -> vec2u {
    running[thread] = value;
    workgroupBarrier();
    for (var step = 1u; step < GROUP; step *= 2u) {
        var sum = running[thread];
        if thread >= step {
            sum += running[thread - step];
        }
        workgroupBarrier();
        running[thread] = sum;
        workgroupBarrier();
    }
    let all = running[GROUP - 1u];
    let before = running[thread] - value;
    workgroupBarrier();
    return vec2u(before, all);
}

// Decides whether cells take steps of their own, and how long the next step is: see `plan` in `local/mod.rs`. One group.
#import declared
#import voronoi_look_up
#import voronoi_plans
#import voronoi_groups

@compute @workgroup_size(GROUP)
fn main(@builtin(local_invocation_index) thread: u32) {
    var own = Plan();
    for (var group = thread; group < groups_for(parameters.cells); group += GROUP) {
        own = combine(own, plans[group]);
    }
    let all = reduce_group(thread, own);
    if thread == 0u {
        let work = 0.25 * f32(all.quarters);
        let pays = all.highest > 0u && work <= (1.0 - LEAST_SAVED) * f32(all.wet);
        status.parts = select(1u, 1u << all.highest, pays);
        status.step = status.shortest * f32(status.parts);
        if status.halted == GOING {
            look_up_all();
        }
    }
}

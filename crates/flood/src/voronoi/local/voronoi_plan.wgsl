// Decides whether cells take steps of their own, and how long the next step is: see `plan` in `local/mod.rs`. One group.
#import declared
#import voronoi_look_up
#import group_reduction

alias Reduced = Plan;

fn combine(a: Plan, b: Plan) -> Plan {
    return Plan(max(a.highest, b.highest), a.wet + b.wet, a.quarters + b.quarters);
}

@compute @workgroup_size(GROUP)
fn main(@builtin(local_invocation_index) thread: u32) {
    var own = Plan();
    let groups_of_cells = (parameters.cells + GROUP - 1u) / GROUP;
    for (var group = thread; group < groups_of_cells; group += GROUP) {
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

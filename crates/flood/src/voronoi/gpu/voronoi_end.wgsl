// The end of a step: updates the records of the maps, adds rain, infiltration and inflow, and finds the largest stable time step (CFL). The piece
// `exchange` is empty where there are none; `IS_SURVEYED` comes with the stage, and holds where `voronoi_survey.wgsl` has recorded the water.
#import declared
#import compensated_sums
#import stage
#import record_step
#import voronoi_stable
#import exchange
#import group_reduction

alias Reduced = Found;

fn combine(a: Found, b: Found) -> Found {
    return Found(
        add_pair(a.rained, b.rained),
        add_pair(a.infiltrated, b.infiltrated),
        add_pair(a.supplied, b.supplied),
        a.energy + b.energy,
        a.momentum + b.momentum,
        min(a.step, b.step),
        a.wet + b.wet,
        a.at_rim + b.at_rim,
        0u,
    );
}

// Ends the step of a cell; returns its totals.
fn end_step(cell: u32) -> Found {
    var own = Found();
    var before = FAR;
    if !IS_SURVEYED {
        record_step(cell);
        before = stable_step(cell);
    }
    exchange(cell, &own);
    // As on the CPU the smaller of both counts.
    own.step = min(before, stable_step(cell));
    if water[cell].depth > 0.0 {
        own.wet = 1u;
        own.at_rim = ground[cell].rim;
    }
    return own;
}

@compute @workgroup_size(GROUP)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    var own = Found();
    own.step = FAR;
    if id.x < parameters.cells {
        own = end_step(id.x);
    }
    var all = reduce_group(thread, own);
    if thread == 0u {
        if IS_SURVEYED {
            all.step = min(all.step, found[group.x].step);
        }
        found[group.x] = all;
    }
}

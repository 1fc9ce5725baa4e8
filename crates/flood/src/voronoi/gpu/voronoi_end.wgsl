// The end of a step: records what the water did in each cell, has water come and go beside its motion, and finds how long the next step may be. The piece
// `exchange` is empty where nothing comes or goes; `IS_LOOKED_AT` comes with the stage, and holds where `voronoi_look.wgsl` has recorded the water.
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

// Takes a cell through the end of the step; what it finds.
fn end_step(cell: u32) -> Found {
    var own = Found();
    var before = FAR;
    if !IS_LOOKED_AT {
        record_step(cell);
        before = stable_step(cell);
    }
    exchange(cell, &own);
    // As on the CPU both count.
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
        if IS_LOOKED_AT {
            all.step = min(all.step, found[group.x].step);
        }
        found[group.x] = all;
    }
}

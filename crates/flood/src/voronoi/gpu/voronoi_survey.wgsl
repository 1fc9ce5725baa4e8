// Surveys the water after its motion, before structures change it: records of the maps, and the largest stable time step (CFL).
#import declared
#import record_step
#import voronoi_stable
#import group_reduction

alias Reduced = f32;

fn combine(a: Reduced, b: Reduced) -> Reduced {
    return min(a, b);
}

@compute @workgroup_size(GROUP)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    var own = FAR;
    if id.x < parameters.cells {
        record_step(id.x);
        own = stable_step(id.x);
    }
    let step = reduce_group(thread, own);
    if thread == 0u {
        found[group.x].step = step;
    }
}

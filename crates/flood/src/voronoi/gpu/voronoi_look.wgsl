// Looks at the water after its motion, before structures work: records of the maps, and how long the next step may be.
#import declared
#import voronoi_record
#import voronoi_stable

var<workgroup> steps: array<f32, 256>;

@compute @workgroup_size(256)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    steps[thread] = 3.0e38;
    if id.x < parameters.cells {
        record(id.x, water[id.x]);
        steps[thread] = stable_step(id.x);
    }
    for (var half = 128u; half > 0u; half /= 2u) {
        workgroupBarrier();
        if thread < half {
            steps[thread] = min(steps[thread], steps[thread + half]);
        }
    }
    if thread == 0u {
        found[group.x].step = steps[0];
    }
}

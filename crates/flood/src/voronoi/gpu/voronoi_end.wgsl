// The end of a step: records what the water did in each cell, has water come and go beside its motion, and finds how long the next step may be. The piece
// `exchange` is empty where nothing comes or goes; `IS_LOOKED_AT` comes with the stage, and holds where `voronoi_look.wgsl` has recorded the water.
#import declared
#import flood_sums
#import stage
#import voronoi_record
#import voronoi_stable
#import exchange

var<workgroup> volumes: array<vec4f, 256>;
var<workgroup> others: array<vec4f, 256>;
var<workgroup> steps: array<f32, 256>;
var<workgroup> counts: array<vec2u, 256>;

// Takes a cell through the end of the step.
fn end_step(cell: u32, thread: u32) {
    var own = Found();
    var before = 3.0e38;
    if !IS_LOOKED_AT {
        record(cell, water[cell]);
        before = stable_step(cell);
    }
    exchange(cell, &own);
    volumes[thread] = vec4f(own.rained, own.infiltrated);
    others[thread] = vec4f(own.supplied, own.energy, own.momentum);
    // As on the CPU both count.
    steps[thread] = min(before, stable_step(cell));
    if water[cell].depth > 0.0 {
        counts[thread] = vec2u(1u, ground[cell].rim);
    }
}

// Adds what the second half of the threads has to what the first has, until one has all.
fn sum_up(thread: u32) {
    for (var half = 128u; half > 0u; half /= 2u) {
        workgroupBarrier();
        if thread < half {
            let own = volumes[thread];
            let more = volumes[thread + half];
            volumes[thread] = vec4f(add_pair(own.xy, more.xy), add_pair(own.zw, more.zw));
            let other = others[thread];
            let beside = others[thread + half];
            others[thread] = vec4f(add_pair(other.xy, beside.xy), other.zw + beside.zw);
            steps[thread] = min(steps[thread], steps[thread + half]);
            counts[thread] += counts[thread + half];
        }
    }
}

@compute @workgroup_size(256)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    volumes[thread] = vec4f(0.0);
    others[thread] = vec4f(0.0);
    steps[thread] = 3.0e38;
    counts[thread] = vec2u(0u);
    if id.x < parameters.cells {
        end_step(id.x, thread);
    }
    sum_up(thread);
    if thread == 0u {
        let volume = volumes[0];
        let other = others[0];
        let before = select(3.0e38, found[group.x].step, IS_LOOKED_AT);
        let step = min(steps[0], before);
        found[group.x] = Found(volume.xy, volume.zw, other.xy, other.z, other.w, step, counts[0].x, counts[0].y, 0u);
    }
}

// Particles are kept within the edges, and count themselves: see `flood_leaving`.
#import flood_leaving

var<workgroup> sums: array<vec4f, 256>;

@compute @workgroup_size(256)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    sums[thread] = vec4f(0.0);
    let i = id.x;
    if i < status.particles {
        var particle = unpacked(particles[i]);
        sums[thread] = kept(&particle);
        particles[i] = packed(particle);
        count(i, particle);
    }
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if thread < half {
            sums[thread] += sums[thread + half];
        }
        workgroupBarrier();
    }
    if thread == 0u {
        partials[group.x].outflow = sums[0].x;
        partials[group.x].inflow = sums[0].y;
        partials[group.x].gained_at_edges = sums[0].z;
        partials[group.x].lost_at_edges = sums[0].w;
    }
}

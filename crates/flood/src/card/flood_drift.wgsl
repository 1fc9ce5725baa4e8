// Particles move: see `flood_drifting`.
#import flood_drifting

var<workgroup> sums: array<f32, 256>;

@compute @workgroup_size(256)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    sums[thread] = 0.0;
    let i = id.x;
    if i < status.particles {
        var particle = unpacked(particles[i]);
        sums[thread] = moved(&particle);
        particles[i] = packed(particle);
    }
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if thread < half {
            sums[thread] += sums[thread + half];
        }
        workgroupBarrier();
    }
    if thread == 0u {
        partials[group.x].booked_in_drift = sums[0];
    }
}

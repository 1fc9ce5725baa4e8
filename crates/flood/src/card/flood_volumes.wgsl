// Sums up the water for a row of gauges, group by group: all that there is, and that of it which stands in films, m3. Twin of
// `Flood::stored`.
#import flood_wetness
#import flood_air

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> status: Status;
@group(0) @binding(2) var<storage, read> particles: array<Particle>;
@group(0) @binding(3) var<storage, read> patches: array<Patch>;
@group(0) @binding(4) var<storage, read_write> air: Air;
@group(0) @binding(5) var<storage, read_write> volumes: array<vec2f>;

var<workgroup> sums: array<vec2f, 256>;

fn own(i: u32) -> vec2f {
    var own = vec2f(0.0);
    if i < status.particles && particles[i].outside == 0u {
        own.x += particles[i].volume;
    }
    if i < parameters.in_air && air.drops[i].is_up == 1u {
        own.x += air.drops[i].volume;
    }
    if i < parameters.patches.x * parameters.patches.y {
        own += patches[i].film;
    }
    return own;
}

@compute @workgroup_size(256)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) thread: u32,
    @builtin(workgroup_id) group: vec3u,
) {
    sums[thread] = own(id.x);
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if thread < half {
            sums[thread] += sums[thread + half];
        }
        workgroupBarrier();
    }
    if thread == 0u {
        volumes[group.x] = sums[0];
    }
}

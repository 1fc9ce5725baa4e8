// Sums up the water for a row of gauges, group by group, m3. Twin of `SphSweFlood::stored`.
#import sph_common
#import group_reduction

alias Reduced = f32;

fn combine(a: Reduced, b: Reduced) -> Reduced {
    return a + b;
}

fn own(i: u32) -> f32 {
    var own = 0.0;
    if i < status.particles {
        let particle = unpacked(particles[i]);
        own += select(0.0, particle.volume, particle.outside == 0u);
    }
    if i < parameters.in_air && drops[i].state == FALLS {
        own += drops[i].volume;
    }
    return own;
}

@compute @workgroup_size(GROUP)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) thread: u32,
    @builtin(workgroup_id) group: vec3u,
) {
    let all = reduce_group(thread, own(id.x));
    if thread == 0u {
        volumes[group.x] = all;
    }
}

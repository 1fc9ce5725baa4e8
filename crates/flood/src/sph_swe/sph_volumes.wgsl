// Sums up the water for a row of gauges, group by group, m3. Twin of `SphSweFlood::stored`.
#import sph_common
#import over_group

alias Summand = f32;

fn both(a: Summand, b: Summand) -> Summand {
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
    let all = over_group(thread, own(id.x));
    if thread == 0u {
        volumes[group.x] = all;
    }
}

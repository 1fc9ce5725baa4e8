// Totals of the air for gauges, summed by groups that share the particles. Twin of `Totals` in `measures/mod.rs`.
#import dew_particles
#import group_reduction

alias Reduced = Measured;

fn combine(a: Reduced, b: Reduced) -> Reduced {
    return Measured(
        a.temperature + b.temperature,
        a.vapour + b.vapour,
        a.fog + b.fog,
        max(a.fastest, b.fastest),
        a.count + b.count,
    );
}

fn measure(particle: Particle) -> Measured {
    if particle.role != INSIDE {
        return Measured();
    }
    let speed_squared = dot(particle.velocity, particle.velocity);
    return Measured(total(particle.temperature), total(particle.vapour), particle.fog, speed_squared, 1u);
}

@compute @workgroup_size(GROUP)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) thread: u32,
    @builtin(workgroup_id) group: vec3u,
) {
    var own = Measured();
    for (var i = id.x; i < status.particles; i += GROUP * MEASURING_GROUPS) {
        own = combine(own, measure(unpacked(particles[i])));
    }
    let all = reduce_group(thread, own);
    if thread == 0u {
        measured[group.x] = all;
    }
}

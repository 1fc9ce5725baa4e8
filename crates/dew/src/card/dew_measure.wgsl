// What gauges tell of the air as a whole, summed up by groups that share the particles. Twin of `Totals` in `measures.rs`.
#import dew_card

var<workgroup> sums: array<Measured, 256>;

fn joined(a: Measured, b: Measured) -> Measured {
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
    return Measured(value(particle.temperature), value(particle.vapour), particle.fog, speed_squared, 1u);
}

@compute @workgroup_size(256)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) thread: u32,
    @builtin(workgroup_id) group: vec3u,
) {
    var own = Measured();
    for (var i = id.x; i < status.particles; i += 256u * MEASURING_GROUPS) {
        own = joined(own, measure(unpacked(particles[i])));
    }
    sums[thread] = own;
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if thread < half {
            sums[thread] = joined(sums[thread], sums[thread + half]);
        }
        workgroupBarrier();
    }
    if thread == 0u {
        measured[group.x] = sums[0];
    }
}

// What air beyond outlets is faster and denser by, and new layers of air before inlets; one group. Twin of `faces/inlet.rs`, and of
// `before_outlet` and `update_outlet_pressure` in `faces/mod.rs`.
#import dew_particles
#import dew_rows
#import group_reduction

alias Reduced = BeforeOutlet;

fn combine(a: Reduced, b: Reduced) -> Reduced {
    return BeforeOutlet(a.near + b.near, 0.0, a.nearest + b.nearest, vec2f(0.0));
}

// The mean acceleration, velocity and `spreading` before a face, by all threads together.
fn mean_before(number: u32, count: u32, thread: u32) -> vec3f {
    var own = BeforeOutlet();
    for (var group = thread; group < count; group += GROUP) {
        own.near += before[group][number].near;
        own.nearest += before[group][number].nearest;
    }
    let all = reduce_group(thread, own);
    return vec3f(all.near.xy / max(all.near.z, 1.0), all.nearest.x / max(all.nearest.y, 1.0));
}

// A layer of air `behind` an inlet, of the air that comes in when the layer reaches the face, its particles numbered from `first`.
fn add_layer(number: u32, behind: f32, first: u32, first_id: u32, thread: u32) {
    let inlet = parameters.inlets[number];
    let axis = number / 2u;
    let a = (axis + 1u) % 3u;
    let b = (axis + 2u) % 3u;
    var warmth = inlet.temperature;
    var vapour = inlet.vapour;
    if inlet.temperature_first < inlet.temperature_end {
        let reached = add(status.time, status.step + behind / abs(inlet.velocity[axis]));
        warmth = value_at(inlet.temperature_first, inlet.temperature_end, reached);
        vapour = value_at(inlet.vapour_first, inlet.vapour_end, reached);
    }
    let columns = parameters.counts[a];
    let all = columns * parameters.counts[b];
    for (var k = thread; k < all; k += GROUP) {
        var particle = Particle();
        particle.position[axis] = select(parameters.high[axis] + behind, parameters.low[axis] - behind, number % 2u == 0u);
        particle.position[a] = parameters.low[a] + (f32(k % columns) + 0.5) * parameters.apart[a];
        particle.position[b] = parameters.low[b] + (f32(k / columns) + 0.5) * parameters.apart[b];
        particle.velocity = inlet.velocity;
        particle.temperature = vec2f(warmth, 0.0);
        particle.vapour = vec2f(vapour, 0.0);
        particle.id = first_id + k;
        particle.role = COMING | (number << FACE_BITS);
        if first + k < arrayLength(&particles) {
            particles[first + k] = packed(particle);
        }
    }
}

@compute @workgroup_size(GROUP)
fn main(@builtin(local_invocation_index) thread: u32) {
    let old = status.particles;
    var count = old;
    let id = status.next_id;
    // Where the device halts, nothing comes in.
    let is_going = status.halted == GOING;
    let step = select(0.0, status.step, is_going);
    var phases = status.phase;
    var faster = array<f32, 6>();
    var spreading = array<f32, 6>();
    var excess = array<f32, 6>();
    var running_mean = status.running_mean_before;
    for (var number = 0u; number < NO_FACE; number++) {
        let rule = face(number);
        if rule == OUTLET {
            let mean = mean_before(number, (old + GROUP - 1u) / GROUP, thread);
            faster[number] = step * mean.x;
            spreading[number] = mean.z;
            let crossed = step * parameters.sound / (parameters.high[number / 2u] - parameters.low[number / 2u]);
            running_mean[number] += crossed / (1.0 + crossed) * (mean.y - running_mean[number]);
            let outward = select(1.0, -1.0, number % 2u == 0u);
            excess[number] = outward * (mean.y - running_mean[number]) / parameters.sound;
        } else if rule == INLET {
            let axis = number / 2u;
            let apart = parameters.apart[axis];
            phases[number] = add(phases[number], abs(parameters.inlets[number].velocity[axis]) * step);
            if total(phases[number]) >= apart {
                phases[number] = add(phases[number], -apart);
                let behind = parameters.inlets[number].behind - total(phases[number]);
                add_layer(number, behind, count, id + count - old, thread);
                count += parameters.counts[(axis + 1u) % 3u] * parameters.counts[(axis + 2u) % 3u];
            }
        }
    }
    // All have read what it was.
    storageBarrier();
    workgroupBarrier();
    if thread == 0u && is_going {
        status.phase = phases;
        status.before = faster;
        status.spreading_before = spreading;
        status.density_excess_beyond = excess;
        status.running_mean_before = running_mean;
        status.particles = min(count, arrayLength(&particles));
        status.next_id = id + count - old;
        groups[0] = (status.particles + GROUP - 1u) / GROUP;
    }
}

// Half a kick with the old acceleration, then on by a whole step; and what the air before outlets does. Twin of `drift` in
// `dew/motion.rs`, of `Room::keep` and `Room::wrap_along`, and of `before_outlet` in `faces/mod.rs`.
#import dew_particles
#import group_reduction

alias Reduced = BeforeOutlet;

fn combine(a: Reduced, b: Reduced) -> Reduced {
    return BeforeOutlet(a.near + b.near, 0.0, a.nearest + b.nearest, vec2f(0.0));
}

fn wrapped(at: f32, low: f32, high: f32) -> f32 {
    let size = high - low;
    let shifted = at - size * floor((at - low) / size);
    return select(low, shifted, shifted >= low && shifted < high);
}

// Brings particles back that have crossed periodic faces, walls, or the rim of an inlet.
fn keep(particle: ptr<function, Particle>) {
    let is_coming = ((*particle).role & ROLE_MASK) == COMING;
    let inlet = (*particle).role >> FACE_BITS;
    for (var axis = 0u; axis < 3u; axis++) {
        let low = parameters.low[axis];
        let high = parameters.high[axis];
        let at = (*particle).position[axis];
        if at >= low && at < high {
            continue;
        }
        let side = select(0u, 1u, at >= high);
        let rule = face(2u * axis + side);
        if rule == PERIODIC || (is_coming && axis != inlet / 2u) {
            (*particle).position[axis] = wrapped(at, low, high);
        } else if rule == WALL {
            (*particle).position[axis] = mirrored_inside(at, 2u * axis + side);
            (*particle).velocity[axis] = -(*particle).velocity[axis];
        }
    }
}

// What a particle adds to the sums before a face.
fn counted(particle: Particle, number: u32) -> BeforeOutlet {
    let axis = number / 2u;
    let at_face = select(parameters.high[axis], parameters.low[axis], number % 2u == 0u);
    let distance = abs(particle.position[axis] - at_face);
    let is_near = particle.role == INSIDE && distance < parameters.h;
    let is_nearest = is_near && distance < OUTLET_LAYER * parameters.h;
    return BeforeOutlet(
        select(vec3f(0.0), vec3f(particle.acceleration[axis], particle.velocity[axis], 1.0), is_near),
        0.0,
        select(vec2f(0.0), vec2f(particle.spreading[axis], 1.0), is_nearest),
        vec2f(0.0),
    );
}

@compute @workgroup_size(GROUP)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    let i = id.x;
    let is_there = i < status.particles;
    var particle = Particle();
    if is_there {
        particle = unpacked(particles[i]);
        let step = status.step;
        if particle.role == INSIDE {
            particle.velocity += 0.5 * step * particle.acceleration;
        }
        // The transport velocity (Adami, Hu & Adams 2013, equations 6 and 8).
        let spread = clamp(step * step * particle.spreading, vec3f(-parameters.farthest), vec3f(parameters.farthest));
        particle.position += step * particle.velocity + spread;
        keep(&particle);
        particles[i] = packed(particle);
    }
    for (var number = 0u; number < NO_FACE; number++) {
        if face(number) != OUTLET {
            continue;
        }
        var own = BeforeOutlet();
        if is_there {
            own = counted(particle, number);
        }
        let all = reduce_group(thread, own);
        if thread == 0u {
            before[group.x][number] = all;
        }
    }
}

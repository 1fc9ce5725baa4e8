// Sums up a step over the groups, books it, and decides whether there is another step before the time the host waits for. Twin of
// `step` in `dew/mod.rs` and of `next_step` in `dew/motion.rs`.
#import dew_particles
#import group_reduction

alias Reduced = Partial;

fn combine(a: Reduced, b: Reduced) -> Reduced {
    return Partial(
        a.came + b.came,
        a.went + b.went,
        a.diffused + b.diffused,
        a.fogged + b.fogged,
        min(a.longest, b.longest),
        max(a.fastest, b.fastest),
        0.0,
        vec2f(0.0),
    );
}

// Accelerated time: what solids take beyond what the air gave all air of a closed room loses in the next step; in one with openings it counts as
// come in. Twin of `accelerate` in `dew/accelerated.rs`.
fn accelerate(step: f32) {
    let more = parameters.time_factor - 1.0;
    if more == 0.0 {
        return;
    }
    var heat = 0.0;
    var water = 0.0;
    for (var body = 0u; body < arrayLength(&bodies); body++) {
        heat += step * bodies[body].flow;
        water += bodies[body].water;
    }
    let of_particle = more * vec2f(water, heat) / parameters.mass;
    if is_set(IS_CLOSED) {
        let all = of_particle / f32(status.particles);
        status.drift = -vec2f((all.y - parameters.latent_heat * all.x) / parameters.heat_capacity, all.x);
    } else {
        status.diffused = add_four(status.diffused, max(vec4f(of_particle.x, -of_particle.x, of_particle.y, -of_particle.y), vec4f(0.0)));
    }
}

// Books what the groups have summed up.
fn book(all: Partial) {
    let step = status.step;
    status.came = add_four(status.came, all.came);
    status.went = add_four(status.went, all.went);
    // Beyond faces, and to air of low utility.
    if is_set(IS_PASSED) || is_set(FINDS_LOW_UTILITY) {
        let water = step * all.diffused.y;
        let energy = step * (parameters.heat_capacity * all.diffused.x + parameters.latent_heat * all.diffused.y);
        status.diffused = add_four(status.diffused, max(vec4f(water, -water, energy, -energy), vec4f(0.0)));
    }
    accelerate(step);
    status.fogged = add(status.fogged, all.fogged);
    if (status.turn + status.steps) % TURN == 0u {
        status.seen = status.time;
    }
    status.time = tidy(add(status.time, step));
    status.last_step = step;
    status.steps += 1u;
    status.particle_steps = count_up(status.particle_steps, status.particles);
    var stiffest = 1e-30;
    for (var body = 0u; body < arrayLength(&bodies); body++) {
        stiffest = max(stiffest, bodies[body].stiff);
    }
    status.step = min(all.longest, DIFFUSION_LIMIT / stiffest);
    status.fastest = all.fastest;
}

fn decide() {
    let is_fast = is_set(REFUSES_FAST) && status.fastest > parameters.sound * parameters.sound;
    if !(status.step > parameters.shortest_step) || is_fast {
        status.halted = BROKEN;
    } else if difference(status.until, status.time) < status.step {
        status.halted = ARRIVED;
    } else if status.particles > parameters.full {
        // There may be too little room for what comes in the next step.
        status.halted = NEEDS_HOST;
    } else {
        status.halted = GOING;
    }
    let counts = array(
        (status.particles + GROUP - 1u) / GROUP,
        (status.cells + GROUP - 1u) / GROUP,
        (status.cells + SORT_BLOCK - 1u) / SORT_BLOCK,
        1u,
        (arrayLength(&own) + GROUP - 1u) / GROUP,
        arrayLength(&bodies),
    );
    for (var slot = 0u; slot < 6u; slot++) {
        groups[3u * slot] = select(0u, counts[slot], status.halted == GOING);
        groups[3u * slot + 1u] = 1u;
        groups[3u * slot + 2u] = 1u;
    }
}

@compute @workgroup_size(GROUP)
fn main(@builtin(local_invocation_index) thread: u32) {
    var own = Partial(vec4f(0.0), vec4f(0.0), vec2f(0.0), 0.0, FAR, 0.0, 0.0, vec2f(0.0));
    if status.halted == GOING {
        for (var group = thread; group < groups[0]; group += GROUP) {
            own = combine(own, partials[group]);
        }
    }
    let all = reduce_group(thread, own);
    if thread == 0u {
        if status.halted == GOING {
            book(all);
        }
        if status.halted == GOING || status.halted == BATCH_START {
            decide();
        }
    }
}

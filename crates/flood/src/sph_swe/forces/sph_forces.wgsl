// Pressure, viscosity, the slope of the ground and the control force, the step's acceleration, friction, and what a group's particles sum up to. Twin of
// `pair_forces` and `add_external_forces` in `forces/mod.rs`, of `control` in `control.rs` and of `accelerate` in `motion/mod.rs`.
#import sph_common
#import sph_neighbours
#import sph_kernels
#import sph_ground
#import sph_friction
#import group_reduction

struct Sums {
    slowed: f32,
    sum_of_h: f32,
    outer_force: vec2f,
    low: vec2f,
    high: vec2f,
}

alias Reduced = Sums;

fn combine(a: Reduced, b: Reduced) -> Reduced {
    return Sums(
        a.slowed + b.slowed,
        a.sum_of_h + b.sum_of_h,
        a.outer_force + b.outer_force,
        min(a.low, b.low),
        max(a.high, b.high),
    );
}

// f = -sum m_j (p_i + p_j)/(2 rho_j) grad W + mu sum m_j (v_j - v_i)/rho_j lap W, over the density.
fn by_pairs(i: u32, own: Column) -> vec2f {
    let h = own.h;
    var force = vec2f(0.0);
    let mirrors = mirrors_round(own.position);
    for (var k = 0u; k < mirrors; k++) {
        let mirror = mirror(k);
        if !sees(mirror, own.position, h) {
            continue;
        }
        let truth = behind(mirror, own.position);
        let cells = cells_round(parameters.grid, truth, h);
        for (var row = cells.y; row <= cells.w; row++) {
            let across = columns_round(parameters.grid, truth, h, row);
            let line = row * parameters.grid.columns;
            let end = start[line + across.y + 1u];
            for (var j = start[line + across.x]; j < end; j++) {
                let near = columns[j];
                let there = ghost_of(mirror, near.position);
                let e = there - own.position;
                let r = max(length(e), 2e-12 * h);
                if r >= h || (j == i && k == 0u) || (k > 0u && !has_ghost(mirror, there, near.h)) {
                    continue;
                }
                let push = near.area * (near.pressure + own.pressure) * 0.5 * kernel_slope(r, h) / r;
                let drag = near.area * parameters.viscosity * kernel_laplacian(r, h);
                force += drag * (mirror.sign * near.velocity - own.velocity) - push * e;
            }
        }
    }
    return force / own.density;
}

// The terrain-difference velocity control force: see `control.rs`.
fn control(particle: Particle) -> vec2f {
    let speed = length(particle.velocity);
    if parameters.control == 0u || status.step <= 0.0 || speed == 0.0 {
        return vec2f(0.0);
    }
    let side = parameters.control_square * particle.next_h;
    let way = status.step * particle.velocity;
    var ways = 0.0;
    for (var corner = 0u; corner < 4u; corner++) {
        let across = array(vec2f(-0.5, -0.5), vec2f(0.5, -0.5), vec2f(0.5, 0.5), vec2f(-0.5, 0.5))[corner];
        let slope = ground_at(particle.position + across * side - 0.5 * way).yz;
        ways += length(vec3f(way, dot(slope, way)));
    }
    let force = parameters.control_strength * 0.25 * side * side * particle.depth * ways;
    return -min(force / speed, 1.0 / status.step) * particle.velocity;
}

// The next smoothing length of a particle; infinite where a value of it is not finite, which ends the run: beyond an edge no force would show it.
fn sound_h(particle: Particle) -> f32 {
    let is_placed = is_finite(particle.position.x) && is_finite(particle.position.y);
    let is_moved = is_finite(particle.velocity.x) && is_finite(particle.velocity.y);
    let is_sound = is_placed && is_moved && is_finite(particle.volume) && is_finite(particle.depth);
    return select(bitcast<f32>(0x7f800000u ^ parameters.zero), particle.next_h, is_sound);
}

// Accelerates a particle; what it adds to the sums.
fn pushed(i: u32) -> Sums {
    var particle = unpacked(sorted[i]);
    let position = particle.position;
    var acceleration = vec2f(0.0);
    if particle.outside == 0u {
        let slope = ground_under(position).yz;
        acceleration = by_pairs(i, columns[i]) + particle.acceleration - parameters.gravity * slope + control(particle);
    }
    particle.acceleration = acceleration;
    let velocity = particle.velocity + status.step * acceleration;
    var booked = 0.0;
    particle.velocity = velocity;
    if particle.outside == 0u {
        let factor = slowed(roughness_at(position), velocity, particle.depth, status.step);
        particle.velocity = factor * velocity;
        booked = particle.volume * (velocity.x + velocity.y) * (factor - 1.0);
    }
    particles[i] = packed(particle);
    return Sums(booked, sound_h(particle), particle.volume * acceleration, position, position);
}

@compute @workgroup_size(GROUP)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    var own = Sums(0.0, 0.0, vec2f(0.0), vec2f(FAR), vec2f(-FAR));
    if id.x < status.particles {
        own = pushed(id.x);
    }
    let all = reduce_group(thread, own);
    if thread == 0u {
        partials[group.x].slowed = all.slowed;
        partials[group.x].outer_force = all.outer_force;
        partials[group.x].sum_of_h = all.sum_of_h;
        partials[group.x].low = all.low;
        partials[group.x].high = all.high;
    }
}

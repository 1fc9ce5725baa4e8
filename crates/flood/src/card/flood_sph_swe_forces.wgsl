// Pressure, viscosity, the slope of the ground and the control force of scheme sph-swe, the step's acceleration, and what a group's
// particles sum up to. Twin of `pair_forces`, `control` and `take_over` in `sph_swe.rs` and of the second push in `flood/step.rs`.
#import flood_sph_swe
#import flood_friction
#import flood_sums

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> status: Status;
@group(0) @binding(2) var<storage, read> start: array<u32>;
@group(0) @binding(3) var<storage, read> parcels: array<Parcel>;
// Their accelerations are the push of obstacles.
@group(0) @binding(4) var<storage, read> sorted: array<Packed>;
@group(0) @binding(5) var<storage, read_write> particles: array<Packed>;
@group(0) @binding(6) var<storage, read_write> partials: array<Partial>;
@group(0) @binding(7) var nodes: texture_2d<f32>;
@group(0) @binding(8) var rough: texture_2d<f32>;

// f = -sum m_j (p_i + p_j)/(2 rho_j) grad W + mu sum m_j (v_j - v_i)/rho_j lap W, over the density.
fn by_pairs(i: u32, own: Parcel) -> vec2f {
    let h = own.h;
    var force = vec2f(0.0);
    let mirrors = mirrors_round(parameters, own.place);
    for (var k = 0u; k < mirrors; k++) {
        let mirror = mirror(k, parameters);
        if !sees(mirror, parameters, own.place, h) {
            continue;
        }
        let truth = behind(mirror, own.place);
        let cells = cells_round(parameters.grid, truth, h);
        for (var row = cells.y; row <= cells.w; row++) {
            let across = columns_round(parameters.grid, truth, h, row);
            let line = row * parameters.grid.columns;
            let end = start[line + across.y + 1u];
            for (var j = start[line + across.x]; j < end; j++) {
                let near = parcels[j];
                let there = shown(mirror, near.place);
                let e = there - own.place;
                let r = max(length(e), 2e-12 * h);
                if r >= h || (j == i && k == 0u) || (k > 0u && !has_image(mirror, parameters, there, near.h)) {
                    continue;
                }
                let push = near.area * (near.pressure + own.pressure) * 0.5 * spiky_slope(r, h) / r;
                let drag = near.area * parameters.sph_swe_viscosity * viscosity_laplacian(r, h);
                force += drag * (mirror.sign * near.velocity - own.velocity) - push * e;
            }
        }
    }
    return force / own.density;
}

// The terrain-difference velocity control force: see `control` in `sph_swe.rs`.
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
        let slope = ground_at(parameters, nodes, particle.place + across * side - 0.5 * way).yz;
        ways += length(vec3f(way, dot(slope, way)));
    }
    let force = parameters.control_strength * 0.25 * side * side * particle.depth * ways;
    return -min(force / speed, 1.0 / status.step) * particle.velocity;
}

// Accelerates a particle; what it adds to the sums.
fn pushed(i: u32) -> Sums {
    var particle = unpacked(sorted[i]);
    let place = particle.place;
    var acceleration = vec2f(0.0);
    if particle.outside == 0u {
        let slope = ground_under(parameters, nodes, place).yz;
        acceleration = by_pairs(i, parcels[i]) + particle.acceleration - parameters.gravity * slope + control(particle);
    }
    particle.acceleration = acceleration;
    let velocity = particle.velocity + status.step * acceleration;
    var booked = 0.0;
    particle.velocity = velocity;
    if particle.outside == 0u {
        let factor = slowed(parameters, roughness_at(parameters, rough, place), velocity, particle.depth, status.step);
        particle.velocity = factor * velocity;
        booked = particle.volume * (velocity.x + velocity.y) * (factor - 1.0);
    }
    particles[i] = packed(particle);
    return Sums(booked, particle.next_h, particle.volume * acceleration, FAR, place, place);
}

@compute @workgroup_size(256)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    sums[thread] = NOTHING;
    if id.x < status.particles {
        sums[thread] = pushed(id.x);
    }
    let all = summed(thread);
    if thread == 0u {
        partials[group.x].booked_in_kick = all.booked;
        partials[group.x].from_outside = all.from_outside;
        partials[group.x].longest_step = all.longest;
        partials[group.x].sum_of_h = all.sum_of_h;
        partials[group.x].low = all.low;
        partials[group.x].high = all.high;
    }
}

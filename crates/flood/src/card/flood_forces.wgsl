// Pair forces, the second half of the step's acceleration, and what a group's particles sum up to. Twin of `balanced/forces.rs`, of
// `take_over` in `balanced/mod.rs` and of the second push in `flood/step.rs`.
#import flood_columns
#import flood_near
#import flood_friction
#import flood_sums

@group(0) @binding(1) var<storage, read> status: Status;
@group(0) @binding(4) var<storage, read> columns: array<PackedColumn>;
@group(0) @binding(5) var<storage, read> slopes: array<PackedSlopes>;
// Their accelerations are the push of obstacles.
@group(0) @binding(6) var<storage, read> sorted: array<Packed>;
@group(0) @binding(7) var<storage, read_write> particles: array<Packed>;
@group(0) @binding(8) var<storage, read_write> partials: array<Partial>;
@group(0) @binding(9) var nodes: texture_2d<f32>;
@group(0) @binding(10) var rough: texture_2d<f32>;

struct Force {
    acceleration: vec2f,
    // From what is not of this water, over its density, m4/s2.
    from_outside: vec2f,
}

// Monotonised central limiter (van Leer 1977) of two one-sided differences.
fn limited(a: f32, b: f32) -> f32 {
    if a * b <= 0.0 {
        return 0.0;
    }
    return sign(a) * min(2.0 * min(abs(a), abs(b)), 0.5 * abs(a + b));
}

// Slopes as a mirror shows them.
fn mirrored(slope: Slopes, mirror: Mirror) -> Slopes {
    var shown = slope;
    let crossed = mirror.sign.x * mirror.sign.y;
    shown.renormalisation.y *= crossed;
    shown.surface *= mirror.sign;
    shown.ground *= mirror.sign;
    shown.u *= vec2f(1.0, crossed);
    shown.v *= vec2f(crossed, 1.0);
    shown.outside = select(1.0, slope.outside, mirror.is_water);
    return shown;
}

fn on_one(i: u32, own: Column, sloped: Slopes) -> Force {
    let gravity = parameters.gravity;
    let h = 1.0 / own.per_h;
    let ground = own.surface - own.depth;
    let wave_speed = sqrt(gravity * own.depth);
    let own_pressure = 0.5 * gravity * own.depth * own.depth * (1.0 - sloped.rest);
    var force = vec2f(0.0);
    var from_outside = vec2f(0.0);
    var walk = walk_round(i);
    while next_near(&walk, own.place, 2.0 * h) {
        let mirror = mirror(walk.mirror, parameters);
        let here = columns[walk.near].place_area_per_h;
        let there = shown(mirror, here.xy);
        let e = there - own.place;
        let r = max(length(e), 2e-12 * h);
        if r * min(own.per_h, here.w) >= 2.0 || (walk.mirror > 0u && !has_image(mirror, parameters, there, 2.0 / here.w)) {
            continue;
        }
        var near = column_of(here, columns[walk.near].velocity_surface_depth);
        var slope = unpacked_slopes(slopes[walk.near]);
        if walk.mirror > 0u {
            slope = mirrored(slope, mirror);
            near.surface += step_up(mirror, parameters, nodes, near.place);
            near.velocity *= mirror.sign;
        }
        let per_r = 1.0 / r;

        // Pair area A = V_i V_j [B_i grad W(h_i) + B_j grad W(h_j)], antisymmetric in i and j.
        let b = spline_slope(r, own.per_h) * sloped.renormalisation + spline_slope(r, near.per_h) * slope.renormalisation;
        let area = turned(b, e) * (near.area * own.area * per_r);

        // Reconstruction to the middle, surface and velocity along the pair (positive from i to j).
        let surface_step = near.surface - own.surface;
        let surface_i = own.surface + 0.5 * limited(2.0 * dot(e, sloped.surface) - surface_step, surface_step);
        let surface_j = near.surface - 0.5 * limited(2.0 * dot(e, slope.surface) - surface_step, surface_step);
        let along_i = dot(e, own.velocity) * per_r;
        let along_j = dot(e, near.velocity) * per_r;
        let step = along_j - along_i;
        let change_i = (e.x * dot(e, sloped.u) + e.y * dot(e, sloped.v)) * per_r;
        let change_j = (e.x * dot(e, slope.u) + e.y * dot(e, slope.v)) * per_r;
        let w_i = along_i + 0.5 * limited(2.0 * change_i - step, step);
        let w_j = along_j - 0.5 * limited(2.0 * change_j - step, step);

        // Ground in the middle from heights and slopes at both ends (cubic Hermite).
        let bend = dot(sloped.ground - slope.ground, e);
        var middle = 0.5 * ((near.surface - near.depth) + ground) + 0.125 * bend;
        middle = max(max(middle, own.surface - SHARED * own.depth), near.surface - SHARED * near.depth);

        // Hydrostatic reconstruction (Audusse et al. 2004, eq. 2.9) and the acoustic Riemann problem.
        let depth_i = max(surface_i - middle, 1e-6 * own.depth);
        let depth_j = max(surface_j - middle, 1e-6 * near.depth);
        let impedance_i = depth_i * wave_speed;
        let impedance_j = depth_j * sqrt(gravity * near.depth);
        let per_sum = 1.0 / (impedance_i + impedance_j);
        let both = impedance_i * impedance_j * per_sum;
        let pressures = 0.5 * gravity * (impedance_j * depth_i * depth_i + impedance_i * depth_j * depth_j) * per_sum;
        let pressure = max(pressures + both * (w_i - w_j), 0.0);

        // At rest the own column's pressure against the middle cancels it exactly; in motion the symmetric form acts.
        let own_depth = max(own.surface - middle, 0.0);
        let ground_push = own_pressure - 0.5 * gravity * own_depth * own_depth;
        // Artificial viscosity at signal speed (after Monaghan 1997).
        let drag = max(dot(area, e) * per_r, 0.0) * both * parameters.viscosity * (own.velocity - near.velocity);
        force += area * (pressure + ground_push) + drag;
        from_outside += area * (pressure * slope.outside + ground_push) + drag * slope.outside;
    }
    let volume = own.depth * own.area;
    let slide = -gravity * sloped.ground * sloped.alone;
    let pushed = bitcast<vec2f>(sorted[i].acceleration_and_volume.xy);
    return Force(slide - (force + pushed) / volume, slide * volume - from_outside - pushed);
}

// Accelerates a particle; what it adds to the sums.
fn pushed(particle: ptr<function, Particle>, own: Column, sloped: Slopes, force: Force) -> Sums {
    let place = (*particle).place;
    let h = (*particle).next_h;
    (*particle).surface_slope = sloped.surface;
    if (*particle).outside > 0u {
        (*particle).acceleration = vec2f(0.0);
        return Sums(0.0, h, vec2f(0.0), FAR, place, place);
    }
    (*particle).acceleration = force.acceleration;
    let squeeze = 2.0 * (*particle).h * max(-(sloped.u.x + sloped.v.y), 0.0);
    let pull = sqrt((*particle).h * length(force.acceleration));
    let longest = parameters.cfl * (*particle).h / max(sqrt(parameters.gravity * own.depth) + squeeze, pull);
    let velocity = (*particle).velocity + 0.5 * status.step * force.acceleration;
    let factor = slowed(parameters, roughness_at(parameters, rough, place), velocity, (*particle).depth, 0.5 * status.step);
    (*particle).velocity = factor * velocity;
    let booked = (*particle).volume * (velocity.x + velocity.y) * (factor - 1.0);
    // What is not a number must not be lost in a minimum: it ends the run.
    return Sums(booked, h, force.from_outside, select(0.0, longest, longest > 0.0), place, place);
}

@compute @workgroup_size(256)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    let i = id.x;
    sums[thread] = NOTHING;
    if i < status.particles {
        let own = unpacked_column(columns[i]);
        let sloped = unpacked_slopes(slopes[i]);
        var particle = unpacked(sorted[i]);
        sums[thread] = pushed(&particle, own, sloped, on_one(i, own, sloped));
        particles[i] = packed(particle);
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

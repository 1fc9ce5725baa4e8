// New columns of a stage: each cell gathers what its faces bring, is slowed, and in the second stage averaged with the column before the step (Heun's method). See
// `update` in `solver.rs`. `IS_SECOND` comes with the stage.
#import declared
#import stage
#import time_steps
#import compensated_sums
#import voronoi_friction
#import voronoi_water
#import group_reduction

alias Reduced = BorderTotals;

// Sums over the faces of a cell in a step: volume, momentum that volume carries, momentum of thrusts, and totals over borders.
struct Gathered {
    volume: vec2f,
    carried: vec2f,
    thrust: vec2f,
    outflow: vec2f,
    inflow: vec2f,
    energy: vec2f,
    // Momentum that volume carries over borders.
    beyond: vec2f,
}

// The part of the flux through a face that the upstream cell has the water for.
fn kept_of(cell: u32, link: Link, outwards: f32) -> f32 {
    if outwards > 0.0 {
        return kept[cell];
    }
    if link.neighbour == NONE {
        return 1.0;
    }
    return kept[link.neighbour];
}

// Energy over density above the level 0 that leaves with a volume, by half of the step.
fn energy_of(cell: u32, flux: Flux, volume: f32) -> f32 {
    if flux.volume == 0.0 {
        return 0.0;
    }
    // Divided before it is squared: the square of next to nothing is 0.
    let velocity = flux.carried / flux.volume;
    return volume * (parameters.gravity * (ground[cell].bed + water[cell].depth + water[cell].shift) + 0.5 * dot(velocity, velocity));
}

fn gather(cell: u32, base: Column) -> Gathered {
    let zero = vec2f(0.0);
    let step = step_of(cell);
    var all = Gathered(base.volume, zero, zero, zero, zero, zero, zero);
    for (var number = ground[cell].first_link; number < ground[cell].end_link; number++) {
        let link = links[number];
        if link.face == NONE {
            continue;
        }
        let flux = fluxes[link.face];
        let is_second_cell = link.side == 1u;
        let part = kept_of(cell, link, select(flux.volume, -flux.volume, is_second_cell));
        // The same bits on both sides.
        let volume = opaque(step * flux.volume * part);
        let carried = step * part * flux.carried;
        all.volume = add(all.volume, select(-volume, volume, is_second_cell));
        all.carried += select(-carried, carried, is_second_cell);
        all.thrust -= step * select(flux.thrust.x, flux.thrust.y, is_second_cell) * link.normal;
        if link.neighbour == NONE {
            let half = 0.5 * share_of(cell) * volume;
            all.outflow = add(all.outflow, max(half, 0.0));
            all.inflow = add(all.inflow, max(-half, 0.0));
            let energy = energy_of(cell, flux, half);
            all.energy += vec2f(max(energy, 0.0), max(-energy, 0.0));
            all.beyond -= carried;
        }
    }
    return all;
}

// The column of a cell after the stage, its velocity not bounded yet; what ground, borders and friction gave of momentum is added to `gained`.
fn next_column(cell: u32, base: Column, all: Gathered, gained: ptr<function, vec2f>) -> Column {
    let area = ground[cell].area;
    var volume = tidy(all.volume);
    if volume.x < 0.0 {
        volume = vec2f(0.0);
    }
    let pushed = base.momentum + (all.carried + all.thrust);
    let factor = friction_factor(ground[cell].friction, volume.x / area, length(pushed) / area, step_of(cell));
    var momentum = factor * pushed;
    *gained += 0.5 * share_of(cell) * (all.thrust + all.beyond + (factor - 1.0) * pushed);
    if IS_SECOND {
        let before = start_of(cell);
        volume = 0.5 * tidy(add_pair(volume, before.volume));
        momentum = 0.5 * (momentum + before.momentum);
    }
    return Column(volume, momentum);
}

// Sets the new column of a cell; `gained` as in `next_column`.
fn take_on(cell: u32, next: Column, gained: ptr<function, vec2f>) {
    let area = ground[cell].area;
    let bounded = bounded_momentum(next.momentum, next.volume.x, area);
    *gained += select(0.5 * share_of(cell), 1.0, IS_SECOND) * (bounded - next.momentum);
    let own = Column(next.volume, bounded);
    columns[cell] = own;
    water[cell] = water_of(own, area);
}

// Advances a cell by the stage; returns its totals over borders.
fn go_on(cell: u32) -> BorderTotals {
    let base = base_of(cell);
    let all = gather(cell, base);
    var gained = vec2f(0.0);
    var next = next_column(cell, base, all, &gained);
    if begins() {
        columns[parameters.cells + cell] = columns[cell];
    }
    if !IS_SECOND || ends_with(cell, &next) {
        take_on(cell, next, &gained);
    }
    let change = all.carried + all.thrust;
    let is_sound = is_finite(all.volume.x) && is_finite(change.x) && is_finite(change.y);
    return BorderTotals(all.outflow, all.inflow, all.energy, gained.x + gained.y, select(1u, 0u, is_sound));
}

fn combine(a: BorderTotals, b: BorderTotals) -> BorderTotals {
    return BorderTotals(
        add_pair(a.outflow, b.outflow),
        add_pair(a.inflow, b.inflow),
        a.energy + b.energy,
        a.momentum + b.momentum,
        a.is_broken | b.is_broken,
    );
}

@compute @workgroup_size(GROUP)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    var own = BorderTotals();
    if id.x < parameters.cells && is_in_step(id.x) {
        own = go_on(id.x);
    }
    let all = reduce_group(thread, own);
    if thread == 0u {
        if begins() {
            border_totals[group.x] = all;
        } else {
            border_totals[group.x] = combine(all, border_totals[group.x]);
        }
    }
}

// Sums a step over the groups, books it, and decides whether another step ends before the time until which the batch runs.
//
// `groups` has slots of three numbers: a thread for each particle, one for each cell, a group for each block of 1024 cells, one group, a thread for each drop in
// the air; where a row of gauges is due, a thread for each particle and drop, a group for each row, a thread for each position and row; where it is time to sample
// the maps, a thread for each of their cells.
#import sph_common
#import sph_rows
#import group_reduction

alias Reduced = Partial;

fn combine(a: Reduced, b: Reduced) -> Reduced {
    return Partial(
        a.outflow + b.outflow,
        a.inflow + b.inflow,
        a.knocked + b.knocked,
        a.gained_at_edges + b.gained_at_edges,
        a.lost_at_edges + b.lost_at_edges,
        a.slowed + b.slowed,
        a.outer_force + b.outer_force,
        min(a.low, b.low),
        max(a.high, b.high),
        a.sum_of_h + b.sum_of_h,
        0.0,
    );
}

// Books what the groups have summed up.
fn book(all: Partial) {
    status.outflow = add(status.outflow, all.outflow);
    status.inflow = add(status.inflow, all.inflow);
    status.clock = add(status.clock, status.step);
    book_momentum(all.knocked);
    book_momentum(all.gained_at_edges);
    book_momentum(-all.lost_at_edges);
    book_momentum(all.slowed);
    book_momentum(status.step * all.outer_force.x);
    book_momentum(status.step * all.outer_force.y);
    status.outer_force = all.outer_force;
    status.steps += 1u;
    status.particle_steps = count_up(status.particle_steps, status.particles);
    status.step = select(parameters.time_step, min(parameters.time_step, parameters.fall_step), status.falling > 0u);
    status.mean_h = all.sum_of_h / f32(max(status.particles, 1u));
    status.low = all.low;
    status.high = all.high;
}

fn decide() {
    // The length of steps does not depend on the particles: they are checked here.
    let is_sound = is_finite(status.mean_h) && is_finite(status.outer_force.x) && is_finite(status.outer_force.y);
    let has_reach = status.particles == 0u || status.mean_h > 0.0;
    if !is_sound || !has_reach {
        status.halted = BROKEN;
    } else if difference(status.until, status.clock) < status.step || difference(status.host_sample, status.clock) <= 0.0 {
        status.halted = ARRIVED;
    } else {
        status.halted = GOING;
    }
    let is_going = status.halted == GOING;
    let counts = array(
        (status.particles + GROUP - 1u) / GROUP,
        (status.cells + GROUP - 1u) / GROUP,
        (status.cells + SORT_BLOCK - 1u) / SORT_BLOCK,
        1u,
        select(0u, (parameters.in_air + GROUP - 1u) / GROUP, status.falling > 0u),
    );
    for (var slot = 0u; slot < GAUGES; slot++) {
        order_groups(slot, select(0u, counts[slot], is_going), 1u);
    }
    order_gauges();
}

fn order_groups(slot: u32, along: u32, rows: u32) {
    groups[3u * slot] = along;
    groups[3u * slot + 1u] = rows;
    groups[3u * slot + 2u] = 1u;
}

// Orders the rows of gauges that are due before the next step would end.
fn order_gauges() {
    status.rows_taken += status.rows_due;
    var rows_due = 0u;
    if status.halted != BROKEN {
        for (var k = status.rows_taken; k < status.rows_uploaded && difference(due[k], status.clock) < status.step; k++) {
            rows_due += 1u;
        }
    }
    status.rows_due = rows_due;
    order_groups(GAUGES, select(0u, groups_of_water(status.particles), rows_due > 0u), 1u);
    order_groups(GAUGES + 1u, select(0u, 1u, rows_due > 0u), rows_due);
    order_groups(GAUGES + 2u, select(0u, (status.gauge_positions + GAUGE_GROUP - 1u) / GAUGE_GROUP, rows_due > 0u), rows_due);
}

// Orders a sample of the maps where the step has passed the time of one.
fn order_map_sample() {
    var taken = status.map_times_taken;
    while taken < status.map_times_uploaded && difference(map_times[taken], status.clock) <= 0.0 {
        taken += 1u;
    }
    let is_time = taken > status.map_times_taken;
    if is_time {
        status.map_times_taken = taken;
        status.since_sample = difference(status.clock, status.last_sample);
        status.last_sample = status.clock;
    }
    order_groups(MAPS, select(0u, (status.map_cells + GROUP - 1u) / GROUP, is_time), 1u);
}

// Orders neither gauges nor maps.
fn rest() {
    for (var slot = GAUGES; slot < MAPS; slot++) {
        order_groups(slot, 0u, 0u);
    }
}

@compute @workgroup_size(GROUP)
fn main(@builtin(local_invocation_index) thread: u32) {
    var own = Partial(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, vec2f(0.0), vec2f(FAR), vec2f(-FAR), 0.0, 0.0);
    if status.halted == GOING {
        for (var group = thread; group < groups[0]; group += GROUP) {
            own = combine(own, partials[group]);
            // Spawned particles may need more groups than the drift had.
            partials[group].knocked = 0.0;
        }
    }
    let all = reduce_group(thread, own);
    if thread == 0u {
        order_groups(MAPS, 0u, 1u);
        if status.halted == GOING {
            book(all);
            order_map_sample();
        }
        if status.halted == GOING || status.halted == BATCH_START {
            decide();
        } else {
            rest();
        }
    }
}

// Sums up a step over the groups, books it, and decides whether there is another step before the time the host waits for.
#import flood_card
#import flood_accounts
#import flood_rows

@group(0) @binding(1) var<storage, read_write> status: Status;
@group(0) @binding(2) var<storage, read_write> partials: array<Partial>;
// Slots of three numbers: a thread for each particle, a thread for each cell, a group for each block of 1024 cells, one group; and where
// it rains or soaks in, a thread for each particle, a thread for each cell of the ground, one group; a thread for each particle in the air;
// where particles are split and merged, a thread for each particle; and where a row of gauges is due, a thread for each particle, cell of
// the ground and drop, a group for each row, a thread for each place and row; where it is time to look at the maps, a thread for each cell.
@group(0) @binding(3) var<storage, read_write> groups: array<u32>;

// Zones, structures and tables: see `works.rs`.
@group(0) @binding(4) var<storage, read> works: array<u32>;
// Times since the host last spoke at which rows of gauges are due, s.
@group(0) @binding(5) var<storage, read> due: array<f32>;
// The same at which it is to be looked at the maps, by the first step that ends then or after.
@group(0) @binding(6) var<storage, read> looks: array<f32>;

const FAR = 3.0e38;

// It rains once in so many steps.
const RAINS = 8u;

// Particles are split and merged once in so many steps, as in `flood/step.rs`.
const REFINED = 8u;

// The first of those for gauges, and that for maps.
const GAUGES = 9u;
const MAPS = 12u;

// Where `works` says where the levels of the sides are.
const LEVELS = 12u;

fn work(at: u32) -> f32 {
    return bitcast<f32>(works[at]);
}

// The level of a side at a time of the clock, by the rows that the host has told.
fn level_at(side: u32, time: f32) -> f32 {
    let window = works[LEVELS + side];
    if window == 0u {
        return 0.0;
    }
    let last = works[window] - 1u;
    var row = window + 1u;
    for (var k = 1u; k < last && work(row + 2u) <= time; k++) {
        row += 2u;
    }
    let part = (time - work(row)) / (work(row + 2u) - work(row));
    return work(row + 1u) + clamp(part, 0.0, 1.0) * (work(row + 3u) - work(row + 1u));
}

var<workgroup> sums: array<Partial, 256>;

fn joined(a: Partial, b: Partial) -> Partial {
    return Partial(
        a.outflow + b.outflow,
        a.inflow + b.inflow,
        a.booked_in_drift + b.booked_in_drift,
        a.gained_at_edges + b.gained_at_edges,
        a.lost_at_edges + b.lost_at_edges,
        a.booked_in_kick + b.booked_in_kick,
        a.from_outside + b.from_outside,
        min(a.longest_step, b.longest_step),
        a.sum_of_h + b.sum_of_h,
        min(a.low, b.low),
        max(a.high, b.high),
    );
}

// Books what the groups have summed up.
fn book(all: Partial) {
    var outflow = status.outflow;
    var inflow = status.inflow;
    var elapsed = status.elapsed;
    add(&outflow, all.outflow);
    add(&inflow, all.inflow);
    add(&elapsed, status.step);
    var clock = status.clock;
    add(&clock, status.step);
    status.clock = clock;
    // The force over the step by its means at both ends, in scheme sph-swe by that at its end.
    let mean = select(0.5 * (status.from_outside + all.from_outside), all.from_outside, parameters.scheme == SPH_SWE);
    let push = status.step * mean;
    let bookings = array(all.booked_in_drift, all.gained_at_edges, -all.lost_at_edges, all.booked_in_kick, push.x, push.y);
    var lost = status.momentum_lost;
    var gained = status.momentum_gained;
    for (var k = 0u; k < 6u; k++) {
        add(&lost, max(-bookings[k], 0.0));
        add(&gained, max(bookings[k], 0.0));
    }
    status.momentum_lost = lost;
    status.momentum_gained = gained;
    status.outflow = outflow;
    status.inflow = inflow;
    status.elapsed = elapsed;
    status.from_outside = all.from_outside;
    status.steps += 1u;
    let low = status.particle_steps.x + status.particles;
    status.particle_steps = vec2u(low, status.particle_steps.y + select(0u, 1u, low < status.particles));
    status.step = min(all.longest_step, parameters.longest_step);
    if status.falling > 0u {
        status.step = min(status.step, parameters.fall_step);
    }
    status.mean_h = all.sum_of_h / f32(max(status.particles, 1u));
    status.low = all.low;
    status.high = all.high;
}

// By their bits: compilers take a comparison that does not hold for its opposite.
fn is_numbers(values: vec2f) -> vec2<bool> {
    return (bitcast<vec2u>(values) & vec2u(0x7f800000u)) != vec2u(0x7f800000u);
}

fn is_number(value: f32) -> bool {
    return is_numbers(vec2f(value)).x;
}

fn decide() {
    // Scheme sph-swe has steps of one length, whatever comes of its particles.
    let is_sound = is_number(status.step) && is_number(status.mean_h) && all(is_numbers(status.from_outside));
    let has_reach = status.particles == 0u || status.mean_h > 0.0;
    if !is_sound || !has_reach || status.step <= parameters.shortest_step {
        status.halted = BROKEN;
    } else if status.elapsed.sum + status.step > status.until || status.elapsed.sum >= status.look {
        status.halted = ARRIVED;
    } else {
        status.halted = GOING;
    }
    for (var side = 0u; side < 4u; side++) {
        status.stages[side] = level_at(side, status.clock.sum);
        status.next_stages[side] = level_at(side, status.clock.sum + status.step);
    }
    let is_going = status.halted == GOING;
    let ground = parameters.patches.x * parameters.patches.y;
    let is_wetting = ground > 0u && (status.steps_before + status.steps) % RAINS == 0u;
    let is_refining = parameters.widest > 0.0 && (status.steps_before + status.steps) % REFINED == 0u;
    let counts = array(
        (status.particles + 255u) / 256u,
        (status.cells + 255u) / 256u,
        (status.cells + 1023u) / 1024u,
        1u,
        select(0u, (status.particles + 255u) / 256u, is_wetting),
        select(0u, (ground + 255u) / 256u, is_wetting),
        select(0u, 1u, is_wetting),
        select(0u, (parameters.in_air + 255u) / 256u, status.falling > 0u),
        select(0u, (status.particles + 255u) / 256u, is_refining),
    );
    for (var slot = 0u; slot < GAUGES; slot++) {
        order(slot, select(0u, counts[slot], is_going), 1u);
    }
    take_gauges();
}

fn order(slot: u32, along: u32, rows: u32) {
    groups[3u * slot] = along;
    groups[3u * slot + 1u] = rows;
    groups[3u * slot + 2u] = 1u;
}

// Finds which rows of gauges show the water as it stands now, and has them taken: those due before the next step would end.
fn take_gauges() {
    status.rows_taken += status.rows_due;
    var rows = 0u;
    if status.halted != BROKEN {
        for (var k = status.rows_taken; k < status.rows_told && due[k] < status.elapsed.sum + status.step; k++) {
            rows += 1u;
        }
    }
    status.rows_due = rows;
    order(GAUGES, select(0u, groups_of_water(parameters, status.particles), rows > 0u), 1u);
    order(GAUGES + 1u, select(0u, 1u, rows > 0u), rows);
    order(GAUGES + 2u, select(0u, (status.gauge_places + 63u) / 64u, rows > 0u), rows);
}

// Has it looked at the maps where the step has passed a time to.
fn take_looks() {
    var taken = status.looks_taken;
    while taken < status.looks_told && looks[taken] <= status.elapsed.sum {
        taken += 1u;
    }
    let is_time = taken > status.looks_taken;
    if is_time {
        status.looks_taken = taken;
        status.since_look = status.elapsed.sum - status.looked;
        status.looked = status.elapsed.sum;
    }
    order(MAPS, select(0u, (status.map_cells + 255u) / 256u, is_time), 1u);
}

// Nothing is due any more.
fn rest() {
    for (var slot = GAUGES; slot < MAPS; slot++) {
        order(slot, 0u, 0u);
    }
}

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_index) thread: u32) {
    var own = Partial(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, vec2f(0.0), FAR, 0.0, vec2f(FAR), vec2f(-FAR));
    if status.halted == GOING {
        for (var group = thread; group < groups[0]; group += 256u) {
            own = joined(own, partials[group]);
            // Births may call for more groups than there were in the drift.
            partials[group].booked_in_drift = 0.0;
        }
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
        order(MAPS, 0u, 1u);
        if status.halted == GOING {
            book(sums[0]);
            take_looks();
        }
        if status.halted == GOING || status.halted == SPOKEN {
            decide();
        } else {
            rest();
        }
    }
}

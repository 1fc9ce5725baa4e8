// Books a step, and decides whether another starts before the end of the batch.
#import declared
#import compensated_sums
#import next
#import voronoi_groups
#import group_reduction

// Totals of a step: see `BorderTotals` and `Found`. Energy is a pair of out and in.
struct Sums {
    outflow: vec2f,
    inflow: vec2f,
    energy: vec2f,
    rained: vec2f,
    infiltrated: vec2f,
    momentum: f32,
    step: f32,
    wet: u32,
    at_rim: u32,
    is_broken: u32,
}

alias Reduced = Sums;

fn combine(a: Sums, b: Sums) -> Sums {
    return Sums(
        add_pair(a.outflow, b.outflow),
        add_pair(a.inflow, b.inflow),
        a.energy + b.energy,
        add_pair(a.rained, b.rained),
        add_pair(a.infiltrated, b.infiltrated),
        a.momentum + b.momentum,
        min(a.step, b.step),
        a.wet + b.wet,
        a.at_rim + b.at_rim,
        a.is_broken | b.is_broken,
    );
}

// Totals of motion and end of the step in a group of cells.
fn of_group(group: u32) -> Sums {
    let moved = border_totals[group];
    let ended = found[group];
    let energy = moved.energy + vec2f(max(-ended.energy, 0.0), max(ended.energy, 0.0));
    return Sums(
        moved.outflow,
        add_pair(moved.inflow, ended.supplied),
        energy,
        ended.rained,
        ended.infiltrated,
        moved.momentum + ended.momentum,
        ended.step,
        ended.wet,
        ended.at_rim,
        moved.is_broken,
    );
}

// Totals of a thread's groups of cells; the first thread adds those of structures.
fn collected(thread: u32) -> Sums {
    var own = Sums();
    own.step = FAR;
    let all = groups_for(parameters.cells);
    if thread == 0u {
        let by_structures = border_totals[all];
        own.outflow = by_structures.outflow;
        own.inflow = by_structures.inflow;
        own.energy = by_structures.energy;
        own.momentum = by_structures.momentum;
    }
    for (var group = thread; group < all; group += GROUP) {
        own = combine(own, of_group(group));
    }
    return own;
}

fn book(all: Sums) {
    status.last_step = status.step;
    status.clock = tidy(add(status.clock, status.step));
    status.outflow = tidy(add_pair(status.outflow, all.outflow));
    status.inflow = tidy(add_pair(status.inflow, all.inflow));
    status.energy_out = tidy(add(status.energy_out, all.energy.x));
    status.energy_in = tidy(add(status.energy_in, all.energy.y));
    status.momentum_in = tidy(add(status.momentum_in, max(all.momentum, 0.0)));
    status.momentum_out = tidy(add(status.momentum_out, max(-all.momentum, 0.0)));
    status.rained = tidy(add_pair(status.rained, all.rained));
    status.infiltrated = tidy(add_pair(status.infiltrated, all.infiltrated));
    status.last_outflow = all.outflow;
    status.last_inflow = all.inflow;
    status.last_energy = all.energy;
    status.last_rained = all.rained;
    status.last_infiltrated = all.infiltrated;
    status.steps += 1u;
    status.all_steps += 1u;
    let drank = status.all_steps % STEPS_A_DRAUGHT == 0u;
    status.since_draught = select(status.since_draught + status.step, 0.0, drank);
    status.wet = all.wet;
    status.at_rim = all.at_rim;
    status.is_broken = all.is_broken;
    status.cell_steps = count_up(status.cell_steps, status.wet);
    status.step = min(COURANT * all.step, parameters.longest);
}

fn decide() -> u32 {
    if status.is_broken != 0u || !is_finite(status.step) {
        return BROKEN;
    }
    if status.at_rim != 0u {
        // There is water beside tiles that are not made yet.
        return NEEDS_HOST;
    }
    return select(ARRIVED, GOING, difference(status.until, status.clock) > 0.0);
}

@compute @workgroup_size(GROUP)
fn main(@builtin(local_invocation_index) thread: u32) {
    let was = status.halted;
    let all = reduce_group(thread, collected(thread));
    if thread == 0u {
        if was == GOING {
            book(all);
        }
        if was == GOING || was == BATCH_START {
            status.halted = decide();
        }
        let goes_on = status.halted == GOING;
        groups[3u * CELL_SLOT] = select(0u, groups_for(parameters.cells), goes_on);
        groups[3u * FACE_SLOT] = select(0u, groups_for(parameters.faces), goes_on);
        groups[3u * BORDER_SLOT] = select(0u, groups_for(parameters.borders), goes_on);
        groups[3u * DISCHARGE_SLOT] = select(0u, parameters.discharges, goes_on);
        groups[3u * CREST_SLOT] = select(0u, groups_for(parameters.crests), goes_on);
        groups[3u * BESIDE_CREST_SLOT] = select(0u, groups_for(parameters.beside_crests), goes_on);
        groups[3u * STRUCTURE_SLOT] = select(0u, 1u, goes_on);
        prepare_next(was, goes_on);
    }
}

// Outflows by rating, held levels and links in a step, one after another: see `structures/mod.rs`. One group does all.
#import declared
#import compensated_sums
#import voronoi_tables
#import voronoi_change
#import hydraulics
#import group_reduction

// Changes: volume as a compensated sum, energy and momentum over density.
alias Reduced = vec4f;

fn combine(a: Reduced, b: Reduced) -> Reduced {
    return vec4f(add_pair(a.xy, b.xy), a.zw + b.zw);
}

// Adds water to a cell of a patch; the change.
fn apply(entry: InPatch, volume: vec2f, momentum: vec2f) -> vec4f {
    let before = columns[entry.cell];
    var column = before;
    column.volume = tidy(add_pair(before.volume, volume));
    if column.volume.x < 0.0 {
        column.volume = vec2f(0.0);
    }
    column.momentum += momentum;
    let gained = tidy(add_pair(column.volume, -before.volume));
    let energy = energy_gained(entry.cell, before, column, entry.area, entry.bed);
    column.momentum = bounded_momentum(column.momentum, column.volume.x, entry.area);
    columns[entry.cell] = column;
    water[entry.cell] = water_in(entry.cell, column, entry.area);
    return vec4f(gained, energy, momentum.x + momentum.y);
}

// Mean level of the water of a patch by volume; `NO_LEVEL` where there is none.
fn level_of(thread: u32, own: Structure, end: u32) -> f32 {
    var sums = vec4f(0.0);
    for (var k = own.firsts[end] + thread; k < own.ends[end]; k += GROUP) {
        let entry = in_patches[k];
        let depth = water[entry.cell].depth;
        if depth > 0.0 {
            sums += entry.area * depth * vec4f(0.0, 0.0, 1.0, entry.above + depth + water[entry.cell].shift);
        }
    }
    sums = reduce_group(thread, sums);
    return select(NO_LEVEL, sums.w / sums.z, sums.z > 0.0);
}

// Takes a volume from the cells in proportion to what they hold, and all they hold at most, with its velocity.
fn take(thread: u32, own: Structure, end: u32, wanted: f32) -> vec4f {
    var held = vec4f(0.0);
    for (var k = own.firsts[end] + thread; k < own.ends[end]; k += GROUP) {
        held.z += columns[in_patches[k].cell].volume.x;
    }
    held = reduce_group(thread, held);
    var change = vec4f(0.0);
    if held.z > 0.0 && wanted > 0.0 {
        let share = min(wanted / held.z, 1.0);
        for (var k = own.firsts[end] + thread; k < own.ends[end]; k += GROUP) {
            let column = columns[in_patches[k].cell];
            // All of it to the last bit, or a part.
            let volume = select(vec2f(opaque(share * column.volume.x), 0.0), column.volume, share == 1.0);
            change = combine(change, apply(in_patches[k], -volume, -share * column.momentum));
        }
    }
    return reduce_group(thread, change);
}

// Raises the surface evenly by a volume at rest; the first cell gets what rounding leaves.
fn give(thread: u32, own: Structure, end: u32, volume: vec2f) -> vec4f {
    var change = vec4f(0.0);
    for (var k = own.firsts[end] + thread; k < own.ends[end]; k += GROUP) {
        let entry = in_patches[k];
        let part = opaque(volume.x * (entry.area / own.areas[end]));
        change = combine(change, apply(entry, vec2f(part, 0.0), vec2f(0.0)));
    }
    var all = reduce_group(thread, change);
    var rest = vec4f(0.0);
    if thread == 0u && own.firsts[end] < own.ends[end] {
        let left = tidy(add_pair(volume, -all.xy));
        rest = apply(in_patches[own.firsts[end]], left, vec2f(0.0));
    }
    return combine(all, reduce_group(thread, rest));
}

// Brings each cell to a level; what is added has the velocity of the water there.
fn hold(thread: u32, own: Structure) -> vec4f {
    let level = in_step(own.table, AT_BEGINNING + 1u);
    var change = vec4f(0.0);
    for (var k = own.firsts[0] + thread; k < own.ends[0]; k += GROUP) {
        let entry = in_patches[k];
        let wanted = entry.area * depth_below(entry.cell, level - entry.above);
        let volume = tidy(add_pair(vec2f(wanted, 0.0), -columns[entry.cell].volume));
        change = combine(change, apply(entry, volume, volume.x * water[entry.cell].velocity));
    }
    return reduce_group(thread, change);
}

fn culvert_of(word: u32) -> Culvert {
    return Culvert(
        number(word), number(word + 1u), number(word + 2u), number(word + 3u), vec2f(number(word + 4u), number(word + 5u)),
        number(word + 6u), number(word + 7u), number(word + 8u)
    );
}

// Discharge from the end where the water stands at `upper` to where it stands at `lower`; `forward` from the first to the second.
fn by_law(own: Structure, upper: f32, lower: f32, forward: bool) -> f32 {
    if own.law == CULVERT {
        let culvert = culvert_of(own.numbers);
        let floors = select(culvert.floor.yx, culvert.floor, forward);
        return through_culvert(culvert, upper, lower, floors, parameters.gravity);
    }
    if own.law == WEIR {
        return over_weir(number(own.numbers), number(own.numbers + 1u), number(own.numbers + 2u), upper, lower);
    }
    // Where it has run dry the fall is not known: as from the same ground.
    return value_at(own.table, vec2f(select(upper - lower, 0.0, lower == NO_LEVEL), 0.0));
}

// Discharge required, positive from the first end to the second: see `Link::discharge`.
fn of_link(own: Structure, first: f32, second: f32) -> f32 {
    if first >= second {
        return select(by_law(own, first, second, true), 0.0, first == NO_LEVEL);
    }
    if own.both_ways == 1u {
        return -by_law(own, second, first, false);
    }
    return 0.0;
}

// Leads water from one end to the other; what that changed, and the discharge is written.
fn lead(thread: u32, number: u32, own: Structure) -> vec4f {
    let first = level_of(thread, own, 0u);
    let second = level_of(thread, own, 1u);
    let wanted = of_link(own, first, second);
    let source = select(0u, 1u, wanted < 0.0);
    let taken = take(thread, own, source, abs(wanted) * status.step);
    let given = give(thread, own, 1u - source, -taken.xy);
    if thread == 0u {
        structure_discharges[number] = select(given.x, -given.x, wanted < 0.0) / status.step;
    }
    return vec4f(combine(taken, given).xyz, taken.w);
}

fn let_out(thread: u32, number: u32, own: Structure) -> vec4f {
    let level = level_of(thread, own, 0u);
    let wanted = select(max(value_at(own.table, vec2f(level, 0.0)), 0.0), 0.0, level == NO_LEVEL);
    let change = take(thread, own, 0u, wanted * status.step);
    if thread == 0u {
        structure_discharges[number] = -change.x / status.step;
    }
    return change;
}

fn book(books: ptr<function, BorderTotals>, change: vec4f) {
    if change.x > 0.0 {
        (*books).inflow = add_pair((*books).inflow, change.xy);
    } else {
        (*books).outflow = add_pair((*books).outflow, -change.xy);
    }
    (*books).energy += vec2f(max(-change.z, 0.0), max(change.z, 0.0));
    (*books).momentum += change.w;
}

@compute @workgroup_size(GROUP)
fn main(@builtin(local_invocation_index) thread: u32) {
    var books = BorderTotals();
    for (var k = 0u; k < parameters.structures; k++) {
        let own = structures[k];
        if own.kind == OUTFLOW {
            book(&books, let_out(thread, k, own));
        } else if own.kind == HOLD {
            book(&books, hold(thread, own));
        } else {
            book(&books, lead(thread, k, own));
        }
        storageBarrier();
    }
    if thread == 0u {
        border_totals[(parameters.cells + GROUP - 1u) / GROUP] = books;
    }
}

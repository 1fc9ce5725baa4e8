// Time steps of cells that take steps of their own: see `local/mod.rs`. Where `status.parts` is 1 all take the same.
#import declared
#import stage
#import compensated_sums

// Level, pace, near and view of a cell: two bits each.
fn paces(cell: u32) -> u32 {
    return select(0u, ground[cell].paces, status.parts > 1u);
}

fn level_of(cell: u32) -> u32 {
    return extractBits(paces(cell), 0u, 2u);
}

fn pace_of(cell: u32) -> u32 {
    return extractBits(paces(cell), 2u, 2u);
}

fn is_in_step(cell: u32) -> bool {
    return pace_of(cell) <= status.now;
}

fn is_near(cell: u32) -> bool {
    return extractBits(paces(cell), 4u, 2u) <= status.now;
}

fn is_seen(cell: u32) -> bool {
    return extractBits(paces(cell), 6u, 2u) <= status.now;
}

fn near_of_face(face: u32) -> u32 {
    return fluxes[face].near;
}

fn is_needed(near: u32) -> bool {
    return status.parts <= 1u || near <= status.now;
}

fn step_of(cell: u32) -> f32 {
    return status.shortest * f32(1u << level_of(cell));
}

fn share_of(cell: u32) -> f32 {
    return 1.0 / f32(1u << (level_of(cell) - pace_of(cell)));
}

fn volume_of(cell: u32) -> f32 {
    return water[cell].depth * ground[cell].area;
}

fn begins() -> bool {
    return !IS_SECOND && status.part == 0u;
}

fn base_of(cell: u32) -> Column {
    if IS_SECOND {
        return columns[cell];
    }
    return start_of(cell);
}

fn start_of(cell: u32) -> Column {
    return columns[2u * parameters.cells + cell];
}

// The means of the repetitions are added up with their shares, which are powers of two: what passes a face counts for the same on both sides, to the bit.
fn ends_with(cell: u32, next: ptr<function, Column>) -> bool {
    let share = share_of(cell);
    var sum = columns[3u * parameters.cells + cell];
    sum.volume = tidy(add_pair(sum.volume, share * (*next).volume));
    sum.momentum += share * (*next).momentum;
    columns[3u * parameters.cells + cell] = sum;
    *next = sum;
    return (status.part + (1u << pace_of(cell))) % (1u << level_of(cell)) == 0u;
}

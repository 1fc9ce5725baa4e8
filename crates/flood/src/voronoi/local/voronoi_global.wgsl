// Time steps where all cells take the same: what `voronoi_local.wgsl` has where they do not.
#import declared
#import stage

fn is_in_step(cell: u32) -> bool {
    return true;
}

fn is_seen(cell: u32) -> bool {
    return true;
}

fn is_near(cell: u32) -> bool {
    return true;
}

fn near_of_face(face: u32) -> u32 {
    return 0u;
}

fn is_needed(near: u32) -> bool {
    return true;
}

// The time step of a cell, s.
fn step_of(cell: u32) -> f32 {
    return status.step;
}

// Which part of its own step is what a cell does now.
fn share_of(cell: u32) -> f32 {
    return 1.0;
}

// Volume in a cell for its neighbours, m3.
fn volume_of(cell: u32) -> f32 {
    return columns[cell].volume.x;
}

// Whether what happens is the first of a step.
fn begins() -> bool {
    return !IS_SECOND;
}

// The column that the stage of a cell begins with.
fn base_of(cell: u32) -> Column {
    return columns[cell];
}

// The column at the start of a cell's step.
fn start_of(cell: u32) -> Column {
    return columns[parameters.cells + cell];
}

// Whether a cell's step ends with the second stage, by whose mean with the start it goes on; then `next` is the column at its end.
fn ends_with(cell: u32, next: ptr<function, Column>) -> bool {
    return true;
}

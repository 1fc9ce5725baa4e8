// What the kernels of water on the device share: numbers of the picture, and cells. Positions are counted from the middle of the stage, m.
#import declared

fn of_ground(water: Settings) -> u32 {
    return water.columns * water.rows;
}

// Column and row of a position.
fn cell_at(water: Settings, position: vec2f) -> vec2u {
    let at = vec2u(max((position - water.corner) * water.per_cell, vec2f(0.0)));
    return min(at, vec2u(water.columns, water.rows) - 1u);
}

// What a cell holds below a level, and the level of what it holds: see `storage.rs`. Levels and heights are above the mean bed.
#import declared
#import voronoi_tables
#import voronoi_water

fn height(cell: u32, part: u32) -> f32 {
    return number(parameters.heights + PARTS * cell + part);
}

// The level at which a cell holds a depth, spread over all of it; that of its lowest part where it is dry.
fn level_over(cell: u32, depth: f32) -> f32 {
    if parameters.heights == NONE || depth >= height(cell, PARTS - 1u) {
        return depth;
    }
    var sum = depth * f32(PARTS);
    for (var part = 0u; part < PARTS; part++) {
        sum += height(cell, part);
        let level = sum / f32(part + 1u);
        if part + 1u == PARTS || level <= height(cell, part + 1u) {
            return level;
        }
    }
    return depth;
}

// Water below a level, spread over all of the cell.
fn depth_below(cell: u32, level: f32) -> f32 {
    if parameters.heights == NONE {
        return max(level, 0.0);
    }
    if level >= height(cell, PARTS - 1u) {
        return level;
    }
    var sum = 0.0;
    for (var part = 0u; part < PARTS; part++) {
        sum += max(level - height(cell, part), 0.0);
    }
    return sum / f32(PARTS);
}

// The water of a column in a cell.
fn water_in(cell: u32, column: Column, area: f32) -> Water {
    var own = water_of(column, area);
    own.shift = level_over(cell, own.depth) - own.depth;
    return own;
}

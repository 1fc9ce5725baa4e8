// The water of a column: see `water.rs`.
#import declared

fn water_of(column: Column, area: f32) -> Water {
    let depth = max(column.volume.x / area, 0.0);
    if depth < STILL {
        return Water(vec2f(0.0), depth, 0.0);
    }
    return Water(column.momentum / column.volume.x, depth, 0.0);
}

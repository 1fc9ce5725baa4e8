// The water of a column: see `water.rs`.
#import declared

// The momentum of a film so thin that its velocity is kept finite, and none where it does not move: see `Water::of` in `water.rs`.
fn bounded_momentum(momentum: vec2f, volume: f32, area: f32) -> vec2f {
    let depth = volume / area;
    if depth < STILL {
        return vec2f(0.0);
    }
    if depth >= THIN {
        return momentum;
    }
    let part = depth / THIN;
    return momentum * (2.0 * part * part / (part * part + 1.0));
}

fn water_of(column: Column, area: f32) -> Water {
    let depth = max(column.volume.x / area, 0.0);
    if depth < STILL {
        return Water(vec2f(0.0), depth, 0.0);
    }
    return Water(column.momentum / column.volume.x, depth, 0.0);
}

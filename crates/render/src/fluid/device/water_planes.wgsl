// Planes of least squares through the columns round one. Twin of `Planes` in `water.rs`.
#import water_device

// Height and velocity at a column, their slopes east and north, and the sum of the weights.
struct Fit {
    here: vec3f,
    east: vec3f,
    north: vec3f,
    weight: f32,
}

// With few neighbours, or all in a line, heights follow the ground across it, and velocities do not change.
fn fit_at(i: u32) -> Fit {
    let own = sites[i];
    let ground = motions[i].zw;
    let reach = REACH * own.w;
    let low = cell_at(water, own.xy - reach);
    let high = cell_at(water, own.xy + reach);
    var weight = 0.0;
    var at = vec2f(0.0);
    // East by east, east by north, north by north.
    var spread = vec3f(0.0);
    var state = vec3f(0.0);
    var state_x = vec3f(0.0);
    var state_y = vec3f(0.0);
    for (var row = low.y; row <= high.y; row++) {
        let end = start[row * water.columns + high.x + 1u];
        for (var k = start[row * water.columns + low.x]; k < end; k++) {
            let near = sites[k].xyz;
            let away = near.xy - own.xy;
            let left = 1.0 - dot(away, away) / (reach * reach);
            if left > 0.0 {
                let share = left * left * left;
                // Heights over a plane along the ground, so that planes of few neighbours lie along it; from the own height, which
                // spares digits.
                let there = share * vec3f(near.z - own.z - dot(ground, away), motions[k].xy);
                weight += share;
                at += share * away;
                spread += share * vec3f(away.x * away.x, away.x * away.y, away.y * away.y);
                state += there;
                state_x += away.x * there;
                state_y += away.y * there;
            }
        }
    }
    let middle = at / weight;
    let mean = state / weight;
    let level = LEVEL * own.w * own.w;
    let xx = spread.x / weight - middle.x * middle.x + level;
    let xy = spread.y / weight - middle.x * middle.y;
    let yy = spread.z / weight - middle.y * middle.y + level;
    let x = state_x / weight - middle.x * mean;
    let y = state_y / weight - middle.y * mean;
    let determinant = xx * yy - xy * xy;
    let east = (yy * x - xy * y) / determinant;
    let north = (xx * y - xy * x) / determinant;
    let here = mean - middle.x * east - middle.y * north + vec3f(own.z, 0.0, 0.0);
    return Fit(here, east + vec3f(ground.x, 0.0, 0.0), north + vec3f(ground.y, 0.0, 0.0), weight);
}

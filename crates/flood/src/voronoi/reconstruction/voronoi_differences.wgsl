// Differences between cells: see `reconstruction/mod.rs`.
#import declared

// Differences of depth and level to a neighbour whose bed stands `rise` higher. Films on ground above the level here do not raise or lower its slope.
fn differences(here: f32, there: f32, rise: f32) -> vec2f {
    let depth = there - here;
    let level = depth + rise;
    // The neighbour's bed stands above the level here.
    if level > there {
        let share = min(FILM * there / here, 1.0);
        return share * share * vec2f(depth, level);
    }
    return vec2f(depth, level);
}

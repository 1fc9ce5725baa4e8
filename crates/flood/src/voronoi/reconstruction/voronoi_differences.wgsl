// Differences between cells: see `reconstruction/mod.rs`.
#import declared

// How much higher the level of a neighbour is whose bed stands `rise` higher.
fn higher(here: Water, there: Water, rise: f32) -> f32 {
    return there.depth - here.depth + rise + (there.shift - here.shift);
}

// Differences of depth and level to a neighbour whose bed stands `rise` higher. Films on ground above the level here do not raise or lower its slope.
fn differences(here: Water, there: Water, rise: f32) -> vec2f {
    let depth = there.depth - here.depth;
    let level = higher(here, there, rise);
    // The neighbour's bed stands above the level here.
    if level > there.depth {
        let share = min(FILM * there.depth / here.depth, 1.0);
        return share * share * vec2f(depth, level);
    }
    return vec2f(depth, level);
}

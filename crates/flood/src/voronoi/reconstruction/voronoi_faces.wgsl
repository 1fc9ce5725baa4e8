// Values at faces: see `reconstruction/mod.rs`.
#import declared

// Water at a face, reconstructed from one side: depth and level, m, velocity across and along the face, m/s, and how much higher than the cell's own the level is, m.
struct AtFace {
    depth: f32,
    level: f32,
    across: f32,
    along: f32,
    higher: f32,
}

// Monotonised central limiter of two differences (van Leer 1977, equation 66).
fn limit(a: f32, b: f32) -> f32 {
    let least = min(0.5 * abs(a + b), 2.0 * min(abs(a), abs(b)));
    return select(0.0, select(least, -least, a < 0.0), a * b > 0.0);
}

// Change from the centroid to the middle of the face: half the limited difference, and along the face by the slope as far as that was kept. `whole` is the
// difference by the slope, `along` the change by it from the middle between the centroids to that of the face.
fn change(difference: f32, whole: f32, along: f32) -> f32 {
    let limited = limit(2.0 * whole - difference, difference);
    if abs(whole) < 1e-30 {
        return 0.5 * limited;
    }
    return 0.5 * limited + clamp(limited / whole, 0.0, 1.0) * along;
}

// Components of a velocity across and along a face.
fn turned(velocity: vec2f, normal: vec2f) -> vec2f {
    return vec2f(dot(velocity, normal), velocity.y * normal.x - velocity.x * normal.y);
}

// Reconstruction from one side. `level` is its own level above that of the first cell, `between` goes to the other centroid, `differences` are those of depth and level.
fn seen(
    own: Water, other: Water, level: f32, slope: Slopes, differences: vec2f, between: vec2f, offset: vec2f, normal: vec2f
) -> AtFace {
    if own.depth <= 0.0 {
        return AtFace(0.0, level, 0.0, 0.0, 0.0);
    }
    let whole = slope.x * between.x + slope.y * between.y;
    let along = slope.x * offset.x + slope.y * offset.y;
    // Next to no water has neither slopes nor a velocity that count.
    let thick = min(own.depth / THIN, 1.0);
    let both = min(min(own.depth, other.depth) / THIN, 1.0);
    let deeper = thick * change(differences.x, whole.x, along.x);
    let higher = thick * change(differences.y, whole.y, along.y);
    // The depth changes by itself at most. On rough ground what is too much is taken off the level too: otherwise waves on a lake grow there.
    let kept = clamp(deeper, -own.depth, own.depth);
    let of_bed = higher - deeper;
    let share = higher * higher / (higher * higher + of_bed * of_bed + 1e-37);
    let bounded = higher - share * (deeper - kept);
    var velocity = own.velocity;
    let faster = both * (other.velocity - own.velocity);
    velocity += both * vec2f(change(faster.x, whole.z, along.z), change(faster.y, whole.w, along.w));
    let at = turned(velocity, normal);
    return AtFace(max(own.depth + kept, 0.0), level + bounded, at.x, at.y, bounded);
}

// The water at a wall, reconstructed from its cell: level and depth are the cell's, the velocity tends to that of its mirror image.
fn at_wall(own: Water, slope: Slopes, between: vec2f, offset: vec2f, normal: vec2f) -> AtFace {
    let mirrored = -2.0 * dot(own.velocity, normal) * normal;
    let whole = slope.x.zw * between.x + slope.y.zw * between.y;
    let along = slope.x.zw * offset.x + slope.y.zw * offset.y;
    let faster = vec2f(change(mirrored.x, whole.x, along.x), change(mirrored.y, whole.y, along.y));
    let at = turned(own.velocity + faster, normal);
    return AtFace(own.depth, 0.0, at.x, at.y, 0.0);
}

// The water at a side of the terrain: the cell's own.
fn at_side(own: Water, normal: vec2f) -> AtFace {
    let at = turned(own.velocity, normal);
    return AtFace(own.depth, 0.0, at.x, at.y, 0.0);
}

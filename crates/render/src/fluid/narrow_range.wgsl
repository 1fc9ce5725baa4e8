// Narrow-range filter of depth (Truong and Yuksel, A Narrow-Range Filter for Screen-Space Fluid Rendering, 2018): what is much
// nearer is left out, what is much farther is taken for a little farther, and the range grows with the slope that it meets.
// Rows, then columns, then a small square that takes away the streaks of the two.
#import smoothing

// Half the side of the square.
const SQUARE: i32 = 2;

// Distances that count as the same surface: nearest and farthest.
struct Range {
    near: f32,
    far: f32,
}

fn widened(range: Range, there: f32) -> Range {
    return Range(min(range.near, there - fluid.smoothing.y), max(range.far, there + fluid.smoothing.y));
}

// A pixel on one side of another.
struct Side {
    // Its distance.
    there: f32,
    // 1 where it counts, 0 where it is much nearer.
    counts: f32,
    // Much farther: another surface, or none at all.
    beyond: bool,
}

fn side(there: f32, range: Range) -> Side {
    let beyond = there == 0.0 || there > range.far;
    return Side(there, select(0.0, 1.0, beyond || there >= range.near), beyond);
}

// The distance that a side counts with. What is beyond an edge counts as a little farther, so that edges get round; but no less far
// than the surface would be that goes on as it came from the other side. Otherwise the edge of a surface seen at a grazing angle would
// rise towards the eye (our addition: the paper has the first only).
fn taken(one: Side, other: Side, here: f32) -> f32 {
    if !one.beyond {
        return one.there;
    }
    return max(here + fluid.smoothing.z, select(2.0 * here - other.there, here, other.beyond));
}

@compute @workgroup_size(PIXELS_ACROSS, PIXELS_DOWN)
fn along(@builtin(global_invocation_id) id: vec3u) {
    let pixel = vec2i(id.xy);
    if any(pixel >= vec2i(textureDimensions(distances))) {
        return;
    }
    let here = distance_at(pixel);
    var range = Range(here - fluid.smoothing.y, here + fluid.smoothing.y);
    var sum = here;
    var weights = 1.0;
    let width = select(0, width_in_pixels(here), here > 0.0);
    let sigma = max(f32(width) / 3.0, 0.5);
    for (var out = 1; out <= width; out++) {
        let left = side(distance_at(pixel - out * direction.step), range);
        let right = side(distance_at(pixel + out * direction.step), range);
        // Both sides or none: a filter that leans to one side moves the surface.
        let weight = gauss(f32(out), sigma) * left.counts * right.counts;
        sum += weight * (taken(left, right, here) + taken(right, left, here));
        weights += 2.0 * weight;
        if weight > 0.0 {
            // Only pixels of the surface determine its slope.
            if !left.beyond {
                range = widened(range, left.there);
            }
            if !right.beyond {
                range = widened(range, right.there);
            }
        }
    }
    textureStore(smoothed, pixel, vec4f(sum / weights));
}

@compute @workgroup_size(PIXELS_ACROSS, PIXELS_DOWN)
fn square(@builtin(global_invocation_id) id: vec3u) {
    let pixel = vec2i(id.xy);
    if any(pixel >= vec2i(textureDimensions(distances))) {
        return;
    }
    let here = distance_at(pixel);
    let range = Range(here - fluid.smoothing.y, here + fluid.smoothing.y);
    var sum = here;
    var weights = 1.0;
    if here > 0.0 {
        // Half of the square's pixels, each with the one opposite.
        for (var y = 0; y <= SQUARE; y++) {
            for (var x = select(-SQUARE, 1, y == 0); x <= SQUARE; x++) {
                let out = vec2i(x, y);
                let one = side(distance_at(pixel - out), range);
                let other = side(distance_at(pixel + out), range);
                let weight = gauss(length(vec2f(out)), 0.5 * f32(SQUARE)) * one.counts * other.counts;
                sum += weight * (taken(one, other, here) + taken(other, one, here));
                weights += 2.0 * weight;
            }
        }
    }
    textureStore(smoothed, pixel, vec4f(sum / weights));
}

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

// A pixel on one side: its distance as it counts, and 1 where it counts, 0 where not.
fn counted(there: f32, here: f32, range: Range) -> vec2f {
    // No fluid is as far away as can be.
    if there == 0.0 || there > range.far {
        return vec2f(here + fluid.smoothing.z, 1.0);
    }
    return vec2f(there, select(0.0, 1.0, there >= range.near));
}

@compute @workgroup_size(32, 2)
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
        let left = distance_at(pixel - out * direction.step);
        let right = distance_at(pixel + out * direction.step);
        let one = counted(left, here, range);
        let other = counted(right, here, range);
        // Both sides or none: a filter that leans to one side moves the surface.
        let weight = gauss(f32(out), sigma) * one.y * other.y;
        sum += weight * (one.x + other.x);
        weights += 2.0 * weight;
        if weight > 0.0 {
            // Only what is on the surface tells of its slope.
            if left > 0.0 && left <= range.far {
                range = widened(range, left);
            }
            if right > 0.0 && right <= range.far {
                range = widened(range, right);
            }
        }
    }
    textureStore(smoothed, pixel, vec4f(sum / weights));
}

@compute @workgroup_size(32, 2)
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
                let one = counted(distance_at(pixel - out), here, range);
                let other = counted(distance_at(pixel + out), here, range);
                let weight = gauss(length(vec2f(out)), 0.5 * f32(SQUARE)) * one.y * other.y;
                sum += weight * (one.x + other.x);
                weights += 2.0 * weight;
            }
        }
    }
    textureStore(smoothed, pixel, vec4f(sum / weights));
}

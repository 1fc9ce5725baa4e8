// Columns of air outside open sides. Twin of `faces/open.rs`.
#import dew_particles

// Velocities are counted in units of 2^-23 of the speed of sound, as fine as single precision has densities; each up to four times sound, so
// that there is room for 63 particles before a column, where some two stand.
const UNITS = 8388608.0;
const FASTEST = 4.0;

fn units_of(velocity: f32) -> i32 {
    return i32(round(UNITS * clamp(velocity / parameters.sound, -FASTEST, FASTEST)));
}

fn velocity_of(units: f32) -> f32 {
    return parameters.sound / UNITS * units;
}

// Depths, which are not negative, in the order of their bits; 0 is none.
fn bits_of_depth(depth: f32) -> u32 {
    return bitcast<u32>(max(depth, 0.0)) + 1u;
}

fn columns_along(number: u32) -> vec2u {
    let axis = number / 2u;
    return vec2u(parameters.counts[(axis + 1u) % 3u], parameters.counts[(axis + 2u) % 3u]);
}

// The first column of a side.
fn first_column(number: u32) -> u32 {
    var first = 0u;
    for (var other = 0u; other < number; other++) {
        if face(other) == OPEN {
            let along = columns_along(other);
            first += along.x * along.y;
        }
    }
    return first;
}

// The column of a side that a position is in. Twin of `OpenSide::column`.
fn column_of(number: u32, position: vec3f) -> u32 {
    let axis = number / 2u;
    let a = (axis + 1u) % 3u;
    let b = (axis + 2u) % 3u;
    let at = max((position - parameters.low) / parameters.apart, vec3f(0.0));
    let along = columns_along(number);
    return first_column(number) + min(u32(at[a]), along.x - 1u) + along.x * min(u32(at[b]), along.y - 1u);
}

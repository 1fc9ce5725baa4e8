// Neighbour search: cells to search, and ghost particles beyond faces.
//
// Ghost particles are not stored as on the CPU: near a face the search is repeated from the mirrored position, and what it finds is
// mirrored. So each pass loops over `Mirror`s, the first of which is the identity. Twin of `Room::ghost_particles`.
#import dew_particles
#import smoothing_kernel

struct Mirror {
    // The ghost particle of a position p stands at sign * p + shift.
    sign: vec3f,
    shift: vec3f,
}

// Whether there are ghost particles beyond the low and the high side of an axis that may be within reach of a position.
fn shown_beyond(axis: u32, at: f32) -> vec2<bool> {
    let is_near = vec2f(at - parameters.low[axis], parameters.high[axis] - at) < vec2f(parameters.h);
    let rules = vec2u(face(2u * axis), face(2u * axis + 1u));
    return is_near & (rules <= vec2u(PERIODIC));
}

fn mirrors_along(axis: u32, at: f32) -> u32 {
    let beyond = shown_beyond(axis, at);
    return 1u + u32(beyond.x) + u32(beyond.y);
}

// Number of mirrors to search from a position, the identity among them: away from the faces that alone.
fn mirrors_round(position: vec3f) -> u32 {
    let is_amid = all(position - parameters.h > parameters.low) && all(position + parameters.h < parameters.high);
    if is_amid {
        return 1u;
    }
    return mirrors_along(0u, position.x) * mirrors_along(1u, position.y) * mirrors_along(2u, position.z);
}

// Sign and shift of the mirror of a number along an axis: 0 is the identity, then the low side and the high one where they have ghost particles.
fn along(axis: u32, number: u32, at: f32) -> vec2f {
    if number == 0u {
        return vec2f(1.0, 0.0);
    }
    let low = parameters.low[axis];
    let high = parameters.high[axis];
    let is_low = number == 1u && shown_beyond(axis, at).x;
    if face(2u * axis + select(1u, 0u, is_low)) == PERIODIC {
        return vec2f(1.0, select(high - low, low - high, is_low));
    }
    return vec2f(-1.0, 2.0 * select(high, low, is_low));
}

// The mirror of a number below `mirrors_round` from a position; 0 is the identity.
fn mirror(number: u32, position: vec3f) -> Mirror {
    if number == 0u {
        return Mirror(vec3f(1.0), vec3f(0.0));
    }
    let mirrors_x = mirrors_along(0u, position.x);
    let mirrors_y = mirrors_along(1u, position.y);
    let x = along(0u, number % mirrors_x, position.x);
    let y = along(1u, (number / mirrors_x) % mirrors_y, position.y);
    let z = along(2u, number / (mirrors_x * mirrors_y), position.z);
    return Mirror(vec3f(x.x, y.x, z.x), vec3f(x.y, y.y, z.y));
}

// The original position of a ghost particle at `position`.
fn behind(mirror: Mirror, position: vec3f) -> vec3f {
    return mirror.sign * (position - mirror.shift);
}

// Where the mirror shows what stands at `position`.
fn shown(mirror: Mirror, position: vec3f) -> vec3f {
    return mirror.sign * position + mirror.shift;
}

fn cell_index(position: vec3f) -> vec3u {
    return min(vec3u(max((position - parameters.corner) * parameters.per_cell, vec3f(0.0))), parameters.cells - 1u);
}

// The number of a row of cells along x.
fn row_of(y: u32, z: u32) -> u32 {
    return (z * parameters.cells.y + y) * parameters.cells.x;
}

// First and last column of those cells of a row in which there may be something within reach of a position. None: the first comes after
// the last.
fn columns_round(position: vec3f, y: u32, z: u32) -> vec2u {
    let size = 1.0 / parameters.per_cell;
    let border = CELL_BORDER * size;
    let row = vec2u(y, z);
    let low = parameters.corner.yz + size * vec2f(row);
    // Particles beyond the first and the last row are stored in these.
    let below = select(low - position.yz, vec2f(0.0), row == vec2u(0u));
    let above = select(position.yz - low - size, vec2f(0.0), row + 1u == parameters.cells.yz);
    let apart = max(max(below, above) - border, vec2f(0.0));
    let left = parameters.h * parameters.h - dot(apart, apart);
    if left < 0.0 {
        return vec2u(1u, 0u);
    }
    let half = sqrt(left) + border;
    let ends = max((position.x + vec2f(-half, half) - parameters.corner.x) * parameters.per_cell, vec2f(0.0));
    return min(vec2u(ends), vec2u(parameters.cells.x - 1u));
}

fn cell_at(position: vec3f) -> u32 {
    let cell = cell_index(position);
    return row_of(cell.y, cell.z) + cell.x;
}

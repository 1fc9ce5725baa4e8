// Who is near: cells to look through, images beyond faces, and kernels.
//
// Images are not stored as the CPU's are: who stands near a face looks once more from where it would stand in the mirror, and turns
// what it finds. So each pass goes through `Mirror`s, the first of which shows things as they are. Twin of `Room::images`.
#import dew_card

struct Mirror {
    // The image of a place p stands at sign * p + shift.
    sign: vec3f,
    shift: vec3f,
    is_there: bool,
}

const MIRRORS = 27u;

// How many of them there are to look into: amid the room the first alone.
fn mirrors_round(place: vec3f) -> u32 {
    let is_amid = all(place - parameters.h > parameters.low) && all(place + parameters.h < parameters.high);
    return select(MIRRORS, 1u, is_amid);
}

// Sign, shift, and whether an image beyond a side of an axis, 1 low and 2 high, may be within reach; 0 is no side.
fn along(axis: u32, side: u32, at: f32) -> vec3f {
    if side == 0u {
        return vec3f(1.0, 0.0, 1.0);
    }
    let low = parameters.low[axis];
    let high = parameters.high[axis];
    let is_near = select(high - at, at - low, side == 1u) < parameters.h;
    let rule = face(2u * axis + side - 1u);
    if rule == PERIODIC {
        return vec3f(1.0, select(high - low, low - high, side == 1u), select(0.0, 1.0, is_near));
    }
    if rule == WALL {
        return vec3f(-1.0, 2.0 * select(high, low, side == 1u), select(0.0, 1.0, is_near));
    }
    return vec3f(1.0, 0.0, 0.0);
}

// The mirror of a number below MIRRORS, 0 being none, as seen from a place.
fn mirror(number: u32, place: vec3f) -> Mirror {
    let x = along(0u, number % 3u, place.x);
    let y = along(1u, (number / 3u) % 3u, place.y);
    let z = along(2u, number / 9u, place.z);
    return Mirror(vec3f(x.x, y.x, z.x), vec3f(x.y, y.y, z.y), x.z * y.z * z.z > 0.0);
}

// Where what the mirror shows at `place` stands in truth.
fn behind(mirror: Mirror, place: vec3f) -> vec3f {
    return mirror.sign * (place - mirror.shift);
}

// Where the mirror shows what stands at `place`.
fn shown(mirror: Mirror, place: vec3f) -> vec3f {
    return mirror.sign * place + mirror.shift;
}

fn cell_index(place: vec3f) -> vec3u {
    return min(vec3u(max((place - parameters.corner) * parameters.per_cell, vec3f(0.0))), parameters.cells - 1u);
}

// The number of a row of cells along x.
fn row_of(y: u32, z: u32) -> u32 {
    return (z * parameters.cells.y + y) * parameters.cells.x;
}

fn cell_at(place: vec3f) -> u32 {
    let cell = cell_index(place);
    return row_of(cell.y, cell.z) + cell.x;
}

// Kernels of Mueller, Charypar & Gross 2003 without their factors, of q = r/h: poly6 by the square of q.
fn poly6(q_squared: f32) -> f32 {
    let inside = max(1.0 - q_squared, 0.0);
    return inside * inside * inside;
}

// The air outside open sides: how each of its columns moves, and more of it at the far end of columns that have moved in; one group. Twin
// of `OpenSide::mean_before` and of `add_outside` in `faces/open.rs`.
#import dew_neighbours
#import dew_columns
#import sums_before

// The mean velocity before a column of a side and those next to it, m/s.
fn mean_before(number: u32, column: u32) -> f32 {
    let first = first_column(number);
    let along = columns_along(number);
    let at = vec2u(column % along.x, column / along.x);
    let low = max(at, vec2u(1u)) - 1u;
    let high = min(at + 1u, along - 1u);
    var sum = 0.0;
    var count = 0u;
    for (var b = low.y; b <= high.y; b++) {
        for (var a = low.x; a <= high.x; a++) {
            let other = first + a + along.x * b;
            sum += f32(atomicLoad(&columns_before[other].velocity));
            count += atomicLoad(&columns_before[other].count);
        }
    }
    return velocity_of(sum) / f32(max(count, 1u));
}

// How far beyond the side the next particle of a column would stand, m.
fn next_depth(number: u32, column: u32) -> f32 {
    let apart = parameters.apart[number / 2u];
    let bits = atomicLoad(&columns_before[first_column(number) + column].outermost);
    return select(bitcast<f32>(bits - 1u), -0.5 * apart, bits == 0u) + apart;
}

// Particles that there is room for in a column; where the device halts, nothing comes in.
fn missing(number: u32, column: u32, is_going: bool) -> u32 {
    let axis = number / 2u;
    var count = 0u;
    if is_going && outside_columns[first_column(number) + column].is_free != 0u {
        for (var depth = next_depth(number, column); depth <= parameters.deepest[axis]; depth += parameters.apart[axis]) {
            count += 1u;
        }
    }
    return count;
}

// Adds the ambient air, at the index `at` in memory.
fn add_particle(number: u32, column: u32, depth: f32, at: u32, id: u32) {
    let axis = number / 2u;
    let a = (axis + 1u) % 3u;
    let b = (axis + 2u) % 3u;
    let along = columns_along(number);
    var particle = Particle();
    particle.position[axis] = select(parameters.high[axis] + depth, parameters.low[axis] - depth, number % 2u == 0u);
    particle.position[a] = parameters.low[a] + (f32(column % along.x) + 0.5) * parameters.apart[a];
    particle.position[b] = parameters.low[b] + (f32(column / along.x) + 0.5) * parameters.apart[b];
    particle.id = id;
    particle.role = OUTSIDE | (number << FACE_BITS);
    if at < arrayLength(&particles) {
        let cell = cell_at(particle.position);
        particles[at] = packed(particle);
        cell_slots[at] = vec2u(cell, atomicAdd(&counts[cell], 1u));
        keys[at] = id;
    }
}

// Adds the particles that columns beyond a side lack; gives how many particles there are then. Twin of `add_outside` in `faces/open.rs`.
fn add_outside(number: u32, filled: u32, id: u32, is_going: bool, thread: u32) -> u32 {
    let along = columns_along(number);
    let all = along.x * along.y;
    let first = first_column(number);
    var count = filled;
    for (var chunk = 0u; chunk < all; chunk += GROUP) {
        let column = chunk + thread;
        var more = 0u;
        if column < all {
            more = missing(number, column, is_going);
            outside_columns[first + column].velocity = mean_before(number, column);
        }
        let sums = sums_before(thread, more);
        for (var k = 0u; k < more; k++) {
            let depth = next_depth(number, column) + f32(k) * parameters.apart[number / 2u];
            add_particle(number, column, depth, count + sums.x + k, id + count + sums.x + k);
        }
        count += sums.y;
    }
    storageBarrier();
    workgroupBarrier();
    for (var column = thread; column < all; column += GROUP) {
        atomicStore(&columns_before[first + column].velocity, 0);
        atomicStore(&columns_before[first + column].count, 0u);
        atomicStore(&columns_before[first + column].outermost, 0u);
    }
    return count;
}

@compute @workgroup_size(GROUP)
fn main(@builtin(local_invocation_index) thread: u32) {
    let old = status.particles;
    // Numbers go on from the last, so that a particle's is this and its index in memory.
    let id = status.next_id - old;
    let is_going = status.halted == GOING;
    var count = old;
    for (var number = 0u; number < NO_FACE; number++) {
        if face(number) == OPEN {
            count = add_outside(number, count, id, is_going, thread);
        }
    }
    // All have read what it was.
    storageBarrier();
    workgroupBarrier();
    if thread == 0u && is_going {
        status.particles = min(count, arrayLength(&particles));
        status.next_id = id + count;
        groups[0] = (status.particles + GROUP - 1u) / GROUP;
    }
}

// Spawns the particles of inflows that are due by the end of the step, one after another, each at the lowest surface of some positions drawn at random. Twin of
// `ParticleSpawner` in `mod.rs` and of `Zone::any`; the random numbers are those of ChaCha with 8 rounds (Bernstein 2008), as on the CPU, one stream for each new
// particle. One group.
//
// Words of a zone in `zones`: disc or band; first corner and how many; radius or half width, m; middle; length of a band, m.
#import sph_common
#import sph_neighbours
#import sph_spline
#import sph_ground

// Most particles spawned in a step; the rest follows in the next.
const MAX_SPAWNED = 256u;

var<workgroup> tried: array<vec2f, SPAWN_CANDIDATES>;
var<workgroup> surfaces: array<f32, SPAWN_CANDIDATES>;

fn value(at: u32) -> f32 {
    return bitcast<f32>(zones[at]);
}

fn pair(at: u32) -> vec2f {
    return vec2f(value(at), value(at + 1u));
}

fn rolled(value: u32, by: u32) -> u32 {
    return (value << by) | (value >> (32u - by));
}

fn quarter_round(state: ptr<function, array<u32, 16>>, a: u32, b: u32, c: u32, d: u32) {
    (*state)[a] += (*state)[b];
    (*state)[d] = rolled((*state)[d] ^ (*state)[a], 16u);
    (*state)[c] += (*state)[d];
    (*state)[b] = rolled((*state)[b] ^ (*state)[c], 12u);
    (*state)[a] += (*state)[b];
    (*state)[d] = rolled((*state)[d] ^ (*state)[a], 8u);
    (*state)[c] += (*state)[d];
    (*state)[b] = rolled((*state)[b] ^ (*state)[c], 7u);
}

// Two numbers from 0 to 1, the `pair`th of a stream.
fn random_pair(stream: vec2u, pair: u32) -> vec2f {
    let low = parameters.key[0];
    let high = parameters.key[1];
    let begin = array(
        0x61707865u, 0x3320646eu, 0x79622d32u, 0x6b206574u,
        low.x, low.y, low.z, low.w, high.x, high.y, high.z, high.w,
        pair / 4u, 0u, stream.x, stream.y,
    );
    var state = begin;
    for (var k = 0u; k < 4u; k++) {
        quarter_round(&state, 0u, 4u, 8u, 12u);
        quarter_round(&state, 1u, 5u, 9u, 13u);
        quarter_round(&state, 2u, 6u, 10u, 14u);
        quarter_round(&state, 3u, 7u, 11u, 15u);
        quarter_round(&state, 0u, 5u, 10u, 15u);
        quarter_round(&state, 1u, 6u, 11u, 12u);
        quarter_round(&state, 2u, 7u, 8u, 13u);
        quarter_round(&state, 3u, 4u, 9u, 14u);
    }
    // The host draws 64 bits for each; the upper half has all bits of single precision.
    let first = 4u * (pair % 4u) + 1u;
    let bits = vec2u(state[first] + word(begin, first), state[first + 2u] + word(begin, first + 2u));
    return vec2f(bits >> vec2u(8u)) * exp2(-24.0);
}

fn word(words: array<u32, 16>, number: u32) -> u32 {
    var copy = words;
    return copy[number];
}

// A position beside a line between two points.
fn in_band(a: vec2f, b: vec2f, part: f32, beside: f32) -> vec2f {
    let direction = (b - a) / distance(a, b);
    return a + part * (b - a) + beside * vec2f(-direction.y, direction.x);
}

// The `number`th random position in a zone for a stream.
fn any_position(zone: u32, stream: vec2u, number: u32) -> vec2f {
    let draw = random_pair(stream, number);
    if zones[zone] == DISC {
        let r = value(zone + 3u) * sqrt(draw.x);
        return pair(zone + 4u) + r * vec2f(cos(2.0 * PI * draw.y), sin(2.0 * PI * draw.y));
    }
    let first = zones[zone + 1u];
    let pieces = zones[zone + 2u] - 1u;
    var along = draw.x * value(zone + 6u);
    for (var k = 0u; k < pieces; k++) {
        let a = pair(first + 2u * k);
        let b = pair(first + 2u * k + 2u);
        let length = distance(a, b);
        if along <= length || k + 1u == pieces {
            return in_band(a, b, along / length, (2.0 * draw.y - 1.0) * value(zone + 3u));
        }
        along -= length;
    }
    return pair(first);
}

fn within_bounds(position: vec2f) -> vec2f {
    return clamp(position, parameters.bounds.xz, parameters.bounds.yw);
}

fn deep(particle: Particle, position: vec2f) -> f32 {
    return particle.volume * spline(distance(position, particle.position), 1.0 / parameters.new_h);
}

// Height of the surface by the plain kernel sum: low where particles leave a gap. `spawned` is the range of new particles.
fn surface_height(position: vec2f, spawned: vec2u) -> f32 {
    var height = ground_at(position).x;
    let cells = cells_round(parameters.grid, position, 2.0 * parameters.new_h);
    // The particles stand in the order of the last sort, in cells that they have drifted away from but little.
    for (var row = cells.y; row <= cells.w; row++) {
        let line = row * parameters.grid.columns;
        for (var j = start[line + cells.x]; j < start[line + cells.z + 1u]; j++) {
            height += deep(unpacked(particles[j]), position);
        }
    }
    for (var j = spawned.x; j < spawned.y; j++) {
        height += deep(unpacked(particles[j]), position);
    }
    return height;
}

// The position, of those of the first threads of the group, with the lowest surface.
fn lowest(thread: u32, spawned: vec2u) -> vec2f {
    if thread < SPAWN_CANDIDATES {
        surfaces[thread] = surface_height(tried[thread], spawned);
    }
    workgroupBarrier();
    var best = 0u;
    for (var k = 1u; k < SPAWN_CANDIDATES; k++) {
        if surfaces[k] < surfaces[best] {
            best = k;
        }
    }
    let position = tried[best];
    workgroupBarrier();
    return position;
}

// Adds a new particle; the caller has checked that there is room for it.
fn spawn(number: u32, position: vec2f, velocity: vec2f) {
    var particle = Particle();
    particle.position = position;
    particle.velocity = velocity;
    particle.volume = parameters.new_volume;
    particle.h = parameters.new_h;
    particle.next_h = parameters.new_h;
    particle.id = status.next_id;
    particles[number] = packed(particle);
    status.next_id += 1u;
    status.inflow = add(status.inflow, particle.volume);
    book_momentum(particle.volume * sum(velocity));
}

// State shared by the group: number of particles, number before this pass, and the next request and whether it is due.
struct Turn {
    particles: u32,
    older: u32,
    request: u32,
    is_due: u32,
}

var<workgroup> turn: Turn;

@compute @workgroup_size(SPAWN_GROUP)
fn main(@builtin(local_invocation_index) thread: u32) {
    if thread == 0u {
        turn = Turn(status.particles, status.particles, status.spawned, 0u);
    }
    workgroupBarrier();
    for (var count = 0u; count < MAX_SPAWNED; count++) {
        if thread == 0u {
            let is_pending = status.halted == GOING && turn.request < status.spawn_requests;
            let has_room = turn.particles < arrayLength(&particles);
            turn.is_due = 0u;
            if is_pending && has_room && spawn_requests[turn.request].time <= total(status.clock) + status.step {
                turn.is_due = 1u;
            }
        }
        let now = workgroupUniformLoad(&turn);
        if now.is_due == 0u {
            break;
        }
        if thread < SPAWN_CANDIDATES {
            tried[thread] = within_bounds(any_position(spawn_requests[now.request].zone, vec2u(status.next_id, 0u), thread));
        }
        let position = lowest(thread, vec2u(now.older, now.particles));
        if thread == 0u {
            spawn(now.particles, position, spawn_requests[now.request].velocity);
            turn.particles += 1u;
            turn.request += 1u;
        }
        storageBarrier();
    }
    if thread == 0u && status.halted == GOING {
        status.particles = turn.particles;
        status.spawned = turn.request;
        groups[0] = (turn.particles + GROUP - 1u) / GROUP;
    }
}

// Places for new particles: drawn at random as on the CPU, of which the one is taken where the surface stands lowest. Twin of `Nursery`
// in `inflow.rs` and of `Zone::any`; the random numbers are those of ChaCha with 8 rounds (Bernstein 2008), one stream for each new
// particle. Declares what it works on: kernels that import it go on from binding 6.
#import flood_neighbours
#import flood_accounts
#import flood_ground

@group(0) @binding(1) var<storage, read_write> status: Status;
@group(0) @binding(2) var<storage, read_write> particles: array<Particle>;
@group(0) @binding(3) var<storage, read> start: array<u32>;
// Zones, tables, structures and what they owe: see `works.rs`.
@group(0) @binding(4) var<storage, read_write> works: array<u32>;
@group(0) @binding(5) var nodes: texture_2d<f32>;

const TRIES = 12u;
const TAU = 6.283185307179586;

// A zone takes so many numbers: kind; first corner and how many; radius or half width; middle; reach; area; first look and how many;
// length of a band; corner and size of the rectangle round a polygon.
const DISC = 0u;
const BAND = 1u;
const POLYGON = 2u;

var<workgroup> tried: array<vec2f, TRIES>;
var<workgroup> surfaces: array<f32, TRIES>;

fn work(at: u32) -> f32 {
    return bitcast<f32>(works[at]);
}

fn work_pair(at: u32) -> vec2f {
    return vec2f(work(at), work(at + 1u));
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
fn drawn(stream: vec2u, pair: u32) -> vec2f {
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
    // The host draws 64 bits for each; the upper half tells as much as single precision holds.
    let first = 4u * (pair % 4u) + 1u;
    let bits = vec2u(state[first] + word(begin, first), state[first + 2u] + word(begin, first + 2u));
    return vec2f(bits >> vec2u(8u)) * exp2(-24.0);
}

fn word(words: array<u32, 16>, number: u32) -> u32 {
    var copy = words;
    return copy[number];
}

// A place on both sides of a line between two points.
fn in_band(a: vec2f, b: vec2f, part: f32, beside: f32) -> vec2f {
    let direction = (b - a) / distance(a, b);
    return a + part * (b - a) + beside * vec2f(-direction.y, direction.x);
}

fn is_in_polygon(zone: u32, place: vec2f) -> bool {
    let first = works[zone + 1u];
    let count = works[zone + 2u];
    var inside = false;
    var before = work_pair(first + 2u * (count - 1u));
    for (var k = 0u; k < count; k++) {
        let corner = work_pair(first + 2u * k);
        if ((before.y > place.y) != (corner.y > place.y))
            && place.x < before.x + (place.y - before.y) / (corner.y - before.y) * (corner.x - before.x) {
            inside = !inside;
        }
        before = corner;
    }
    return inside;
}

// The `number`th place in a zone of those drawn for a stream.
fn any_place(zone: u32, stream: vec2u, number: u32) -> vec2f {
    switch works[zone] {
        case DISC: {
            let draw = drawn(stream, number);
            let r = work(zone + 3u) * sqrt(draw.x);
            return work_pair(zone + 4u) + r * vec2f(cos(TAU * draw.y), sin(TAU * draw.y));
        }
        case BAND: {
            let draw = drawn(stream, number);
            let first = works[zone + 1u];
            let pieces = works[zone + 2u] - 1u;
            var along = draw.x * work(zone + 10u);
            for (var k = 0u; k < pieces; k++) {
                let a = work_pair(first + 2u * k);
                let b = work_pair(first + 2u * k + 2u);
                let length = distance(a, b);
                if along <= length || k + 1u == pieces {
                    return in_band(a, b, along / length, (2.0 * draw.y - 1.0) * work(zone + 3u));
                }
                along -= length;
            }
            return work_pair(first);
        }
        default: {
            var found = 0u;
            for (var pair = 0u; pair < 4096u; pair++) {
                let place = work_pair(zone + 11u) + drawn(stream, pair) * work_pair(zone + 13u);
                if is_in_polygon(zone, place) {
                    if found == number {
                        return place;
                    }
                    found += 1u;
                }
            }
            return work_pair(zone + 4u);
        }
    }
}

fn within_bounds(place: vec2f) -> vec2f {
    return clamp(place, parameters.bounds.xz, parameters.bounds.yw);
}

fn deep(particle: Particle, place: vec2f) -> f32 {
    return particle.volume * spline(distance(place, particle.place), 1.0 / parameters.new_h);
}

// Height of the surface by the plain kernel sum: low where particles leave a gap. `born` are the numbers of those that are new.
fn surface_height(place: vec2f, born: vec2u) -> f32 {
    var height = ground_at(parameters, nodes, place).x;
    let cells = cells_round(parameters.grid, place, 2.0 * parameters.new_h);
    // The particles stand in the order of the last sort, in cells that they have drifted away from but little.
    for (var row = cells.y; row <= cells.w; row++) {
        let line = row * parameters.grid.columns;
        for (var j = start[line + cells.x]; j < start[line + cells.z + 1u]; j++) {
            height += deep(particles[j], place);
        }
    }
    for (var j = born.x; j < born.y; j++) {
        height += deep(particles[j], place);
    }
    return height;
}

// Of the places that the first threads of the group have tried the one where the surface stands lowest.
fn lowest(thread: u32, born: vec2u) -> vec2f {
    if thread < TRIES {
        surfaces[thread] = surface_height(tried[thread], born);
    }
    workgroupBarrier();
    var best = 0u;
    for (var k = 1u; k < TRIES; k++) {
        if surfaces[k] < surfaces[best] {
            best = k;
        }
    }
    let place = tried[best];
    workgroupBarrier();
    return place;
}

// A new particle; the caller has seen that there is room for it.
fn appear(number: u32, place: vec2f, velocity: vec2f, outside: u32) {
    var particle: Particle;
    particle.place = place;
    particle.velocity = velocity;
    particle.volume = parameters.new_volume;
    particle.weight = parameters.new_volume;
    particle.h = parameters.new_h;
    particle.next_h = parameters.new_h;
    particle.id = status.next_id;
    particle.outside = outside;
    particles[number] = particle;
    status.next_id += 1u;
    if outside == 0u {
        var all = status;
        var inflow = all.inflow;
        add(&inflow, particle.volume);
        all.inflow = inflow;
        book_momentum(&all, particle.volume * (velocity.x + velocity.y));
        status = all;
    }
}

// Linear between the rows of a table, as `Table::at`.
fn in_table(first: u32, rows: u32, at: f32) -> f32 {
    var after = 0u;
    while after < rows && work(first + 2u * after) <= at {
        after += 1u;
    }
    if after == 0u || after == rows {
        return work(first + 2u * (max(after, 1u) - 1u) + 1u);
    }
    let left = work_pair(first + 2u * after - 2u);
    let right = work_pair(first + 2u * after);
    return left.y + (at - left.x) / (right.x - left.x) * (right.y - left.y);
}

// Rain on each cell of the ground, what soaks in of its film, and what its particles are to gain and to give. Twin of `Ground::wet` in
// `rain.rs` and of `infiltration.rs`, whose formulas stand here without differences of large numbers.
#import flood_accounts
#import flood_wetness
#import infiltration_laws

@group(0) @binding(1) var<storage, read> status: Status;
// Zones, tables, structures and what they owe: see `works.rs`.
@group(0) @binding(2) var<storage, read> works: array<u32>;
@group(0) @binding(3) var<storage, read_write> ground: array<Patch>;
// Of each cell: area covered, and depth taken of particles since.
@group(0) @binding(4) var<storage, read_write> tallies: array<u32>;
// Kind and numbers of each law.
@group(0) @binding(5) var<storage, read> laws: array<vec4f>;
// What each group of cells adds up, and after them what each group of particles does.
@group(0) @binding(6) var<storage, read_write> sums: array<vec4f>;
// Rain by a function: the first time by the clock, s, times a second, and how many; then for each time the rate in each cell, m/s. See
// `rates.rs`.
@group(0) @binding(7) var<storage, read> rates: array<f32>;

const RATES = 3u;

// Share of a cell that particles must cover for all its rain to be theirs.
const SHARED_FROM = 0.5;

var<workgroup> of_threads: array<vec2f, 256>;

fn work_pair(at: u32) -> vec2f {
    return vec2f(bitcast<f32>(works[at]), bitcast<f32>(works[at + 1u]));
}

// Rain since it was last looked at, m, by the rows that the host has told.
fn rain_fallen() -> f32 {
    let window = parameters.rain;
    if window == 0u {
        return 0.0;
    }
    let begin = status.wetted;
    let end = status.clock.sum;
    var sum = 0.0;
    for (var k = 1u; k < works[window]; k++) {
        let left = work_pair(window + 2u * k - 1u);
        let right = work_pair(window + 2u * k + 1u);
        let low = max(begin, left.x);
        let high = min(end, right.x);
        if low < high {
            let slope = (right.y - left.y) / (right.x - left.x);
            sum += (left.y + slope * (0.5 * (low + high) - left.x)) * (high - low);
        }
    }
    return sum;
}

// The same of rain that a function gives: its rate in the middle of the time, linearly between those that the host has told.
fn rain_by_function(cell: u32) -> f32 {
    let times = u32(rates[2]);
    if times == 0u {
        return 0.0;
    }
    let at = max((0.5 * (status.wetted + status.clock.sum) - rates[0]) * rates[1], 0.0);
    let row = min(u32(at), times - 2u);
    let cells = parameters.patches.x * parameters.patches.y;
    let before = rates[RATES + row * cells + cell];
    let after = rates[RATES + (row + 1u) * cells + cell];
    return (before + min(at - f32(row), 1.0) * (after - before)) * (status.clock.sum - status.wetted);
}

// Rain less what is handed to particles, and what soaks in of the film, m3.
fn wet(cell: u32) -> vec2f {
    let area = parameters.patch_area;
    let step = status.clock.sum - status.wetted;
    var own = ground[cell];
    var soaked = own.soaked;
    add(&soaked, f32(tallies[2u * cell + 1u]) / DEPTH);
    let covered = f32(tallies[2u * cell]) / AREA;
    tallies[2u * cell] = 0u;
    tallies[2u * cell + 1u] = 0u;
    let rain = (rain_fallen() + rain_by_function(cell)) * own.factor * area;
    var booked = vec2f(rain, 0.0);
    own.film += rain;
    let asked = demand(laws[own.law], soaked.sum, step);
    let drunk = min(own.film, asked * area);
    own.film -= drunk;
    booked.y = drunk;
    add(&soaked, drunk / area);
    own.demand = max(asked - drunk / area, 0.0);
    own.gain = 0.0;
    if covered >= SHARED_FROM {
        own.demand /= covered;
        own.gain = own.film / (covered * area);
        booked.x -= own.film;
        own.film = 0.0;
    }
    own.is_deep = select(0u, 1u, own.film >= parameters.film * area);
    own.soaked = soaked;
    ground[cell] = own;
    return booked;
}

@compute @workgroup_size(256)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    of_threads[thread] = vec2f(0.0);
    if id.x < parameters.patches.x * parameters.patches.y {
        of_threads[thread] = wet(id.x);
    }
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if thread < half {
            of_threads[thread] += of_threads[thread + half];
        }
        workgroupBarrier();
    }
    if thread == 0u {
        sums[group.x] = vec4f(of_threads[0], 0.0, 0.0);
    }
}

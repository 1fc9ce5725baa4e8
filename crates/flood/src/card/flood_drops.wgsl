// Books rain and infiltration, and makes particles of the films that are deep enough, in the order of their cells. Twin of
// `Ground::drops` in `rain.rs` and of `flood/weather.rs`. One group.
#import flood_places
#import flood_wetness
#import sums_before

@group(0) @binding(6) var<storage, read_write> ground: array<Patch>;
@group(0) @binding(7) var<storage, read> sums: array<vec4f>;
// The numbers of groups: of the kernels to come; of those that rain has been shared out by; and how often this one is to work.
@group(0) @binding(8) var<storage, read_write> groups: array<u32>;

const SHARED = 4u;
const ONCE = 6u;

// A new particle stands at random within this share of its cell, along each side.
const SCATTER = 0.7;

var<workgroup> of_threads: array<vec4f, 256>;
// Particles now, the identity of the next, and 1 where it is time.
var<workgroup> now: vec3u;

// Rain less what was handed to particles, what soaked in, what particles were given, m3, and the momentum lost.
fn summed(thread: u32) -> vec4f {
    let of_cells = (parameters.patches.x * parameters.patches.y + 255u) / 256u;
    let of_particles = groups[3u * SHARED];
    var sum = vec4f(0.0);
    var momentum = 0.0;
    for (var k = thread; k < of_cells; k += 256u) {
        sum += vec4f(sums[k].xy, 0.0, 0.0);
    }
    for (var k = thread; k < of_particles; k += 256u) {
        sum += vec4f(0.0, 0.0, sums[of_cells + k].xy);
        momentum += sums[of_cells + k].z;
    }
    of_threads[thread] = vec4f(sum.x, sum.y + sum.w, sum.z, momentum);
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if thread < half {
            of_threads[thread] += of_threads[thread + half];
        }
        workgroupBarrier();
    }
    let all = of_threads[0];
    workgroupBarrier();
    return all;
}

fn book(rained: f32, given: f32, infiltrated: f32, momentum: f32) {
    var all = status;
    var rain = all.rained;
    var lost = all.infiltrated;
    add(&rain, rained);
    add(&rain, given);
    add(&lost, infiltrated);
    all.rained = rain;
    all.infiltrated = lost;
    book_momentum(&all, -momentum);
    all.wetted = all.clock.sum;
    status = all;
}

fn fall(cell: u32, number: u32, id: u32) {
    let size = 1.0 / parameters.patches_per_metre;
    let at = vec2f(vec2u(cell % parameters.patches.x, cell / parameters.patches.x));
    let part = 0.5 + SCATTER * (drawn(vec2u(id, 0u), 0u) - 0.5);
    let volume = ground[cell].film;
    var particle: Particle;
    particle.place = parameters.bounds.xz + (at + part) * size;
    particle.volume = volume;
    particle.weight = volume;
    particle.h = parameters.drop_h;
    particle.next_h = parameters.drop_h;
    particle.id = id;
    particles[number] = particle;
    ground[cell].film = 0.0;
}

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_index) thread: u32) {
    if thread == 0u {
        now = vec3u(status.particles, status.next_id, groups[3u * ONCE]);
    }
    let begin = workgroupUniformLoad(&now);
    if begin.z == 0u {
        return;
    }
    let before = begin.x;
    let first_id = begin.y;
    let all = summed(thread);
    if thread == 0u {
        book(all.x, all.z, all.y, all.w);
    }
    let cells = parameters.patches.x * parameters.patches.y;
    let room = arrayLength(&particles) - before;
    var come = 0u;
    for (var first = 0u; first < cells; first += 256u) {
        let cell = first + thread;
        let falls = cell < cells && ground[min(cell, cells - 1u)].is_deep == 1u;
        let ranks = sums_before(thread, select(0u, 1u, falls));
        // Where there is no room the film stays.
        if falls && come + ranks.x < room {
            fall(cell, before + come + ranks.x, first_id + come + ranks.x);
        }
        come = min(come + ranks.y, room);
    }
    if thread == 0u {
        status.particles = before + come;
        status.next_id = first_id + come;
        groups[0] = (before + come + 255u) / 256u;
    }
}

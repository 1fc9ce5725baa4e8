// Outflows by rating, held levels and links in a step. Twin of `flood/regulate.rs` and `structures.rs`. One group.
#import flood_laws
#import flood_accounts

const THREADS = 64u;

// A held level is kept to within this share of a particle's volume.
const HELD_TO = 0.75;

// At most so many particles are taken, and born for a held level, in a step: the rest in the next.
const MOST_TAKEN = 128u;
const MOST_BORN = 64u;

// Where `works` says how many outflows, held levels and links there are, and where they and their flows begin.
const COUNTS = 0u;
const FIRSTS = 3u;
const FLOWS = 6u;

// Numbers that each takes.
const OUTFLOW = 3u;
const HELD = 2u;
const LINK = 16u;
const FLOW = 4u;

const NONE = 0xffffffffu;

struct Now {
    particles: u32,
    older: u32,
    taken: u32,
    highest: u32,
    // Level or what lacks, and over how many places; water that is to be taken, m3.
    found: vec2f,
    owed: f32,
    is_done: u32,
}

struct Taken {
    number: u32,
    // 1 where it is led elsewhere, 0 where it goes out.
    is_led: u32,
    place: vec2f,
}

var<workgroup> counts: vec4u;
var<workgroup> now: Now;
var<workgroup> taken: array<Taken, MOST_TAKEN>;
var<workgroup> of_threads: array<vec2f, THREADS>;
var<workgroup> best_surface: array<f32, THREADS>;
var<workgroup> best: array<u32, THREADS>;

// The place of a look, and whether an obstacle stands there.
fn look_at(zone: u32, number: u32) -> vec3f {
    let at = works[zone + 8u] + 3u * number;
    return vec3f(work_pair(at), work(at + 2u));
}

fn depth_and_ground(look: vec3f) -> vec2f {
    let water = water_at(look.xy);
    return vec2f(select(water.x, 0.0, look.z > 0.0), ground_at(parameters, nodes, look.xy).x);
}

// Adds up what the threads have found, in their order.
fn gather(thread: u32) -> vec2f {
    workgroupBarrier();
    if thread == 0u {
        var sum = vec2f(0.0);
        for (var k = 0u; k < THREADS; k++) {
            sum += of_threads[k];
        }
        now.found = sum;
    }
    return workgroupUniformLoad(&now).found;
}

// The mean level of the water in a zone over where there is some, or DRY.
fn level_in(zone: u32, thread: u32) -> f32 {
    var sum = vec2f(0.0);
    for (var k = thread; k < works[zone + 9u]; k += THREADS) {
        let seen = depth_and_ground(look_at(zone, k));
        sum += select(vec2f(0.0), vec2f(seen.x + seen.y, 1.0), seen.x > 0.0);
    }
    of_threads[thread] = sum;
    let all = gather(thread);
    return select(DRY, all.x / all.y, all.y > 0.0);
}

// Water that a zone lacks for a level, m3.
fn missing_in(zone: u32, level: f32, thread: u32) -> f32 {
    var sum = vec2f(0.0);
    for (var k = thread; k < works[zone + 9u]; k += THREADS) {
        let seen = depth_and_ground(look_at(zone, k));
        sum += vec2f(max(level - seen.y, 0.0) - seen.x, 1.0);
    }
    of_threads[thread] = sum;
    let all = gather(thread);
    return all.x / max(all.y, 1.0) * work(zone + 7u);
}

fn from_piece(a: vec2f, b: vec2f, place: vec2f) -> f32 {
    let along = b - a;
    let part = clamp(dot(place - a, along) / dot(along, along), 0.0, 1.0);
    return distance(place, a + part * along);
}

// Twin of `Zone::contains`.
fn contains(zone: u32, place: vec2f) -> bool {
    switch works[zone] {
        case DISC: { return distance(place, work_pair(zone + 4u)) <= work(zone + 3u); }
        case BAND: {
            let first = works[zone + 1u];
            for (var k = 0u; k + 1u < works[zone + 2u]; k++) {
                if from_piece(work_pair(first + 2u * k), work_pair(first + 2u * k + 2u), place) <= work(zone + 3u) {
                    return true;
                }
            }
            return false;
        }
        default: { return is_in_polygon(zone, place); }
    }
}

fn is_taken(number: u32) -> bool {
    for (var k = 0u; k < now.taken; k++) {
        if taken[k].number == number {
            return true;
        }
    }
    return false;
}

fn is_higher(number: u32, surface: f32, than: u32, its: f32) -> bool {
    return than == NONE || surface > its || (surface == its && particles[number].id < particles[than].id);
}

// The particle in a zone whose surface stands highest.
fn find_highest(zone: u32, thread: u32) {
    best[thread] = NONE;
    best_surface[thread] = 0.0;
    let cells = cells_round(parameters.grid, work_pair(zone + 4u), work(zone + 6u));
    for (var row = cells.y; row <= cells.w; row++) {
        let line = row * parameters.grid.columns;
        for (var j = start[line + cells.x] + thread; j < start[line + cells.z + 1u]; j += THREADS) {
            let surface = particles[j].ground + particles[j].depth;
            let is_water = particles[j].outside == 0u && particles[j].volume > 0.0;
            if is_water && is_higher(j, surface, best[thread], best_surface[thread]) && contains(zone, particles[j].place) && !is_taken(j) {
                best[thread] = j;
                best_surface[thread] = surface;
            }
        }
    }
    workgroupBarrier();
    if thread == 0u {
        for (var k = 1u; k < THREADS; k++) {
            if best[k] != NONE && is_higher(best[k], best_surface[k], best[0], best_surface[0]) {
                best[0] = best[k];
                best_surface[0] = best_surface[k];
            }
        }
        now.highest = best[0];
    }
}

// Takes particles out of a zone for what is in `now.owed`, the highest first, and leads them to the zone `to` where they are led. Where
// there are none, it goes on owing `most` m3 at most.
fn take(zone: u32, most: f32, is_led: bool, to: u32, thread: u32) {
    for (var count = 0u; count < MOST_TAKEN; count++) {
        find_highest(zone, thread);
        if thread == 0u {
            now.is_done = 1u;
            if now.highest == NONE {
                now.owed = min(now.owed, most);
            } else if now.owed >= particles[now.highest].volume && now.taken < MOST_TAKEN {
                now.owed -= particles[now.highest].volume;
                now.is_done = 0u;
            }
        }
        let turn = workgroupUniformLoad(&now);
        if turn.is_done == 1u {
            break;
        }
        var place = vec2f(0.0);
        if is_led {
            if thread < TRIES {
                let stream = vec2u(particles[turn.highest].id, status.steps_before + status.steps);
                tried[thread] = within_bounds(any_place(to, stream, thread));
            }
            place = lowest(thread, vec2u(turn.older, turn.particles));
        }
        if thread == 0u {
            taken[turn.taken] = Taken(turn.highest, select(0u, 1u, is_led), place);
            now.taken += 1u;
        }
        workgroupBarrier();
    }
}

// Lets a flow go on by what is discharged in the step; `now.owed` is what is to be taken.
fn flow_on(flow: u32, discharge: f32) {
    var owed = Account(work(flow), work(flow + 1u));
    add(&owed, discharge * status.step);
    works[flow] = bitcast<u32>(owed.sum);
    works[flow + 1u] = bitcast<u32>(owed.lacking);
    works[flow + 2u] = bitcast<u32>(discharge);
    now.owed = abs(owed.sum);
    now.found = vec2f(owed.sum, abs(owed.sum));
}

// Takes off a flow what has been taken.
fn settle(flow: u32) {
    var owed = Account(work(flow), work(flow + 1u));
    add(&owed, -sign(owed.sum) * (now.found.y - now.owed));
    works[flow] = bitcast<u32>(owed.sum);
    works[flow + 1u] = bitcast<u32>(owed.lacking);
}

fn let_out(number: u32, thread: u32) {
    let outflow = works[FIRSTS] + OUTFLOW * number;
    let flow = works[FLOWS] + FLOW * number;
    let zone = works[outflow];
    let level = level_in(zone, thread);
    if thread == 0u {
        flow_on(flow, select(in_table(works[outflow + 1u], works[outflow + 2u], level), 0.0, level == DRY));
    }
    take(zone, parameters.new_volume, false, NONE, thread);
    if thread == 0u {
        settle(flow);
    }
    workgroupBarrier();
}

fn hold(number: u32, thread: u32) {
    let held = works[FIRSTS + 1u] + HELD * number;
    let zone = works[held];
    let level = in_table(works[held + 1u] + 1u, works[works[held + 1u]], status.clock.sum);
    let lacks = missing_in(zone, level, thread);
    if thread == 0u {
        now.found.x = lacks;
    }
    let missing = workgroupUniformLoad(&now).found.x;
    let births = u32(max(floor(missing / parameters.new_volume + 1.0 - HELD_TO), 0.0));
    for (var k = 0u; k < min(births, MOST_BORN); k++) {
        let turn = workgroupUniformLoad(&now);
        if turn.particles >= arrayLength(&particles) {
            break;
        }
        if thread < TRIES {
            tried[thread] = within_bounds(any_place(zone, vec2u(status.next_id, 0u), thread));
        }
        let place = lowest(thread, vec2u(turn.older, turn.particles));
        if thread == 0u {
            appear(turn.particles, place, water_at(place).yz, 0u);
            now.particles += 1u;
        }
        storageBarrier();
    }
    if thread == 0u {
        let excess = -missing - HELD_TO * parameters.new_volume;
        now.owed = select(0.0, excess + parameters.new_volume, excess > 0.0);
    }
    workgroupBarrier();
    take(zone, 0.0, false, NONE, thread);
}

fn lead(number: u32, thread: u32) {
    let link = works[FIRSTS + 2u] + LINK * number;
    let flow = works[FLOWS] + FLOW * (works[COUNTS] + number);
    let zones = vec2u(works[link], works[link + 1u]);
    let first = level_in(zones.x, thread);
    let second = level_in(zones.y, thread);
    if thread == 0u {
        flow_on(flow, of_link(link, first, second));
    }
    let forward = workgroupUniformLoad(&now).found.x >= 0.0;
    take(select(zones.y, zones.x, forward), parameters.new_volume, true, select(zones.x, zones.y, forward), thread);
    if thread == 0u {
        settle(flow);
    }
    workgroupBarrier();
}

// What is led elsewhere comes out at rest.
fn carry_out() {
    var all = status;
    var outflow = all.outflow;
    for (var k = 0u; k < now.taken; k++) {
        let order = taken[k];
        var particle = particles[order.number];
        book_momentum(&all, -particle.volume * (particle.velocity.x + particle.velocity.y));
        if order.is_led == 1u {
            particle.place = order.place;
            particle.velocity = vec2f(0.0);
            particle.acceleration = vec2f(0.0);
        } else {
            add(&outflow, particle.volume);
            particle.volume = 0.0;
        }
        particles[order.number] = particle;
    }
    all.outflow = outflow;
    all.particles = now.particles;
    status = all;
}

@compute @workgroup_size(THREADS)
fn main(@builtin(local_invocation_index) thread: u32) {
    if thread == 0u {
        let is_going = status.halted == GOING;
        counts = select(vec4u(0u), vec4u(works[COUNTS], works[COUNTS + 1u], works[COUNTS + 2u], 1u), is_going);
        now = Now(status.particles, status.particles, 0u, NONE, vec2f(0.0), 0.0, 0u);
    }
    let all = workgroupUniformLoad(&counts);
    for (var k = 0u; k < all.x; k++) {
        let_out(k, thread);
    }
    for (var k = 0u; k < all.y; k++) {
        hold(k, thread);
    }
    for (var k = 0u; k < all.z; k++) {
        lead(k, thread);
    }
    workgroupBarrier();
    if thread == 0u && all.w == 1u {
        carry_out();
    }
}

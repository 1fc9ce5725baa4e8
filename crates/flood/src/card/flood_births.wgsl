// Lets in the particles that are due by the end of the step, each where the surface stands lowest of the places that the host has drawn
// for it. Twin of `Nursery::bear` in `inflow.rs`. One group: one thread for each place.
#import flood_neighbours
#import flood_ground

const TRIES = 12u;

struct Birth {
    // Since the host last spoke, s.
    time: f32,
    id: u32,
    velocity: vec2f,
    places: array<vec2f, 12>,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read_write> status: Status;
@group(0) @binding(2) var<storage, read_write> particles: array<Particle>;
@group(0) @binding(3) var<storage, read> start: array<u32>;
@group(0) @binding(4) var<storage, read_write> counts: array<atomic<u32>>;
@group(0) @binding(5) var<storage, read_write> places: array<vec2u>;
@group(0) @binding(6) var<storage, read_write> keys: array<u32>;
@group(0) @binding(7) var<storage, read> births: array<Birth>;
@group(0) @binding(8) var<storage, read_write> groups: array<u32>;
@group(0) @binding(9) var nodes: texture_2d<f32>;

// At most so many in a step: the rest comes in the next.
const MOST = 256u;

// What the group knows together: particles now, those of them that are older than the step, and the birth that is due, if any.
struct Turn {
    particles: u32,
    older: u32,
    birth: u32,
    is_due: u32,
}

var<workgroup> turn: Turn;
var<workgroup> surfaces: array<f32, 12>;

fn deep(particle: Particle, place: vec2f) -> f32 {
    return particle.volume * spline(distance(place, particle.place), 1.0 / parameters.new_h);
}

// Height of the surface by the plain kernel sum: low where particles leave a gap.
fn surface(place: vec2f, now: Turn) -> f32 {
    var height = ground_at(parameters, nodes, place).x;
    let cells = cells_round(parameters.grid, place, 2.0 * parameters.new_h);
    // The particles stand in the order of the last sort, in cells that they have drifted away from but little.
    for (var row = cells.y; row <= cells.w; row++) {
        let line = row * parameters.grid.columns;
        for (var j = start[line + cells.x]; j < start[line + cells.z + 1u]; j++) {
            height += deep(particles[j], place);
        }
    }
    for (var j = now.older; j < now.particles; j++) {
        height += deep(particles[j], place);
    }
    return height;
}

fn bear(birth: Birth, now: Turn) {
    var lowest = 0u;
    for (var k = 1u; k < TRIES; k++) {
        if surfaces[k] < surfaces[lowest] {
            lowest = k;
        }
    }
    let place = birth.places[lowest];
    var particle: Particle;
    particle.place = place;
    particle.velocity = birth.velocity;
    particle.volume = parameters.new_volume;
    particle.weight = parameters.new_volume;
    particle.h = parameters.new_h;
    particle.next_h = parameters.new_h;
    particle.id = birth.id;
    particles[now.particles] = particle;
    let cell = cell_at(parameters.grid, place);
    places[now.particles] = vec2u(cell, atomicAdd(&counts[cell], 1u));
    keys[now.particles] = birth.id;
    var inflow = status.inflow;
    add(&inflow, particle.volume);
    status.inflow = inflow;
    let momentum = particle.volume * (particle.velocity.x + particle.velocity.y);
    var gained = status.momentum_gained;
    var lost = status.momentum_lost;
    add(&gained, max(momentum, 0.0));
    add(&lost, max(-momentum, 0.0));
    status.momentum_gained = gained;
    status.momentum_lost = lost;
}

@compute @workgroup_size(12)
fn main(@builtin(local_invocation_index) thread: u32) {
    if thread == 0u {
        turn = Turn(status.particles, status.particles, status.born, 0u);
    }
    for (var count = 0u; count < MOST; count++) {
        if thread == 0u {
            let is_going = status.halted == GOING && turn.birth < status.births;
            let room = turn.particles < arrayLength(&particles);
            turn.is_due = 0u;
            if is_going && room && births[turn.birth].time <= status.elapsed.sum + status.step {
                turn.is_due = 1u;
            }
        }
        let now = workgroupUniformLoad(&turn);
        if now.is_due == 0u {
            break;
        }
        surfaces[thread] = surface(births[now.birth].places[thread], now);
        workgroupBarrier();
        if thread == 0u {
            bear(births[now.birth], now);
            turn.particles += 1u;
            turn.birth += 1u;
        }
        storageBarrier();
    }
    if thread == 0u && status.halted == GOING {
        status.particles = turn.particles;
        status.born = turn.birth;
        groups[0] = (turn.particles + 255u) / 256u;
    }
}

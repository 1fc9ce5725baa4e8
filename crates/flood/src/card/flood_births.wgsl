// Lets in the particles that are due by the end of the step, and tops up the water at the sides that are held at a level. Twin of
// `Nursery::pour` and `Nursery::hold_levels` in `inflow.rs`. One group.
#import flood_places

struct Birth {
    velocity: vec2f,
    // By the clock, s.
    time: f32,
    zone: u32,
}

@group(0) @binding(6) var<storage, read> births: array<Birth>;
@group(0) @binding(7) var<storage, read_write> groups: array<u32>;

const THREADS = 64u;

// At most so many in a step, and for a piece of a side: the rest comes in the next.
const MOST = 256u;

// Where `works` says where the strips of the four sides are: pieces, 0 where the side is not held.
const STRIPS = 8u;

// Places along a piece of a side at which its depth is looked at.
const PARTS = 5u;

// What the group knows together: particles now, those of them that are older than this kernel, and the birth that is due, if any.
struct Turn {
    particles: u32,
    older: u32,
    birth: u32,
    is_due: u32,
}

var<workgroup> turn: Turn;
var<workgroup> pieces: u32;
// What the pieces of a side lack, in particles.
var<workgroup> missing: array<u32, THREADS>;

fn pour(thread: u32) {
    for (var count = 0u; count < MOST; count++) {
        if thread == 0u {
            let is_going = status.halted == GOING && turn.birth < status.births;
            let room = turn.particles < arrayLength(&particles);
            turn.is_due = 0u;
            if is_going && room && births[turn.birth].time <= status.clock.sum + status.step {
                turn.is_due = 1u;
            }
        }
        let now = workgroupUniformLoad(&turn);
        if now.is_due == 0u {
            break;
        }
        if thread < TRIES {
            tried[thread] = within_bounds(any_place(births[now.birth].zone, vec2u(status.next_id, 0u), thread));
        }
        let place = lowest(thread, vec2u(now.older, now.particles));
        if thread == 0u {
            appear(now.particles, place, births[now.birth].velocity, 0u);
            turn.particles += 1u;
            turn.birth += 1u;
        }
        storageBarrier();
    }
}

// The place `outwards` m beyond a side and `along` m along it from its south-west end.
fn beyond(side: u32, outwards: f32, along: f32) -> vec2f {
    let bounds = parameters.bounds;
    switch side {
        case 0u: { return vec2f(bounds.x - outwards, bounds.z + along); }
        case 1u: { return vec2f(bounds.y + outwards, bounds.z + along); }
        case 2u: { return vec2f(bounds.x + along, bounds.z - outwards); }
        default: { return vec2f(bounds.x + along, bounds.w + outwards); }
    }
}

// Particles that a piece of a side lacks beyond it.
fn lacking(side: u32, piece: u32, length: f32, width: f32, older: u32, now: u32) -> u32 {
    var depth = 0.0;
    for (var part = 0u; part < PARTS; part++) {
        let along = (f32(piece) + (f32(part) + 0.5) / f32(PARTS)) * length;
        depth += max(status.stages[side] - ground_at(parameters, nodes, beyond(side, 0.0, along)).x, 0.0);
    }
    let wanted = depth / f32(PARTS) * length * width;
    let centre = beyond(side, 0.5 * width, (f32(piece) + 0.5) * length);
    let half_size = 0.5 * select(vec2f(length, width), vec2f(width, length), side < 2u);
    var here = 0.0;
    let cells = cells_round(parameters.grid, centre, max(half_size.x, half_size.y) + parameters.spacing);
    for (var row = cells.y; row <= cells.w; row++) {
        let line = row * parameters.grid.columns;
        for (var j = start[line + cells.x]; j < start[line + cells.z + 1u]; j++) {
            here += select(0.0, particles[j].volume, all(abs(particles[j].place - centre) <= half_size));
        }
    }
    for (var j = older; j < now; j++) {
        here += select(0.0, particles[j].volume, all(abs(particles[j].place - centre) <= half_size));
    }
    return u32(max(floor((wanted - here) / parameters.new_volume + 0.25), 0.0));
}

fn hold(side: u32, thread: u32) {
    if thread == 0u {
        pieces = select(0u, works[STRIPS + side], status.halted == GOING);
    }
    let count = workgroupUniformLoad(&pieces);
    let width = 3.0 * parameters.new_h;
    let size = parameters.bounds.yw - parameters.bounds.xz;
    let length = select(size.x, size.y, side < 2u) / f32(max(count, 1u));
    for (var first = 0u; first < count; first += THREADS) {
        missing[thread] = 0u;
        if first + thread < count {
            missing[thread] = lacking(side, first + thread, length, width, turn.older, turn.particles);
        }
        workgroupBarrier();
        for (var k = 0u; k < THREADS; k++) {
            let lacks = workgroupUniformLoad(&missing[k]);
            for (var number = 0u; number < min(lacks, MOST); number++) {
                let now = workgroupUniformLoad(&turn);
                if now.particles >= arrayLength(&particles) {
                    break;
                }
                if thread < TRIES {
                    let draw = drawn(vec2u(status.next_id, 0u), thread);
                    let one = beyond(side, 0.5 * width, f32(first + k) * length);
                    let other = beyond(side, 0.5 * width, f32(first + k + 1u) * length);
                    tried[thread] = in_band(one, other, draw.x, (draw.y - 0.5) * width);
                }
                let place = lowest(thread, vec2u(now.older, now.particles));
                if thread == 0u {
                    appear(now.particles, place, vec2f(0.0), side + 1u);
                    turn.particles += 1u;
                }
                storageBarrier();
            }
        }
        workgroupBarrier();
    }
}

@compute @workgroup_size(THREADS)
fn main(@builtin(local_invocation_index) thread: u32) {
    if thread == 0u {
        turn = Turn(status.particles, status.particles, status.born, 0u);
    }
    workgroupBarrier();
    pour(thread);
    for (var side = 0u; side < 4u; side++) {
        hold(side, thread);
    }
    if thread == 0u && status.halted == GOING {
        status.particles = turn.particles;
        status.born = turn.birth;
        groups[0] = (turn.particles + 255u) / 256u;
    }
}

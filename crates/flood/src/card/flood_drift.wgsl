// First half of the step's acceleration; then the particles move, what leaves is booked, and each counts itself in its cell.
// Twin of `flood/step.rs` (push) and `flood/exchange.rs` (lose).
#import flood_card
#import flood_friction
#import flood_outlines

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> status: Status;
@group(0) @binding(2) var<storage, read_write> particles: array<Particle>;
@group(0) @binding(3) var<storage, read_write> counts: array<atomic<u32>>;
@group(0) @binding(4) var<storage, read_write> places: array<vec2u>;
@group(0) @binding(5) var<storage, read_write> keys: array<u32>;
@group(0) @binding(6) var<storage, read_write> partials: array<Partial>;

// How far beyond an edge particles go on, in smoothing lengths, and at least how fast: its Froude number.
const BEYOND = 4.0;
const SLOWEST_LEAVING = 0.1;

// Outlines of obstacles: see `flood_outlines`.
@group(0) @binding(7) var<storage, read> outlines: array<u32>;
// Impulses of particles that are put back, east and north for each obstacle, in KNOCK; and last how many there were.
@group(0) @binding(8) var<storage, read_write> knocks: array<atomic<i32>>;

// A ten-thousandth of a particle's volume times m/s: whole numbers add up to the same in any order.
const KNOCK = 1e-4;

// A particle that has come into an obstacle is put this far before its wall, over the particles' distance.
const BEFORE_WALL = 1e-3;

var<workgroup> sums: array<vec3f, 256>;

// Puts a coordinate that has left over a periodic side or a wall back: its new value, the sign of its velocity, and whether it has
// left for good, over the low side (1) or the high one (2).
fn keep(value: f32, low: f32, high: f32, low_rule: u32, high_rule: u32) -> vec3f {
    let is_low = value < low;
    if !is_low && value < high {
        return vec3f(value, 1.0, 0.0);
    }
    let rule = select(high_rule, low_rule, is_low);
    if rule == PERIODIC {
        let size = high - low;
        return vec3f(clamp(value - size * floor((value - low) / size), low, high), 1.0, 0.0);
    }
    if rule == WALL {
        return vec3f(clamp(2.0 * select(high, low, is_low) - value, low, high), -1.0, 0.0);
    }
    return vec3f(value, 1.0, select(2.0, 1.0, is_low));
}

fn sum(pair: vec2f) -> f32 {
    return pair.x + pair.y;
}

fn side(number: u32) -> vec4f {
    let at = 4u * number;
    return vec4f(
        bitcast<f32>(outlines[at]),
        bitcast<f32>(outlines[at + 1u]),
        bitcast<f32>(outlines[at + 2u]),
        bitcast<f32>(outlines[at + 3u]),
    );
}

// The way from the nearest wall of an outline that a place is inside, from its first side to its last; nothing where it is not inside.
fn way_in(place: vec2f, first: u32, end: u32) -> vec3f {
    var inside = false;
    var way = vec2f(0.0);
    var nearest = 3e38;
    for (var number = first; number < end; number++) {
        let walls = side(number);
        let from_wall = way_from(place, walls);
        if dot(from_wall, from_wall) < nearest {
            nearest = dot(from_wall, from_wall);
            way = from_wall;
        }
        inside = inside != crosses(place, walls);
    }
    return vec3f(way, select(0.0, 1.0, inside));
}

// Puts a particle that has come into an obstacle back to the wall; what of its velocity led in is taken off. Gives that. Twin of
// `Obstacles::keep_out`.
fn kept_out(place: ptr<function, vec2f>, velocity: ptr<function, vec2f>, volume: f32) -> vec2f {
    let grid = parameters.outlines;
    let at = (*place - grid.corner) * grid.per_cell;
    if grid.columns == 0u || any(at < vec2f(0.0)) || any(at >= vec2f(vec2u(grid.columns, grid.rows))) {
        return vec2f(0.0);
    }
    let cell = u32(at.y) * grid.columns + u32(at.x);
    for (var k = outlines[cell]; k < outlines[cell + 1u]; k += 3u) {
        let obstacle = outlines[k];
        let way = way_in(*place, outlines[k + 1u], outlines[k + 2u]);
        let deep = length(way.xy);
        if way.z == 0.0 {
            continue;
        }
        let normal = select(-way.xy / deep, vec2f(0.0), deep == 0.0);
        *place += (BEFORE_WALL * parameters.spacing + deep) * normal;
        let inward = max(-dot(*velocity, normal), 0.0);
        *velocity += inward * normal;
        let taken = -volume * inward * normal;
        let knock = vec2i(round(taken / (KNOCK * parameters.new_volume)));
        atomicAdd(&knocks[2u * obstacle], knock.x);
        atomicAdd(&knocks[2u * obstacle + 1u], knock.y);
        atomicAdd(&knocks[2u * parameters.obstacles], 1);
        return taken;
    }
    return vec2f(0.0);
}

// Moves a particle; outflow, inflow and momentum booked.
fn moved(particle: ptr<function, Particle>) -> vec3f {
    var booked = vec3f(0.0);
    var velocity = (*particle).velocity + 0.5 * status.step * (*particle).acceleration;
    let volume = (*particle).volume;
    let was_inside = (*particle).outside == 0u;
    if was_inside {
        let factor = slowed(parameters, velocity, (*particle).depth, 0.5 * status.step);
        booked.z = volume * sum(velocity) * (factor - 1.0);
        velocity *= factor;
    }
    var place = (*particle).place + status.step * velocity;
    if was_inside {
        booked.z -= sum(kept_out(&place, &velocity, volume));
    }
    let x = keep(place.x, parameters.bounds.x, parameters.bounds.y, parameters.rules.x, parameters.rules.y);
    let y = keep(place.y, parameters.bounds.z, parameters.bounds.w, parameters.rules.z, parameters.rules.w);
    let before = sum(velocity);
    velocity *= vec2f(x.y, y.y);
    let side = select(u32(x.z), 2u + u32(y.z), y.z > 0.0);
    if was_inside && side == 0u {
        booked.z += volume * (sum(velocity) - before);
    } else if was_inside {
        booked.x = volume;
        booked.z -= volume * before;
        let outward = array(vec2f(-1.0, 0.0), vec2f(1.0, 0.0), vec2f(0.0, -1.0), vec2f(0.0, 1.0))[side - 1u];
        let slowest = SLOWEST_LEAVING * sqrt(parameters.gravity * (*particle).depth);
        velocity += max(slowest - dot(velocity, outward), 0.0) * outward;
    } else if side == 0u {
        booked.y = volume;
        booked.z += volume * sum(velocity);
    }
    (*particle).place = vec2f(x.x, y.x);
    (*particle).velocity = velocity;
    (*particle).outside = side;
    return booked;
}

// Whether a particle is so far beyond an edge that it is seen no more, or holds no water.
fn is_gone(particle: Particle) -> bool {
    let bounds = parameters.bounds;
    let place = particle.place;
    let beyond = max(max(bounds.x - place.x, place.x - bounds.y), max(bounds.z - place.y, place.y - bounds.w));
    return particle.volume <= 0.0 || (particle.outside > 0u && beyond >= BEYOND * particle.h);
}

@compute @workgroup_size(256)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    sums[thread] = vec3f(0.0);
    let i = id.x;
    if i < status.particles {
        var particle = particles[i];
        sums[thread] = moved(&particle);
        particle.h = particle.next_h;
        particles[i] = particle;
        var cell = status.cells - 1u;
        if !is_gone(particle) {
            let at = (particle.place - parameters.grid.corner) * parameters.grid.per_cell;
            let column = min(u32(max(at.x, 0.0)), parameters.grid.columns - 1u);
            let row = min(u32(max(at.y, 0.0)), parameters.grid.rows - 1u);
            cell = row * parameters.grid.columns + column;
        }
        places[i] = vec2u(cell, atomicAdd(&counts[cell], 1u));
        keys[i] = particle.id;
    }
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if thread < half {
            sums[thread] += sums[thread + half];
        }
        workgroupBarrier();
    }
    if thread == 0u {
        partials[group.x].outflow = sums[0].x;
        partials[group.x].inflow = sums[0].y;
        partials[group.x].booked_in_drift = sums[0].z;
    }
}

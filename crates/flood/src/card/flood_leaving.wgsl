// What crosses the edges is put back or booked, and each particle counts itself in its cell. Twin of `flood/exchange.rs` (lose).
#import flood_moves

@group(0) @binding(7) var<storage, read_write> counts: array<atomic<u32>>;
@group(0) @binding(8) var<storage, read_write> places: array<vec2u>;
@group(0) @binding(9) var<storage, read_write> keys: array<u32>;

// How far beyond an edge particles go on, in smoothing lengths, and at least how fast: its Froude number.
const BEYOND = 4.0;
const SLOWEST_LEAVING = 0.1;

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

// How near a particle comes to walls, m. Twin of `BeforeWalls::of` in `edges.rs`.
fn before_walls(h: f32) -> f32 {
    return select(0.25 * min(parameters.spacing, h / parameters.eta), 0.0, parameters.scheme == SPH_SWE);
}

// A coordinate that is too near a wall, and its velocity, put off it: both, as they then are.
fn put_off(value: f32, velocity: f32, low: f32, high: f32, low_rule: u32, high_rule: u32, off: f32) -> vec2f {
    let before = min(off, 0.5 * (high - low));
    if low_rule == WALL && value < low + before {
        return vec2f(low + before, max(velocity, 0.0));
    }
    if high_rule == WALL && value > high - before {
        return vec2f(high - before, min(velocity, 0.0));
    }
    return vec2f(value, velocity);
}

// Outflow, inflow and momentum booked.
fn put_back(particle: ptr<function, Particle>) -> vec3f {
    var booked = vec3f(0.0);
    let volume = (*particle).volume;
    let place = (*particle).place;
    let was_inside = (*particle).outside == 0u;
    let x = keep(place.x, parameters.bounds.x, parameters.bounds.y, parameters.rules.x, parameters.rules.y);
    let y = keep(place.y, parameters.bounds.z, parameters.bounds.w, parameters.rules.z, parameters.rules.w);
    var velocity = (*particle).velocity;
    let before = sum(velocity);
    velocity *= vec2f(x.y, y.y);
    let side = select(u32(x.z), 2u + u32(y.z), y.z > 0.0);
    var now = vec2f(x.x, y.x);
    // Where the particles are only brought into new cells the step is 0 s long, and nothing is booked.
    if side == 0u && status.step > 0.0 {
        let bounds = parameters.bounds;
        let rules = parameters.rules;
        let off = before_walls((*particle).next_h);
        let along_x = put_off(now.x, velocity.x, bounds.x, bounds.y, rules.x, rules.y, off);
        let along_y = put_off(now.y, velocity.y, bounds.z, bounds.w, rules.z, rules.w, off);
        now = vec2f(along_x.x, along_y.x);
        velocity = vec2f(along_x.y, along_y.y);
    }
    if was_inside && side == 0u {
        booked.z = volume * (sum(velocity) - before);
    } else if was_inside {
        booked.x = volume;
        booked.z = -volume * before;
        let outward = array(vec2f(-1.0, 0.0), vec2f(1.0, 0.0), vec2f(0.0, -1.0), vec2f(0.0, 1.0))[side - 1u];
        let slowest = SLOWEST_LEAVING * sqrt(parameters.gravity * (*particle).depth);
        velocity += max(slowest - dot(velocity, outward), 0.0) * outward;
    } else if side == 0u {
        booked.y = volume;
        booked.z = volume * sum(velocity);
    }
    (*particle).place = now;
    (*particle).velocity = velocity;
    (*particle).outside = side;
    return booked;
}

// Whether a particle is so far beyond an edge that it is seen no more, or holds no water.
fn is_gone(particle: Particle) -> bool {
    let bounds = parameters.bounds;
    let place = particle.place;
    let beyond = max(max(bounds.x - place.x, place.x - bounds.y), max(bounds.z - place.y, place.y - bounds.w));
    return particle.volume <= 0.0 || (particle.outside > 0u && beyond >= BEYOND * particle.next_h);
}

// Puts a particle back that has crossed an edge: outflow and inflow, and momentum that came and that went.
fn kept(particle: ptr<function, Particle>) -> vec4f {
    if !((*particle).volume > 0.0) {
        return vec4f(0.0);
    }
    let booked = put_back(particle);
    return vec4f(booked.xy, max(booked.z, 0.0), max(-booked.z, 0.0));
}

// A particle counts itself in its cell.
fn count(i: u32, particle: Particle) {
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

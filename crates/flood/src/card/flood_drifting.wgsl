// First half of the step's acceleration; then the particles move, and those that came into obstacles are put back. Twin of
// `flood/step.rs` (push, keep_out).
#import flood_moves
#import flood_friction
#import flood_outlines

// Outlines of obstacles: see `flood_outlines`.
@group(0) @binding(3) var<storage, read> outlines: array<u32>;
// Impulses of particles that are put back, east and north for each obstacle, in KNOCK; and last how many there were.
@group(0) @binding(4) var<storage, read_write> knocks: array<atomic<i32>>;
@group(0) @binding(6) var rough: texture_2d<f32>;

// A ten-thousandth of a particle's volume times m/s: whole numbers add up to the same in any order.
const KNOCK = 1e-4;

// A particle that has come into an obstacle is put this far before its wall, over the particles' distance.
const BEFORE_WALL = 1e-3;

fn side(number: u32) -> vec4f {
    let at = 4u * number;
    return vec4f(
        bitcast<f32>(outlines[at]),
        bitcast<f32>(outlines[at + 1u]),
        bitcast<f32>(outlines[at + 2u]),
        bitcast<f32>(outlines[at + 3u]),
    );
}

// Where a place is to an outline: the way to it from the nearest wall, that wall, and whether it is inside.
struct Within {
    way: vec2f,
    wall: vec4f,
    is_inside: bool,
}

// Of an outline from its first side to its last.
fn within(place: vec2f, first: u32, end: u32) -> Within {
    var found = Within(vec2f(0.0), vec4f(0.0), false);
    var nearest = 3e38;
    for (var number = first; number < end; number++) {
        let wall = side(number);
        let way = way_from(place, wall);
        if dot(way, way) < nearest {
            nearest = dot(way, way);
            found.way = way;
            found.wall = wall;
        }
        found.is_inside = found.is_inside != crosses(place, wall);
    }
    return found;
}

// The way out of an outline that a place is inside, to a little before its wall.
fn way_out(place: vec2f, found: Within, first: u32, end: u32) -> vec2f {
    let off = BEFORE_WALL * parameters.spacing;
    let deep = length(found.way);
    if deep > off {
        return -(1.0 + off / deep) * found.way;
    }
    // So near the wall rounding may have turned the way round: across the wall, to the side that is not inside.
    let along = normalize(found.wall.zw - found.wall.xy);
    let across = (off + deep) * vec2f(along.y, -along.x);
    return select(across, -across, within(place + across, first, end).is_inside);
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
        let found = within(*place, outlines[k + 1u], outlines[k + 2u]);
        if !found.is_inside {
            continue;
        }
        let way = way_out(*place, found, outlines[k + 1u], outlines[k + 2u]);
        *place += way;
        let normal = normalize(way);
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

// Moves a particle; the momentum that it gains on the way.
fn moved(particle: ptr<function, Particle>) -> f32 {
    let is_inside = (*particle).outside == 0u;
    if !is_inside && parameters.rules[(*particle).outside - 1u] == STAGE {
        // What is held at a level moves with the water before the edge: see `flood_carry`.
        (*particle).velocity = (*particle).acceleration;
        (*particle).acceleration = vec2f(0.0);
    }
    let volume = (*particle).volume;
    let pushed = parameters.before * status.step;
    var velocity = (*particle).velocity + pushed * (*particle).acceleration;
    var booked = 0.0;
    if is_inside && pushed > 0.0 {
        let roughness = roughness_at(parameters, rough, (*particle).place);
        let factor = slowed(parameters, roughness, velocity, (*particle).depth, pushed);
        booked = volume * sum(velocity) * (factor - 1.0);
        velocity *= factor;
    }
    var place = (*particle).place + status.step * velocity;
    if is_inside {
        booked -= sum(kept_out(&place, &velocity, volume));
    }
    (*particle).place = place;
    (*particle).velocity = velocity;
    return booked;
}

// When particles are halved, and when two are merged. Twin of `Refinement` in `refinement.rs`. Declares the parameters and the outlines of
// obstacles.
#import flood_card
#import flood_outlines

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> outlines: array<u32>;

// What is to become of a particle: the number of the one that it would best be merged with, or one of these; and of one that is to be
// halved, the direction from one half to the other, as an angle.
struct Plan {
    mate: u32,
    axis: f32,
}

const ALONE = 0xffffffffu;
const HALVED = 0xfffffffeu;

// `tallies` say, one after the other: particles before, the identity of the first new one, how many may come, and for each group of
// particles how many of them are to be halved, and later how many before them.
const BEFORE = 0u;
const FIRST_ID = 1u;
const MAY_COME = 2u;
const OF_GROUPS = 3u;

// Water slower than this Froude number is not split.
const SLOWEST = 0.05;

// Halves stand so far from their common centre, over the distance of particles that stand for as much area.
const APART = 0.35;

// By what the smoothing length is multiplied when a particle is halved, and divided when two are merged.
const CLOSER = 0.85;

// Two particles are merged where they stand for less than this share of the area for which one is split.
const MERGED = 0.6;

fn area_of(particle: Particle) -> f32 {
    return particle.volume / particle.depth;
}

fn is_settled(particle: Particle) -> bool {
    return particle.outside == 0u && particle.volume > 0.0 && particle.depth > 0.0;
}

fn is_wide(particle: Particle) -> bool {
    return is_settled(particle)
        && area_of(particle) > parameters.widest
        && particle.volume >= 2.0 * parameters.smallest
        && length(particle.velocity) > SLOWEST * sqrt(parameters.gravity * particle.depth);
}

fn is_small(particle: Particle) -> bool {
    return is_settled(particle)
        && area_of(particle) < MERGED * parameters.widest
        && particle.volume < 0.75 * parameters.largest;
}

// The half of a particle on one side of its centre, -1 or 1. Half of a number is exact.
fn half_of(particle: Particle, axis: f32, side: f32) -> Particle {
    var half = particle;
    half.place += side * APART * sqrt(area_of(particle)) * vec2f(cos(axis), sin(axis));
    half.volume *= 0.5;
    half.weight *= 0.5;
    half.next_h *= CLOSER;
    return half;
}

// Two particles as one: at their centre of mass, with the momentum of both, standing for the area of both.
fn joined(one: Particle, other: Particle) -> Particle {
    var both = one;
    both.volume = one.volume + other.volume;
    both.weight = one.weight + other.weight;
    let part = other.volume / both.volume;
    both.place += part * (other.place - one.place);
    both.velocity += part * (other.velocity - one.velocity);
    both.acceleration += part * (other.acceleration - one.acceleration);
    both.depth = both.volume / (area_of(one) + area_of(other));
    both.next_h = max(one.next_h, other.next_h) / CLOSER;
    both.id = min(one.id, other.id);
    return both;
}

// Whether an obstacle holds a place. Twin of `Obstacles::hold`.
fn is_held(place: vec2f) -> bool {
    let grid = parameters.outlines;
    let at = (place - grid.corner) * grid.per_cell;
    if grid.columns == 0u || any(at < vec2f(0.0)) || any(at >= vec2f(vec2u(grid.columns, grid.rows))) {
        return false;
    }
    let cell = u32(at.y) * grid.columns + u32(at.x);
    for (var k = outlines[cell]; k < outlines[cell + 1u]; k += 3u) {
        var inside = false;
        for (var number = outlines[k + 1u]; number < outlines[k + 2u]; number++) {
            let first = 4u * number;
            let corner = vec2f(bitcast<f32>(outlines[first]), bitcast<f32>(outlines[first + 1u]));
            let next = vec2f(bitcast<f32>(outlines[first + 2u]), bitcast<f32>(outlines[first + 3u]));
            inside = inside != crosses(place, vec4f(corner, next));
        }
        if inside {
            return true;
        }
    }
    return false;
}

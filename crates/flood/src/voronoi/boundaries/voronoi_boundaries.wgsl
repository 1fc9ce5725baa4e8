// Fluxes through border faces: see `boundaries/mod.rs` and `boundaries/state.rs`. Levels are above the bed that the cell sees under its level. `IS_SECOND` comes with the stage.
#import declared
#import stage
#import voronoi_faces
#import voronoi_tables

// Per length: volume out of the cell, momentum across and along the face that goes with it, thrust less the cell's own.
struct Crossing {
    volume: f32,
    carried: vec2f,
    thrust: f32,
}

// Iterations of Newton's method. Fewer than `BOUNDARY_ITERATIONS` of `state.rs`, as single precision has fewer digits to find.
const BOUNDARY_ITERATIONS_ON_GPU = 20u;

// Thrust on a wall less that of the cell: the flux of Harten, Lax & van Leer between the water and its mirror image, whose wave speeds are u - c and, from the
// two-rarefaction state, c + u/2 (Toro 2001, equation 10.18).
fn through_wall(at: AtFace) -> Crossing {
    let celerity = sqrt(parameters.gravity * at.depth);
    let fastest = max(celerity - at.across, celerity + 0.5 * at.across);
    return Crossing(0.0, vec2f(0.0), at.depth * at.across * (at.across + fastest));
}

// The celerity of waves where the water stands at a level.
fn celerity_of(level: f32) -> f32 {
    return sqrt(parameters.gravity * max(level, 0.0));
}

// No water passes: the level rises or falls until what comes from inside is at rest.
fn still(outgoing: f32) -> vec2f {
    return vec2f(max(0.5 * outgoing, 0.0), 0.0);
}

// Critical flow outwards.
fn critical(outgoing: f32) -> vec2f {
    return vec2f(max(outgoing / 3.0, 0.0));
}

// Celerity and velocity outwards where the water beyond has a celerity and moves outwards at `drift`, by the characteristics that reach the face (Toro 2001,
// section 6.3): a free fall where there is none; onto dry ground or a film as it is beyond where it is faster than waves there, else the critical depth of a
// dam break (Ritter 1892).
fn meets(beyond: f32, drift: f32, is_wet: bool, outgoing: f32) -> vec2f {
    if beyond <= 0.0 {
        return critical(outgoing);
    }
    let incoming = drift - 2.0 * beyond;
    let across = 0.5 * (outgoing + incoming);
    let celerity = 0.25 * (outgoing - incoming);
    if is_wet && across >= -celerity {
        return vec2f(max(celerity, 0.0), across);
    }
    if -drift >= beyond {
        return vec2f(beyond, drift);
    }
    let speed = max(-incoming / 3.0, 0.0);
    return vec2f(speed, -speed);
}

// Nothing comes in.
fn open(outgoing: f32, level: f32) -> vec2f {
    let found = meets(celerity_of(level), 0.0, true, outgoing);
    if found.y < 0.0 {
        return still(outgoing);
    }
    return found;
}

// Water beyond at a level that moves outwards at `drift`: over the ground under the face where it comes in faster than waves.
fn level_beyond(at: AtFace, outgoing: f32, level: f32, drift: f32, ground_level: f32) -> vec2f {
    let found = meets(celerity_of(level), drift, at.depth > 0.0, outgoing);
    let over_ground = celerity_of(level - ground_level);
    if -drift >= over_ground && found.y <= -found.x {
        return vec2f(over_ground, drift);
    }
    return found;
}

// The velocity towards the face that water loses where a wave changes its celerity from `before` to `after`, and the slope of that: see `Inside` of
// `boundaries/state.rs`.
fn slowed(before: f32, after: f32) -> vec2f {
    if after <= before {
        return vec2f(2.0 * (after - before), 2.0);
    }
    let mean = sqrt(0.5 * (after * after + before * before));
    let ratio = (after - before) * (after + before) / (after * before);
    return vec2f(ratio * mean, (1.0 / before + before / (after * after)) * mean + 0.5 * ratio * after / mean);
}

// A celerity at least as large as that at which it has lost `by`.
fn at_most(before: f32, by: f32) -> f32 {
    let without_bore = before + 0.5 * by;
    return select(without_bore, min(without_bore, sqrt(before * (before + sqrt(2.0) * max(by, 0.0)))), by > 0.0);
}

// What comes in at a celerity less the discharge, times gravity, and the slope of that.
fn excess(before: f32, across: f32, celerity: f32, wanted: f32) -> vec2f {
    let found = slowed(before, celerity);
    let inwards = found.x - across;
    return vec2f(celerity * celerity * inwards - wanted, celerity * (2.0 * inwards + celerity * found.y));
}

// A discharge inwards: the water inside loses its velocity to that of what comes in, where that flow is slower than waves; critical depth where it is not.
fn comes_in(discharge: f32, before: f32, across: f32) -> vec2f {
    let wanted = parameters.gravity * discharge;
    var celerity = pow(wanted, 1.0 / 3.0);
    if before > 0.0 && excess(before, across, celerity, wanted).x < 0.0 {
        celerity = at_most(before, across + celerity);
        for (var k = 0u; k < BOUNDARY_ITERATIONS_ON_GPU; k++) {
            let found = excess(before, across, celerity, wanted);
            celerity -= found.x / found.y;
        }
    }
    return vec2f(celerity, -wanted / (celerity * celerity));
}

// A discharge outwards, and that of critical flow at most: the larger root of c^2 (outgoing - 2c) = g q.
fn goes_out(discharge: f32, outgoing: f32) -> vec2f {
    if outgoing <= 0.0 || discharge <= 0.0 {
        return still(outgoing);
    }
    let slowest = outgoing / 3.0;
    let wanted = parameters.gravity * discharge;
    if wanted >= slowest * slowest * slowest {
        return critical(outgoing);
    }
    var celerity = 0.5 * outgoing;
    for (var k = 0u; k < BOUNDARY_ITERATIONS_ON_GPU; k++) {
        let value = celerity * celerity * (outgoing - 2.0 * celerity) - wanted;
        let slope = celerity * (2.0 * outgoing - 6.0 * celerity);
        celerity = max(celerity - value / min(slope, -1e-30), slowest);
    }
    return vec2f(celerity, wanted / (celerity * celerity));
}

// Normal flow with the velocity `factor` depth^(2/3) where that is slower than waves, critical flow where it is not.
fn normal_flow(factor: f32, outgoing: f32) -> vec2f {
    if outgoing <= 0.0 {
        return still(outgoing);
    }
    var low = 0.0;
    var high = 0.5 * outgoing;
    for (var k = 0u; k < 26u; k++) {
        let middle = 0.5 * (low + high);
        let velocity = factor * pow(middle * middle / parameters.gravity, 2.0 / 3.0);
        if velocity + 2.0 * middle < outgoing {
            low = middle;
        } else {
            high = middle;
        }
    }
    if factor * pow(low * low / parameters.gravity, 2.0 / 3.0) > low {
        return critical(outgoing);
    }
    return vec2f(low, outgoing - 2.0 * low);
}

// Water before a wall that moves inwards: as fast as the wall, unless the wall leaves it behind.
fn before_paddle(inwards: f32, before: f32, across: f32) -> vec2f {
    let closing = across + inwards;
    var celerity = at_most(before, closing);
    if before <= 0.0 || celerity <= 0.0 {
        return vec2f(0.0);
    }
    if closing > 0.0 {
        for (var k = 0u; k < BOUNDARY_ITERATIONS_ON_GPU; k++) {
            let found = slowed(before, celerity);
            celerity -= (found.x - closing) / found.y;
        }
    }
    return vec2f(celerity, -inwards);
}

// The value of a table in the stage.
fn in_stage(table: u32) -> f32 {
    return in_step(table, AT_BEGINNING + u32(IS_SECOND));
}

// Level and velocity outwards of an incoming simple wave: what is not given of them follows from u = 2 (c - c0).
fn wave(border: Border) -> vec2f {
    let at_rest = celerity_of(border.rest);
    var inwards = 0.0;
    if border.velocity_table != NONE {
        inwards = in_stage(border.velocity_table);
    }
    var level = 0.0;
    if border.table != NONE {
        level = border.datum + in_stage(border.table);
    } else {
        let celerity = max(at_rest + 0.5 * inwards, 0.0);
        level = celerity * celerity / parameters.gravity;
    }
    if border.velocity_table == NONE {
        inwards = 2.0 * (celerity_of(level) - at_rest);
    }
    return vec2f(level, -inwards);
}

// Celerity and velocity outwards of the water at a border face that is no wall; `known` is what is known of the water beyond.
fn state_of(border: Border, known: f32, at: AtFace) -> vec2f {
    let celerity = sqrt(parameters.gravity * at.depth);
    let outgoing = at.across + 2.0 * celerity;
    if border.kind == PADDLE {
        return before_paddle(in_step(border.table, MEAN), celerity, at.across);
    }
    if border.kind == DISCHARGE && known > 0.0 {
        return comes_in(known, celerity, at.across);
    }
    if at.depth > 0.0 && at.across >= celerity {
        return vec2f(celerity, at.across);
    }
    switch border.kind {
        case OPEN: {
            return open(outgoing, known);
        }
        case NORMAL: {
            return normal_flow(border.factor, outgoing);
        }
        case DISCHARGE: {
            return goes_out(-known, outgoing);
        }
        case LEVEL: {
            return level_beyond(at, outgoing, border.datum + in_stage(border.table), known, border.ground);
        }
        default: {
            let beyond = wave(border);
            return level_beyond(at, outgoing, beyond.x, beyond.y, border.ground);
        }
    }
}

// Whether water may come in over a border onto dry ground.
fn may_bring(border: Border) -> bool {
    return border.kind == LEVEL || border.kind == WAVE || border.kind == DISCHARGE;
}

// The depth at which waves have a celerity: by the ratio of celerities, so that still water has the cell's own depth to the bit.
fn depth_of(celerity: f32, own_depth: f32) -> f32 {
    if own_depth <= 0.0 {
        return celerity * celerity / parameters.gravity;
    }
    let ratio = celerity / sqrt(parameters.gravity * own_depth);
    return own_depth * ratio * ratio;
}

// A border where the level is `shift` above mean bed plus depth.
fn as_seen(border: Border, shift: f32) -> Border {
    var own = border;
    own.datum -= shift;
    own.ground -= shift;
    own.rest -= shift;
    return own;
}

fn through_border(border: Border, known: f32, at: AtFace, shift: f32) -> Crossing {
    if border.kind == WALL {
        return through_wall(at);
    }
    let state = state_of(as_seen(border, shift), select(known, known - shift, border.kind == OPEN), at);
    let depth = depth_of(state.x, at.depth);
    var volume = depth * state.y;
    if border.kind == DISCHARGE && known >= 0.0 {
        // The hydrograph's.
        volume = -known;
    }
    let along = select(0.0, at.along, state.y > 0.0);
    let thrust = 0.5 * parameters.gravity * (depth - at.depth) * (depth + at.depth);
    return Crossing(volume, volume * vec2f(state.y, along), thrust);
}

// What passes border faces: see `boundaries/mod.rs` and `boundaries/state.rs`.
#import declared
#import voronoi_faces

// Per length: volume out of the cell, momentum across and along the face that goes with it, thrust less the cell's own.
struct Crossing {
    volume: f32,
    carried: vec2f,
    thrust: f32,
}

// Thrust on a wall less that of the cell: the flux of Harten, Lax & van Leer between the water and its mirror image, whose wave speeds are u - c and, from the
// two-rarefaction state, c + u/2 (Toro 2001, equation 10.18).
fn through_wall(at: AtFace) -> Crossing {
    let celerity = sqrt(parameters.gravity * at.depth);
    let fastest = max(celerity - at.across, celerity + 0.5 * at.across);
    return Crossing(0.0, vec2f(0.0), at.depth * at.across * (at.across + fastest));
}

// Celerity and velocity outwards at an open side, by the characteristics that reach it (Toro 2001, section 6.3): the water beyond is still, and `beyond` deep; a
// free fall where there is none. Nothing comes in.
fn open(at: AtFace, beyond: f32) -> vec2f {
    let celerity = sqrt(parameters.gravity * at.depth);
    let outgoing = at.across + 2.0 * celerity;
    if at.across >= celerity {
        return vec2f(celerity, at.across);
    }
    if beyond <= 0.0 {
        return vec2f(max(outgoing / 3.0, 0.0));
    }
    let incoming = -2.0 * sqrt(parameters.gravity * beyond);
    let across = 0.5 * (outgoing + incoming);
    if across < 0.0 {
        return vec2f(max(0.5 * outgoing, 0.0), 0.0);
    }
    return vec2f(max(0.25 * (outgoing - incoming), 0.0), across);
}

// The same in normal flow with the velocity `factor` depth^(2/3) where that is slower than waves, critical flow where it is not.
fn normal_flow(at: AtFace, factor: f32) -> vec2f {
    let celerity = sqrt(parameters.gravity * at.depth);
    let outgoing = at.across + 2.0 * celerity;
    if at.across >= celerity {
        return vec2f(celerity, at.across);
    }
    if outgoing <= 0.0 {
        return vec2f(max(0.5 * outgoing, 0.0), 0.0);
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
        low = outgoing / 3.0;
    }
    return vec2f(low, outgoing - 2.0 * low);
}

fn through_border(border: Border, at: AtFace) -> Crossing {
    if border.kind == WALL {
        return through_wall(at);
    }
    var state = vec2f(0.0);
    if border.kind == OPEN {
        state = open(at, border.value);
    } else {
        state = normal_flow(at, border.value);
    }
    // By the ratio of celerities: still water has the cell's own depth to the bit.
    let ratio = state.x / sqrt(parameters.gravity * at.depth);
    let depth = at.depth * ratio * ratio;
    let volume = depth * state.y;
    let along = select(0.0, at.along, state.y > 0.0);
    let thrust = 0.5 * parameters.gravity * (depth - at.depth) * (depth + at.depth);
    return Crossing(volume, volume * vec2f(state.y, along), thrust);
}

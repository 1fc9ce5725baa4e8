// Records what the water did in each cell: see `maps/mod.rs`.
#import declared

fn is_not_a_number(value: f32) -> bool {
    return (bitcast<u32>(value) & 0x7fffffffu) > 0x7f800000u;
}

// What the water did in a step of `step` s from a time on, by the depth before it and the water now. The time at which a depth was passed is found on the straight
// line between the depths before and after.
fn record(cell: u32, now: Water, before: f32, start: f32, step: f32) {
    let wet_depth = parameters.wet_depth;
    if now.depth <= wet_depth && before <= wet_depth {
        return;
    }
    let risen = select((wet_depth - before) / (now.depth - before), 0.0, before >= wet_depth);
    let fallen = select((before - wet_depth) / (before - now.depth), 1.0, now.depth >= wet_depth);
    var own = records[cell];
    if is_not_a_number(own.arrival) {
        own.arrival = start + risen * step;
    }
    own.duration += max(fallen - risen, 0.0) * step;
    if now.depth > wet_depth {
        let speed = length(now.velocity);
        own.max_depth = max(own.max_depth, now.depth);
        if speed > length(own.fastest) {
            own.fastest = now.velocity;
        }
        own.hazard = max(own.hazard, now.depth * (speed + 0.5));
    }
    records[cell] = own;
}

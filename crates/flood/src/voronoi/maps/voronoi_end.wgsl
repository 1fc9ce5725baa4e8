// The end of a step: records what the water did in each cell (see `maps/mod.rs`), and finds how long the next step may be.
#import declared

var<workgroup> steps: array<f32, 256>;
var<workgroup> counts: array<vec2u, 256>;

fn is_not_a_number(value: f32) -> bool {
    return (bitcast<u32>(value) & 0x7fffffffu) > 0x7f800000u;
}

// The time at which a depth was passed is found on the straight line between the depths before and after.
fn record(cell: u32, now: Water) {
    let before = columns[parameters.cells + cell].volume.x / ground[cell].area;
    let wet_depth = parameters.wet_depth;
    if now.depth <= wet_depth && before <= wet_depth {
        return;
    }
    let risen = select((wet_depth - before) / (now.depth - before), 0.0, before >= wet_depth);
    let fallen = select((before - wet_depth) / (before - now.depth), 1.0, now.depth >= wet_depth);
    var own = records[cell];
    if is_not_a_number(own.arrival) {
        own.arrival = status.clock.x + risen * status.step;
    }
    own.duration += max(fallen - risen, 0.0) * status.step;
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

@compute @workgroup_size(256)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    steps[thread] = 3.0e38;
    counts[thread] = vec2u(0u);
    if id.x < parameters.cells {
        let now = water[id.x];
        record(id.x, now);
        if now.depth > 0.0 {
            steps[thread] = ground[id.x].width / (length(now.velocity) + sqrt(parameters.gravity * now.depth));
            counts[thread] = vec2u(1u, ground[id.x].rim);
        }
    }
    for (var half = 128u; half > 0u; half /= 2u) {
        workgroupBarrier();
        if thread < half {
            steps[thread] = min(steps[thread], steps[thread + half]);
            counts[thread] += counts[thread + half];
        }
    }
    if thread == 0u {
        found[group.x] = Found(steps[0], counts[0].x, counts[0].y, 0u);
    }
}

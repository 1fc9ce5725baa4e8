// Shares discharges out over border faces by conveyance: see `share` in `boundaries/open.rs`. A group does one.
#import declared
#import voronoi_storage

var<workgroup> sums: array<vec2f, 256>;

// The sum of what all threads have, for all of them.
fn sum_of(thread: u32, own: vec2f) -> vec2f {
    sums[thread] = own;
    for (var half = 128u; half > 0u; half /= 2u) {
        workgroupBarrier();
        if thread < half {
            sums[thread] += sums[thread + half];
        }
    }
    let sum = workgroupUniformLoad(&sums[0]);
    return sum;
}

// Length times depth to 5/3 over the length: the depth is that below a level, or the cell's own.
fn conveyance(part: Part, level: f32, is_own: bool) -> f32 {
    let depth = select(depth_below(part.cell, level - part.bed), water[part.cell].depth, is_own);
    return pow(depth, 5.0 / 3.0);
}

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    let own = discharges[group.x];
    var along = vec2f(0.0);
    var by_depth = vec2f(0.0);
    for (var k = own.first + thread; k < own.end; k += GROUP) {
        let part = parts[k];
        let depth = water[part.cell].depth;
        if depth > 0.0 {
            let level = part.bed + depth + water[part.cell].shift;
            along += part.length * vec2f(1.0, level);
            by_depth += part.length * depth * vec2f(1.0, level);
        }
    }
    along = sum_of(thread, along);
    by_depth = sum_of(thread, by_depth);
    var discharge = 0.0;
    if own.is_rating == 0u {
        discharge = in_step(own.table, MEAN);
    } else if along.x > 0.0 {
        discharge = -max(value_at(own.table, vec2f(along.y / along.x, 0.0)), 0.0);
    }
    let level = select(-3.0e38, by_depth.y / max(by_depth.x, 1e-37), by_depth.x > 0.0);
    let is_out = discharge < 0.0;
    var all = vec2f(0.0);
    for (var k = own.first + thread; k < own.end; k += GROUP) {
        all.x += parts[k].length * conveyance(parts[k], level, is_out);
    }
    all = sum_of(thread, all);
    for (var k = own.first + thread; k < own.end; k += GROUP) {
        var part = parts[k].when_dry;
        if all.x > 0.0 {
            part = conveyance(parts[k], level, is_out) / all.x;
        }
        beyond[parts[k].border] = discharge * part;
    }
}

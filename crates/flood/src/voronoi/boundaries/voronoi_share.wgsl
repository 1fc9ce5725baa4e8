// Shares discharges out over border faces by conveyance: see `share` in `boundaries/open.rs`. A group does one.
#import declared
#import voronoi_storage
#import group_reduction

alias Reduced = vec2f;

fn combine(a: Reduced, b: Reduced) -> Reduced {
    return a + b;
}

// Length times depth to 5/3 over the length: the depth is that below a level, or the cell's own.
fn conveyance(part: Part, level: f32, is_own: bool) -> f32 {
    let depth = select(depth_below(part.cell, level - part.bed), water[part.cell].depth, is_own);
    return pow(depth, 5.0 / 3.0);
}

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    let own = discharges[group.x];
    var by_depth = vec2f(0.0);
    for (var k = own.first + thread; k < own.end; k += GROUP) {
        let part = parts[k];
        let depth = water[part.cell].depth;
        if depth > 0.0 {
            let level = part.bed + depth + water[part.cell].shift;
            by_depth += part.length * depth * vec2f(1.0, level);
        }
    }
    by_depth = reduce_group(thread, by_depth);
    var discharge = 0.0;
    if own.is_rating == 0u {
        discharge = in_step(own.table, MEAN);
    } else if by_depth.x > 0.0 {
        discharge = -max(value_at(own.table, vec2f(by_depth.y / by_depth.x, 0.0)), 0.0);
    }
    let level = select(-FAR, by_depth.y / max(by_depth.x, 1e-37), by_depth.x > 0.0);
    let is_out = discharge < 0.0;
    var all = vec2f(0.0);
    for (var k = own.first + thread; k < own.end; k += GROUP) {
        all.x += parts[k].length * conveyance(parts[k], level, is_out);
    }
    all = reduce_group(thread, all);
    for (var k = own.first + thread; k < own.end; k += GROUP) {
        var part = parts[k].when_dry;
        if all.x > 0.0 {
            part = conveyance(parts[k], level, is_out) / all.x;
        }
        beyond[parts[k].border] = discharge * part;
    }
}

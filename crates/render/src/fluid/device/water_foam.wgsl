// Foam spreads, so that single particles do not stand out; it is the new foam, or the rest of the old. Twin of `foam_around` and
// `Water::keep_foam` in `water.rs`.
#import water_device

fn foam_around(i: u32) -> f32 {
    let own = sites[i];
    let reach = REACH * own.w;
    let low = cell_at(water, own.xy - reach);
    let high = cell_at(water, own.xy + reach);
    var sum = 0.0;
    var weights = 0.0;
    for (var row = low.y; row <= high.y; row++) {
        let end = start[row * water.columns + high.x + 1u];
        for (var k = start[row * water.columns + low.x]; k < end; k++) {
            let away = sites[k].xy - own.xy;
            let left = max(1.0 - dot(away, away) / (reach * reach), 0.0);
            let share = left * left * left;
            sum += share * foam[k];
            weights += share;
        }
    }
    return sum / weights;
}

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= start[of_ground(water)] {
        return;
    }
    let slot = matter[i].y & water.memory;
    let now = max(foam_around(i), water.left * before[slot]);
    instances[i].matter.y = now;
    if now > LEAST_FOAM {
        atomicMax(&after[slot], bitcast<u32>(now));
    }
}

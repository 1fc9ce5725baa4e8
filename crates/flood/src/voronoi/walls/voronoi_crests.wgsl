// Flow over each crest in a step, from the water before: see `walls/overtopping.rs`. Levels are above the bed of the first cell.
#import declared
#import hydraulics

fn flow_over(crest: Crest) -> vec3f {
    let first = crest.cells.x;
    let second = crest.cells.y;
    var levels = vec2f(NO_LEVEL);
    if water[first].depth > 0.0 {
        levels.x = water[first].depth + water[first].shift;
    }
    if water[second].depth > 0.0 {
        levels.y = crest.rise + water[second].depth + water[second].shift;
    }
    let is_back = levels.x < levels.y;
    let giver = select(first, second, is_back);
    let upper = max(levels.x, levels.y);
    let lower = min(levels.x, levels.y);
    if upper <= crest.above {
        return vec3f(0.0);
    }
    let wanted = status.step * over_weir(crest.above, crest.length, parameters.crest_coefficient, upper, lower);
    let own = ground[giver].area;
    let other = ground[select(second, first, is_back)].area;
    let most = select((upper - crest.above) * own, (upper - lower) * own * other / (own + other), lower > crest.above);
    let held = columns[giver].volume.x;
    let part = select(crest.parts.x, crest.parts.y, is_back);
    let volume = min(wanted, part * min(MAX_CREST_SHARE * most, held));
    if volume <= 0.0 {
        return vec3f(0.0);
    }
    return vec3f(volume / held * columns[giver].momentum, select(volume, -volume, is_back));
}

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x < parameters.crests {
        let flow = flow_over(crests[id.x]);
        crests[id.x].momentum = flow.xy;
        crests[id.x].volume = flow.z;
    }
}

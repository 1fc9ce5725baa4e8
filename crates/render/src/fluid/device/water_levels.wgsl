// The water's level at the nodes of the ground's borders. Twin of `levels` in `sides.rs`. Positions and lengths here are those of the stage.
#import water_borders

// Height of the upper side of a disc this much beside its middle, as if it went on flat. Twin of `Droplet::level`.
fn level_of(disc: DropletInstance, away: vec2f) -> f32 {
    let top = disc.flatness * disc.radius * disc.normal;
    return disc.position.z + top.z - dot(disc.normal.xy, away - top.xy) / max(disc.normal.z, 1e-3);
}

@compute @workgroup_size(BORDER_GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= border_nodes(water) {
        return;
    }
    let node = border_node(water, id.x).xy;
    let metres = node_position(water, node);
    let position = water.unit * metres;
    let reach = OVER_REACH * bitcast<f32>(atomicLoad(&sizes.farthest));
    let low = cell_at(water, metres - reach);
    let high = cell_at(water, metres + reach);
    var sum = 0.0;
    var weights = 0.0;
    for (var row = low.y; row <= high.y; row++) {
        let end = start[row * water.columns + high.x + 1u];
        for (var k = start[row * water.columns + low.x]; k < end; k++) {
            let disc = instances[k];
            let away = position - disc.position.xy;
            let spread = disc.matter.z;
            let left = max(1.0 - dot(away, away) / (spread * spread), 0.0);
            let share = left * left * left;
            weights += share;
            sum += share * level_of(disc, away);
        }
    }
    let ground = heights[node.y * water.ground_nodes.x + node.x];
    let is_wet = weights > COVERED && ground < NO_HEIGHT;
    levels[id.x] = select(NO_HEIGHT, max(sum / weights, water.unit * ground), is_wet);
}

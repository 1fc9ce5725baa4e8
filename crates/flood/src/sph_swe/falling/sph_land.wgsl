// Water in the air falls until it meets ground or water. Twin of `Falling` in `mod.rs`.
#import sph_water

fn has_landed(drop: Drop) -> bool {
    let ground = ground_at(drop.position).x;
    return drop.z <= ground || drop.z <= ground + water_at(drop.position).x;
}

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= parameters.in_air || drops[id.x].state != FALLS {
        return;
    }
    var drop = drops[id.x];
    drop.z += status.step * (drop.w - 0.5 * parameters.gravity * status.step);
    drop.w -= parameters.gravity * status.step;
    drop.position += status.step * drop.velocity;
    drop.state = select(FALLS, LANDS, has_landed(drop));
    drops[id.x] = drop;
}

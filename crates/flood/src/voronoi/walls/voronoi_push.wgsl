// What the water pushes obstacles with in a stage: each face at an obstacle adds up its own. See `pass_borders` in `solver.rs`. `IS_SECOND` comes with the stage.
#import declared
#import stage
#import compensated_sums

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= parameters.borders {
        return;
    }
    let border = borders[id.x];
    if border.obstacle == NONE {
        return;
    }
    let face = faces[border.face];
    let depth = water[face.first].depth;
    // The thrust of the face is that less the cell's own.
    let thrust = fluxes[border.face].thrust.x + 0.5 * parameters.gravity * depth * depth;
    let push = 0.5 * status.step * thrust * face.normal;
    var all = pushes[id.x];
    all.east = tidy(add(all.east, push.x));
    all.north = tidy(add(all.north, push.y));
    all.last = select(push, all.last + push, IS_SECOND);
    pushes[id.x] = all;
}

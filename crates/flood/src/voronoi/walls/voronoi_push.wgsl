// What the water pushes obstacles with in a stage: each face at an obstacle adds up its own. See `pass_borders` in `solver.rs`. `IS_SECOND` comes with the stage.
#import declared
#import stage
#import compensated_sums
#import time_steps

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
    if !is_in_step(face.first) {
        return;
    }
    let depth = water[face.first].depth;
    // The thrust of the face is that less the cell's own.
    let thrust = fluxes[border.face].thrust.x + 0.5 * parameters.gravity * depth * depth;
    let push = 0.5 * share_of(face.first) * step_of(face.first) * thrust * face.normal;
    var all = pushes[id.x];
    all.east = tidy(add(all.east, push.x));
    all.north = tidy(add(all.north, push.y));
    all.last = select(all.last + push, push, begins());
    pushes[id.x] = all;
}

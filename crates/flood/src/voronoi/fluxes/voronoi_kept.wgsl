// The part of its outflow in a step that each cell has the water for: see `kept_of_cell` in `solver.rs`.
#import declared
#import time_steps

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= parameters.cells || !is_near(id.x) {
        return;
    }
    var outflow = 0.0;
    for (var number = ground[id.x].first_link; number < ground[id.x].end_link; number++) {
        let link = links[number];
        if link.face != NONE {
            let volume = fluxes[link.face].volume;
            outflow += max(select(volume, -volume, link.side == 1u), 0.0);
        }
    }
    outflow *= step_of(id.x);
    let volume = volume_of(id.x);
    // Rounding must not take more than there is.
    let is_short = outflow * (1.0 + OUTFLOW_MARGIN) > volume;
    kept[id.x] = select(1.0, max((1.0 - OUTFLOW_MARGIN) * volume / outflow, 0.0), is_short);
}

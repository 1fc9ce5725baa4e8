// The velocity of the water beyond prescribed levels after a step: see `follow` in `boundaries/open.rs`.
#import declared
#import stage
#import voronoi_boundaries

fn velocity_beyond(written: Border, before: f32) -> f32 {
    let face = faces[written.face];
    let own = water[face.first];
    let border = as_seen(written, own.shift);
    let start = in_step(border.table, AT_BEGINNING);
    let end = in_step(border.table, AT_BEGINNING + 1u);
    let was = celerity_of(border.datum + start);
    let is = celerity_of(border.datum + end);
    if was == 0.0 || is == 0.0 || own.depth <= 0.0 {
        return 0.0;
    }
    let risen = before - 2.0 * (is - was);
    let at = at_side(own, normalize(face.normal));
    let found = state_of(border, risen, at);
    let crossing = border.span / is;
    let change = abs(end - start) / status.step;
    let slowest = CROSSINGS * crossing;
    var relaxation = slowest;
    if change > 0.0 {
        relaxation = clamp(LAG * own.depth / change, FEWEST_CROSSINGS * crossing, slowest);
    }
    return risen + min(status.step / relaxation, 1.0) * (found.y - risen);
}

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x < parameters.borders && borders[id.x].kind == LEVEL {
        beyond[id.x] = velocity_beyond(borders[id.x], beyond[id.x]);
    }
}

// The lower pace near the two cells of a face: as often is its flux needed. See `Inputs::are_needed` in `fluxes/pass.rs`.
#import declared

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= parameters.faces {
        return;
    }
    let face = faces[id.x];
    var near = extractBits(ground[face.first].paces, 4u, 2u);
    if face.second != NONE {
        near = min(near, extractBits(ground[face.second].paces, 4u, 2u));
    }
    fluxes[id.x].near = near;
}

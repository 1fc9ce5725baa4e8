// Distances from cells of the levels 0 and 1, in neighbours: once more each is that of a neighbour and one more where that is less. `IS_SECOND` comes with the
// stage: from the first half of the memory to the second, and back.
#import declared
#import stage

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= parameters.cells {
        return;
    }
    let before = select(0u, parameters.cells, IS_SECOND);
    let after = parameters.cells - before;
    let own = distances[before + id.x];
    var nearest = vec2u(own & 0xffu, own >> 8u);
    for (var number = ground[id.x].first_link; number < ground[id.x].end_link && nearest.x > 0u; number++) {
        let neighbour = links[number].neighbour;
        if neighbour != NONE {
            let its = distances[before + neighbour];
            nearest = min(nearest, vec2u(its & 0xffu, its >> 8u) + 1u);
        }
    }
    distances[after + id.x] = nearest.x | (nearest.y << 8u);
}

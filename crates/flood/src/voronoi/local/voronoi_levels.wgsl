// The level of each cell by the longest step that it can take, as distances 0 from cells of the levels 0 and 1: see `plan` in `local/mod.rs`.
#import declared
#import voronoi_stable

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= parameters.cells {
        return;
    }
    let stable = stable_step(id.x);
    let step = select(min(COURANT * stable, parameters.longest), FAR, stable == FAR);
    let is_twice = step >= 2.0 * status.shortest;
    let is_four_times = step >= 4.0 * status.shortest;
    let to_shortest = select(0u, BEYOND_REACH, is_twice);
    let to_twice = select(BEYOND_REACH, 0u, is_twice && !is_four_times);
    distances[id.x] = to_shortest | (to_twice << 8u);
}

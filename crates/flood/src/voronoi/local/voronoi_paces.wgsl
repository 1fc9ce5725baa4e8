// Level and pace of each cell (how often it repeats its stages), and the plan of each group: see `plan` in `local/mod.rs`.
#import declared
#import voronoi_plans

// The lowest level of cells so far away from cells of the levels 0 and 1, where it is at most `own`.
fn lowest(distance: vec2u, beyond: u32, own: u32) -> u32 {
    if distance.x <= WIDENED_SHORTEST + beyond {
        return 0u;
    }
    return select(own, min(own, 1u), distance.y <= WIDENED_TWICE + beyond);
}

@compute @workgroup_size(GROUP)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    var own = Plan();
    if id.x < parameters.cells {
        let distances = vec2u(distances[id.x] & 0xffu, distances[id.x] >> 8u);
        let level = lowest(distances, 0u, 2u);
        let pace = lowest(distances, REPEATED, 2u);
        let near = lowest(distances, REPEATED + 1u, 2u);
        let view = lowest(distances, REPEATED + 3u, 2u);
        ground[id.x].paces = level | (pace << 2u) | (near << 4u) | (view << 6u);
        let is_wet = water[id.x].depth > 0.0;
        own = Plan(level, select(0u, 1u, is_wet), select(0u, 4u >> pace, is_wet));
    }
    let all = reduce_group(thread, own);
    if thread == 0u {
        plans[group.x] = all;
    }
}

// Finds the level of the water in each cell after a stage, where the heights of the ground within cells count.
#import declared
#import voronoi_storage

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x < parameters.cells {
        let depth = water[id.x].depth;
        water[id.x].shift = level_over(id.x, depth) - depth;
    }
}

// The water of all columns after they were uploaded: found on the device, so that a run that goes on from a checkpoint has the same bits.
#import declared
#import voronoi_storage

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x < parameters.cells {
        water[id.x] = water_in(id.x, columns[id.x], ground[id.x].area);
    }
}

// The end of a part of a step: shows the water of cells that had that of their second stage to show, and records what it did in those whose own step has
// ended. See `show_ended` in `local/mod.rs` and `record` in `maps/mod.rs`.
#import declared
#import stage
#import voronoi_local
#import voronoi_storage
#import voronoi_record

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let cell = id.x;
    if cell >= parameters.cells {
        return;
    }
    if is_seen(cell) && !is_in_step(cell) {
        water[cell] = water_in(cell, columns[cell], ground[cell].area);
    }
    if (status.part + 1u) % (1u << level_of(cell)) == 0u {
        let own = step_of(cell);
        let before = start_of(cell).volume.x / ground[cell].area;
        let start = f32(status.part + 1u) * status.shortest - own;
        record(cell, water[cell], before, status.clock.x + start, own);
    }
}

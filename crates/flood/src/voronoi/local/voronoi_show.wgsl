// Shows the water as it is in a stage in all cells that those that take part now see; begins the steps of those whose own begin. See `show` in `local/mod.rs`.
#import declared
#import stage
#import voronoi_local
#import voronoi_storage

fn show_first(cell: u32) {
    if level_of(cell) <= status.now {
        columns[2u * parameters.cells + cell] = columns[cell];
        columns[3u * parameters.cells + cell] = Column(vec2f(0.0), vec2f(0.0));
    } else {
        water[cell] = water_in(cell, start_of(cell), ground[cell].area);
    }
}

fn show_second(cell: u32) {
    if is_in_step(cell) {
        water[parameters.cells + cell] = water[cell];
    } else {
        water[cell] = water[parameters.cells + cell];
    }
}

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= parameters.cells || !is_seen(id.x) {
        return;
    }
    if IS_SECOND {
        show_second(id.x);
    } else {
        show_first(id.x);
    }
}

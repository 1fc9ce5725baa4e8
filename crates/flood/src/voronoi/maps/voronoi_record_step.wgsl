// Records what the water did in a cell in a step that all cells take.
#import declared
#import voronoi_record

fn record_step(cell: u32) {
    let before = columns[parameters.cells + cell].volume.x / ground[cell].area;
    record(cell, water[cell], before, status.clock.x, status.step);
}

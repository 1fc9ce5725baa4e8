// Changes of columns by other than the motion of the water.
#import declared
#import compensated_sums
#import voronoi_storage

fn kinetic(column: Column) -> f32 {
    if column.volume.x <= 0.0 {
        return 0.0;
    }
    return 0.5 * dot(column.momentum, column.momentum) / column.volume.x;
}

// Energy over density above the level 0 of a column over a bed less that of another in the same cell.
fn energy_gained(cell: u32, before: Column, now: Column, area: f32, bed: f32) -> f32 {
    let gained = (now.volume.x - before.volume.x) + (now.volume.y - before.volume.y);
    let level = 0.5 * (level_over(cell, before.volume.x / area) + level_over(cell, now.volume.x / area));
    return kinetic(now) - kinetic(before) + parameters.gravity * gained * (bed + level);
}

// Samples the water in each cell of the maps. Twin of `Maps::sample`.
#import sph_water

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= status.map_cells {
        return;
    }
    var cell = map_cells[id.x];
    let water = water_at(cell.position);
    if !(water.x > status.wet_depth) {
        return;
    }
    let speed = length(water.yz);
    cell.max_depth = max(cell.max_depth, water.x);
    cell.max_speed = max(cell.max_speed, speed);
    cell.hazard = max(cell.hazard, water.x * (speed + 0.5));
    if cell.arrival < 0.0 {
        cell.arrival = status.clock_began + total(status.clock);
    } else {
        cell.duration += status.since_sample;
    }
    map_cells[id.x] = cell;
}

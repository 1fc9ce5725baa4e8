// What the water has done at each cell of the maps: a look at all of them. Twin of `Maps::look`.
#import flood_water

struct Cell {
    // Its centre, m.
    place: vec2f,
    // Largest depth, m, speed, m/s, and depth x (speed + 0.5), m2/s.
    max_depth: f32,
    max_speed: f32,
    hazard: f32,
    // When it was first seen wet, s, or less than 0, and for how long it has been since, s.
    arrival: f32,
    duration: f32,
    unused: f32,
}

@group(0) @binding(9) var<storage, read_write> cells: array<Cell>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= status.map_cells {
        return;
    }
    var cell = cells[id.x];
    let water = water_at(cell.place);
    if !(water.x > status.wet_depth) {
        return;
    }
    let speed = length(water.yz);
    cell.max_depth = max(cell.max_depth, water.x);
    cell.max_speed = max(cell.max_speed, speed);
    cell.hazard = max(cell.hazard, water.x * (speed + 0.5));
    if cell.arrival < 0.0 {
        cell.arrival = status.began + status.elapsed.sum;
    } else {
        cell.duration += status.since_look;
    }
    cells[id.x] = cell;
}

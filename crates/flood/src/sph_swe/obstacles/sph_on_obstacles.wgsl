// Sums the force on each obstacle, one group of threads for each, and over time. Twin of `add_obstacle_impulses` in `impulses.rs`.
#import compensated_sums
#import sph_neighbours
#import group_reduction

alias Reduced = vec2f;

fn combine(a: Reduced, b: Reduced) -> Reduced {
    return a + b;
}

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    let number = group.x;
    let low = cells_round(parameters.grid, obstacles[number].low, 0.0).xy;
    let high = cells_round(parameters.grid, obstacles[number].high, 0.0).xy;
    var own = vec2f(0.0);
    for (var row = low.y; row <= high.y; row++) {
        let line = row * parameters.grid.columns;
        let end = min(start[line + high.x + 1u], status.particles);
        for (var i = start[line + low.x] + thread; i < end; i += GROUP) {
            if u32(pushes[i].z) == number + 1u {
                own += pushes[i].xy;
            }
        }
    }
    let all = reduce_group(thread, own);
    if thread == 0u && status.halted == GOING {
        obstacles[number].impulse_east = add(obstacles[number].impulse_east, status.step * all.x);
        obstacles[number].impulse_north = add(obstacles[number].impulse_north, status.step * all.y);
        obstacles[number].force = all;
    }
}

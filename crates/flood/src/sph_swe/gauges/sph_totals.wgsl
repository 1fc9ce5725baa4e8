// Writes the totals of water and obstacles into rows of gauges: one group for each row. Twin of `SphSweFlood::reading`.
#import compensated_sums
#import sph_rows
#import group_reduction

alias Reduced = f32;

fn combine(a: Reduced, b: Reduced) -> Reduced {
    return a + b;
}

fn set_number(at: u32, number: f32) {
    rows[at] = bitcast<u32>(number);
}

fn set_pair(at: u32, pair: vec2f) {
    set_number(at, pair.x);
    set_number(at + 1u, pair.y);
}

fn set_obstacle(at: u32, number: u32) {
    set_pair(at, obstacles[number].force);
    set_pair(at + 2u, obstacles[number].impulse_east);
    set_pair(at + 4u, obstacles[number].impulse_north);
    rows[at + 6u] = bitcast<u32>(atomicLoad(&knocks[2u * number]));
    rows[at + 7u] = bitcast<u32>(atomicLoad(&knocks[2u * number + 1u]));
}

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    let number = status.rows_taken + group.y;
    let row = rows[ROWS] + number * rows[STRIDE];
    for (var k = thread; k < rows[OBSTACLE_COUNT]; k += GROUP) {
        set_obstacle(row + TOTALS + OF_OBSTACLE * k, k);
    }
    var own = 0.0;
    for (var k = thread; k < groups_of_water(status.particles); k += GROUP) {
        own += volumes[k];
    }
    let all = reduce_group(thread, own);
    if thread == 0u {
        set_pair(row, status.inflow);
        set_pair(row + 2u, status.outflow);
        set_number(row + STORED, all);
        set_number(row + SINCE, difference(due[number], status.clock));
    }
}

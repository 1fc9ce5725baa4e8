// Sums the force on each obstacle, one group of threads for each, and over time. Twin of `push_obstacles` in `flood/step.rs`.
#import flood_neighbours
#import flood_accounts
#import flood_done

@group(0) @binding(1) var<storage, read> status: Status;
@group(0) @binding(2) var<storage, read> start: array<u32>;
@group(0) @binding(3) var<storage, read> pushes: array<vec3f>;
@group(0) @binding(4) var<storage, read_write> obstacles: array<OnObstacle>;

var<workgroup> sums: array<vec2f, 256>;

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    let number = group.x;
    let low = cells_round(parameters.grid, obstacles[number].low, 0.0).xy;
    let high = cells_round(parameters.grid, obstacles[number].high, 0.0).xy;
    var sum = vec2f(0.0);
    for (var row = low.y; row <= high.y; row++) {
        let line = row * parameters.grid.columns;
        let end = min(start[line + high.x + 1u], status.particles);
        for (var i = start[line + low.x] + thread; i < end; i += 256u) {
            if u32(pushes[i].z) == number + 1u {
                sum += pushes[i].xy;
            }
        }
    }
    sums[thread] = sum;
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if thread < half {
            sums[thread] += sums[thread + half];
        }
        workgroupBarrier();
    }
    if thread == 0u && status.halted == GOING {
        // Over the step by its means at both ends, in scheme sph-swe by that at its end.
        let mean = select(0.5 * (obstacles[number].force + sums[0]), sums[0], parameters.scheme == SPH_SWE);
        var east = obstacles[number].impulse_east;
        var north = obstacles[number].impulse_north;
        add(&east, status.step * mean.x);
        add(&north, status.step * mean.y);
        obstacles[number].impulse_east = east;
        obstacles[number].impulse_north = north;
        obstacles[number].force = sums[0];
    }
}

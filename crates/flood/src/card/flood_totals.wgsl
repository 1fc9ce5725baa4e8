// What a row of gauges tells of all the water, of outflows and links, and of obstacles: one group for each row. Twin of `Model::gauge_row`.
#import flood_accounts
#import flood_done
#import flood_rows

@group(0) @binding(1) var<storage, read> status: Status;
// What the groups of `flood_volumes` have summed up.
@group(0) @binding(2) var<storage, read> volumes: array<vec2f>;
// Zones and structures: see `works.rs`.
@group(0) @binding(3) var<storage, read> works: array<u32>;
@group(0) @binding(4) var<storage, read> obstacles: array<OnObstacle>;
@group(0) @binding(5) var<storage, read> knocks: array<i32>;
// Times since the host last spoke at which rows are due, s.
@group(0) @binding(6) var<storage, read> due: array<f32>;
@group(0) @binding(7) var<storage, read_write> rows: array<u32>;

// Where `works` says where flows begin, numbers that each takes, and which is its discharge.
const FLOWS = 6u;
const FLOW = 4u;
const DISCHARGE = 2u;

var<workgroup> sums: array<vec2f, 256>;

fn tell(at: u32, number: f32) {
    rows[at] = bitcast<u32>(number);
}

fn tell_account(at: u32, account: Account) {
    tell(at, account.sum);
    tell(at + 1u, account.lacking);
}

fn tell_obstacle(at: u32, number: u32) {
    let obstacle = obstacles[number];
    tell(at, obstacle.force.x);
    tell(at + 1u, obstacle.force.y);
    tell_account(at + 2u, obstacle.impulse_east);
    tell_account(at + 4u, obstacle.impulse_north);
    rows[at + 6u] = bitcast<u32>(knocks[2u * number]);
    rows[at + 7u] = bitcast<u32>(knocks[2u * number + 1u]);
}

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    let number = status.rows_taken + group.y;
    let row = rows[ROWS] + number * rows[STRIDE];
    let flows = rows[FLOW_COUNT];
    for (var k = thread; k < flows; k += 256u) {
        rows[row + TOTALS + k] = works[works[FLOWS] + FLOW * k + DISCHARGE];
    }
    for (var k = thread; k < rows[OBSTACLE_COUNT]; k += 256u) {
        tell_obstacle(row + TOTALS + flows + OF_OBSTACLE * k, k);
    }
    var own = vec2f(0.0);
    for (var k = thread; k < groups_of_water(parameters, status.particles); k += 256u) {
        own += volumes[k];
    }
    sums[thread] = own;
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if thread < half {
            sums[thread] += sums[thread + half];
        }
        workgroupBarrier();
    }
    if thread == 0u {
        tell_account(row, status.inflow);
        tell_account(row + 2u, status.outflow);
        tell_account(row + 4u, status.rained);
        tell_account(row + 6u, status.infiltrated);
        tell(row + STORED, sums[0].x);
        tell(row + FILMS, sums[0].y);
        tell(row + SINCE, due[number] - (status.elapsed.sum - status.elapsed.lacking));
    }
}

// Samples the water at the positions of a row of gauges, at its time: a little after the last step. Twin of `SphSweFlood::reading`.
#import sph_water
#import sph_rows

@compute @workgroup_size(GAUGE_GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let number = id.x;
    if number >= status.gauge_positions {
        return;
    }
    let row = rows[ROWS] + (status.rows_taken + id.y) * rows[STRIDE];
    let at = POSITIONS + 2u * number;
    let position = vec2f(bitcast<f32>(rows[at]), bitcast<f32>(rows[at + 1u]));
    let water = water_later(position, bitcast<f32>(rows[row + SINCE]));
    let sample = row + TOTALS + OF_OBSTACLE * rows[OBSTACLE_COUNT] + OF_POSITION * number;
    rows[sample] = bitcast<u32>(water.x);
    rows[sample + 1u] = bitcast<u32>(water.y);
    rows[sample + 2u] = bitcast<u32>(water.z);
}

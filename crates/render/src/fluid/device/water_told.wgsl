// After the sort: how many particles there are on the ground and how many are drawn.
#import water_device

@group(0) @binding(0) var<uniform> water: Water;
@group(0) @binding(1) var<storage, read> start: array<u32>;
// See `water_begin`.
@group(0) @binding(2) var<storage, read_write> groups: array<u32>;

@compute @workgroup_size(1)
fn main() {
    let on_ground = (start[of_ground(water)] + 255u) / 256u;
    groups[12] = on_ground;
    groups[15] = on_ground;
    groups[18] = 4u;
    groups[19] = start[of_ground(water) + 1u];
    groups[20] = 0u;
    groups[21] = 0u;
    // For splats: groups of 128 threads, and how many are drawn.
    groups[22] = (groups[19] + 127u) / 128u;
    groups[23] = 1u;
    groups[24] = 1u;
    groups[25] = groups[19];
}

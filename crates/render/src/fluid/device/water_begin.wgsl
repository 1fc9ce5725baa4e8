// How many particles there are, and how many groups of threads the kernels after this one have.
#import water_device

@group(0) @binding(0) var<uniform> water: Water;
@group(0) @binding(1) var<storage, read> seen: DeviceParticles;
// Particles, cells, whether a height has changed, and the bits of the farthest reach at a border, m.
@group(0) @binding(2) var<storage, read_write> sizes: array<u32>;
// Slots of three numbers: a thread for each particle, a thread for each cell, a group for each block of 1024 cells, one group, a
// thread for each particle on the ground, the same while heights change. Then what is drawn: corners, particles, firsts. Then for splats.
@group(0) @binding(3) var<storage, read_write> groups: array<u32>;

@compute @workgroup_size(1)
fn main() {
    let particles = min(seen.count, water.room);
    let cells = of_ground(water) + 2u;
    sizes[0] = particles;
    sizes[1] = cells;
    sizes[2] = 0u;
    sizes[3] = 0u;
    let threads = (particles + 255u) / 256u;
    let counts = array(threads, (cells + 255u) / 256u, (cells + 1023u) / 1024u, 1u, threads, threads);
    for (var slot = 0u; slot < 6u; slot++) {
        groups[3u * slot] = counts[slot];
        groups[3u * slot + 1u] = 1u;
        groups[3u * slot + 2u] = 1u;
    }
}

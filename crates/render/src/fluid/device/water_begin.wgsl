// How many particles there are, and how many groups of threads the kernels after this one have.
#import water_device

@compute @workgroup_size(1)
fn main() {
    let particles = min(seen.count, water.room);
    let cells = of_ground(water) + 2u;
    sizes.particles = particles;
    sizes.cells = cells;
    atomicStore(&sizes.has_changed, 0u);
    atomicStore(&sizes.farthest, 0u);
    let threads = (particles + GROUP - 1u) / GROUP;
    let counts = array(threads, (cells + GROUP - 1u) / GROUP, (cells + SORT_BLOCK - 1u) / SORT_BLOCK, 1u, threads, threads);
    for (var slot = 0u; slot < 6u; slot++) {
        groups[3u * slot] = counts[slot];
        groups[3u * slot + 1u] = 1u;
        groups[3u * slot + 2u] = 1u;
    }
}

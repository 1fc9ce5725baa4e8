// After the sort: the numbers of particles on the ground and drawn, as arguments of indirect draws and dispatches.
#import water_device

@compute @workgroup_size(1)
fn main() {
    let on_ground = (start[of_ground(water)] + GROUP - 1u) / GROUP;
    groups[3u * ON_GROUND] = on_ground;
    groups[3u * SETTLING] = on_ground;
    groups[DRAW] = 4u;
    groups[DRAW + 1u] = start[of_ground(water) + 1u];
    groups[DRAW + 2u] = 0u;
    groups[DRAW + 3u] = 0u;
    // For splats: groups of threads, and how many are drawn.
    groups[SPLATS] = (groups[DRAW + 1u] + SPLAT_GROUP - 1u) / SPLAT_GROUP;
    groups[SPLATS + 1u] = 1u;
    groups[SPLATS + 2u] = 1u;
    groups[SPLAT_COUNT] = groups[DRAW + 1u];
}

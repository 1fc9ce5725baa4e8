// Boundary particles that fill the walls of obstacles: `obstacles/sites.rs`.
#import flood_columns

struct WallSite {
    place: vec2f,
    // Unit vector to the nearest wall, out of the obstacle.
    normal: vec2f,
    // Area of the obstacle that it stands for, m2.
    area: f32,
    obstacle: u32,
    // Its area as scheme sph-swe has it, m2.
    volume: f32,
    unused: f32,
}

// Most of a kernel that walls are taken to cover.
const MOST_COVERED = 0.8;

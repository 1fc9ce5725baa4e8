// What water does to obstacles.
#import flood_card

struct OnObstacle {
    // Corners of the rectangle in which particles may touch it, m.
    low: vec2f,
    high: vec2f,
    // Force now, over the density of water, m4/s2; its sum over time, m4/s, with what that lacks.
    force: vec2f,
    impulse_east: Account,
    impulse_north: Account,
    unused: vec2f,
}

// Rows of gauges as the host reads them: `gauges.rs` has the same. All numbers are words; first where rows begin and how far they are
// apart, then how many flows and obstacles they tell of, then the places that they look at.
#import flood_card

const ROWS = 0u;
const STRIDE = 1u;
const FLOW_COUNT = 2u;
const OBSTACLE_COUNT = 3u;
const PLACES = 4u;

// A row begins with four accounts, the water in all and that in films, m3, and how long after the last step it is due, s; then come flows,
// obstacles and places.
const STORED = 8u;
const FILMS = 9u;
const SINCE = 10u;
const TOTALS = 11u;

// Of an obstacle: force, impulse with what it lacks, and knocks.
const OF_OBSTACLE = 8u;

// Of a place: depth and velocity.
const OF_PLACE = 3u;

// Groups that sum up the water: a thread for each particle, drop and cell of the ground.
fn groups_of_water(parameters: Parameters, particles: u32) -> u32 {
    return (max(max(particles, parameters.in_air), parameters.patches.x * parameters.patches.y) + 255u) / 256u;
}

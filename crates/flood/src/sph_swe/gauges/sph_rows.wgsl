// Rows of gauges as the host reads them. All numbers of `rows` are words: where rows begin, how far they are apart and how many obstacles they have; then the
// positions that they sample; then the rows. A row begins with two accounts, what came in and went out, m3, each as a pair to be added, the water in all, m3, and
// how long after the last step it is due, s; then come the obstacles and the positions.
#import declared

// Groups that sum up the water: a thread for each particle and drop.
fn groups_of_water(count: u32) -> u32 {
    return (max(count, parameters.in_air) + GROUP - 1u) / GROUP;
}

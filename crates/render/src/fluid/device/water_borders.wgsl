// The nodes of the ground's four borders, one border after the other: south, north, west, east.
#import water_device

// What has moved to lie in the surface reaches farther from where it was by no more than this.
const OVER_REACH = 1.1;

fn border_nodes(water: Settings) -> u32 {
    return 2u * (water.ground_nodes.x + water.ground_nodes.y);
}

// Column and row of a node, and whether it has none after it on its border.
fn border_node(water: Settings, number: u32) -> vec3u {
    let nodes = water.ground_nodes;
    let is_upright = number >= 2u * nodes.x;
    let count = select(nodes.x, nodes.y, is_upright);
    let index = select(number, number - 2u * nodes.x, is_upright);
    let along = index % count;
    let across = select(0u, select(nodes.y, nodes.x, is_upright) - 1u, index >= count);
    return vec3u(select(vec2u(along, across), vec2u(across, along), is_upright), u32(along + 1u == count));
}

// Where a node is, m.
fn node_position(water: Settings, node: vec2u) -> vec2f {
    return water.ground_corner + vec2f(node) / water.ground_per_metre;
}

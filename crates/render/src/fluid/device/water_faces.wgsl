// Upright faces between the nodes of borders, from the ground to the water's level: two triangles each. Twin of `WaterSides::face`.
#import water_borders

fn corner(node: vec2u, level: f32, is_low: bool) -> vec4f {
    let ground = min(water.unit * heights[node.y * water.ground_nodes.x + node.x], level);
    let position = water.unit * node_position(water, node);
    return vec4f(position, select(level, ground, is_low), select(0.0, level - ground, is_low));
}

fn outwards(number: u32) -> vec4f {
    let nodes = water.ground_nodes;
    if number < 2u * nodes.x {
        return vec4f(0.0, select(-1.0, 1.0, number >= nodes.x), 0.0, 0.0);
    }
    return vec4f(select(-1.0, 1.0, number >= 2u * nodes.x + nodes.y), 0.0, 0.0, 0.0);
}

@compute @workgroup_size(BORDER_GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let number = id.x;
    if number >= border_nodes(water) {
        return;
    }
    let node = border_node(water, number);
    let is_last = node.z == 1u;
    let next = select(number + 1u, number, is_last);
    let other = border_node(water, next).xy;
    let own_level = levels[number];
    let next_level = levels[next];
    // Where there is no face, all corners are one.
    let is_there = !is_last && own_level < NO_HEIGHT && next_level < NO_HEIGHT;
    let ends = array(
        corner(node.xy, own_level, false),
        corner(other, next_level, false),
        corner(node.xy, own_level, true),
        corner(node.xy, own_level, true),
        corner(other, next_level, false),
        corner(other, next_level, true),
    );
    for (var k = 0u; k < 6u; k++) {
        vertices[6u * number + k] = Vertex(select(vec4f(0.0), ends[k], is_there), outwards(number));
    }
}

// Slopes of wet cells: least squares over the neighbours. See `slopes` in `reconstruction/mod.rs`.
#import declared
#import time_steps
#import voronoi_differences

// Difference of the velocity to that of the mirror image behind a wall.
fn mirrored(link: Link, velocity: vec2f) -> vec2f {
    return -2.0 * dot(velocity, link.normal) / dot(link.normal, link.normal) * link.normal;
}

// Differences of depth, level and velocity.
fn difference_to(link: Link, here: Water) -> vec4f {
    if link.neighbour == NONE {
        return vec4f(0.0, 0.0, mirrored(link, here.velocity));
    }
    let there = water[link.neighbour];
    // Next to no water has no velocity that counts.
    let velocity = min(there.depth / THIN, 1.0) * (there.velocity - here.velocity);
    return vec4f(differences(here, there, link.rise), velocity);
}

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= parameters.cells || !is_seen(id.x) {
        return;
    }
    let here = water[id.x];
    if here.depth <= 0.0 {
        return;
    }
    var found = Slopes(vec4f(0.0), vec4f(0.0));
    for (var number = ground[id.x].first_link; number < ground[id.x].end_link; number++) {
        let link = links[number];
        if any(link.gradient != vec2f(0.0)) {
            let change = difference_to(link, here);
            found.x += link.gradient.x * change;
            found.y += link.gradient.y * change;
        }
    }
    slopes[id.x] = found;
}

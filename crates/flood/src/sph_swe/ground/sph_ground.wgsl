// The ground: bicubic Hermite patches between nodes of height, slope along y, slope along x and twist, per cell. Twin of `surface/mod.rs`
// in the crate terrain.
#import declared

// Weights of (left value, right value, left slope, right slope) at t, and their derivatives.
fn hermite(t: f32) -> mat2x4f {
    let s = 1.0 - t;
    let right = t * t * (3.0 - 2.0 * t);
    let rise = 6.0 * t * s;
    return mat2x4f(
        vec4f(1.0 - right, right, t * s * s, -t * t * s),
        vec4f(-rise, rise, s * (1.0 - 3.0 * t), t * (3.0 * t - 2.0)),
    );
}

// Value and slope along y between two nodes of a row.
fn between(weights: vec4f, west: vec4f, east: vec4f) -> vec2f {
    return weights.x * west.xy + weights.y * east.xy + weights.z * west.zw + weights.w * east.zw;
}

// Height and slope at a position; outside the bounds those of the nearest position inside.
fn ground_at(position: vec2f) -> vec3f {
    let most = vec2f(parameters.ground_patches);
    let inside = clamp(position, parameters.bounds.xz, parameters.bounds.yw);
    let at = clamp((inside - parameters.ground_corner) * parameters.ground_per_metre, vec2f(0.0), most);
    let patch_at = min(vec2u(at), parameters.ground_patches - 1u);
    let t = at - vec2f(patch_at);
    let columns = parameters.ground_patches.x + 1u;
    let first = patch_at.y * columns + patch_at.x;
    let south_west = nodes[first];
    let south_east = nodes[first + 1u];
    let north_west = nodes[first + columns];
    let north_east = nodes[first + columns + 1u];
    let across = hermite(t.x);
    let up = hermite(t.y);
    let south = between(across[0], south_west, south_east);
    let north = between(across[0], north_west, north_east);
    let south_dx = between(across[1], south_west, south_east);
    let north_dx = between(across[1], north_west, north_east);
    let height = dot(up[0], vec4f(south.x, north.x, south.y, north.y));
    let slope_x = dot(up[0], vec4f(south_dx.x, north_dx.x, south_dx.y, north_dx.y));
    let slope_y = dot(up[1], vec4f(south.x, north.x, south.y, north.y));
    return vec3f(height, vec2f(slope_x, slope_y) * parameters.ground_per_metre);
}

// The same, but beyond an edge the ground goes on as it falls towards it, and never rises. Twin of `Surroundings::find_ground`.
fn ground_under(position: vec2f) -> vec3f {
    var ground = ground_at(position);
    let beyond = position - clamp(position, parameters.bounds.xz, parameters.bounds.yw);
    let fall = min(ground.yz * beyond, vec2f(0.0));
    ground.x += fall.x + fall.y;
    return ground;
}

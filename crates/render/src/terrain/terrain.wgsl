// The ground: tiles of a height field, coarser far away, with skirts that hide where two of them meet.
#import light

@group(1) @binding(0) var<uniform> ground: Ground;
@group(1) @binding(1) var heights: texture_2d<f32>;
@group(1) @binding(2) var slopes: texture_2d<f32>;
@group(1) @binding(3) var colours: texture_2d<f32>;
@group(1) @binding(4) var smooth_sampler: sampler;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) place: vec3f,
    @location(1) uv: vec2f,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32, @location(0) tile: vec4u) -> Corner {
    let side = QUADS + 1u;
    var at = vec2u(index % side, index / side);
    var sunk = 0.0;
    if index >= side * side {
        // The skirt: four sides of the tile once more, lower.
        let along = (index - side * side) % side;
        let edge = (index - side * side) / side;
        at = select(vec2u(along, select(0u, QUADS, edge == 1u)), vec2u(select(0u, QUADS, edge == 3u), along), edge >= 2u);
        sunk = select(1.0, 0.0, tile.z == 1u);
    }
    let node = min(tile.xy + at * tile.z, ground.nodes.xy - 1u);
    let height = textureLoad(heights, node, 0).r;
    let skirt = sunk * f32(tile.z) * 1.5 * max(ground.cell.x, ground.cell.y);
    let place = vec3f(ground.origin.xy + vec2f(node) * ground.cell.xy, height - skirt);
    // Middles of texels are the nodes.
    let uv = (vec2f(node) + 0.5) / vec2f(ground.nodes.xy);
    return Corner(view.clip_from_world * vec4f(place, 1.0), place, uv);
}

// A number from 0 to 1 for a place (Hoskins, "Hash without sine").
fn scattered(place: vec3f) -> f32 {
    let bent = fract(place * 0.1031);
    let turned = bent + dot(bent, bent.zyx + 31.32);
    return fract((turned.x + turned.y) * turned.z);
}

// Smooth noise from 0 to 1 with bumps of length 1. In space, so that it is not drawn out where the ground is steep.
fn bumps(place: vec3f) -> f32 {
    let cell = floor(place);
    let part = smoothstep(vec3f(0.0), vec3f(1.0), place - cell);
    var along = array(0.0, 0.0, 0.0, 0.0);
    for (var k = 0u; k < 4u; k++) {
        let corner = cell + vec3f(0.0, f32(k % 2u), f32(k / 2u));
        along[k] = mix(scattered(corner), scattered(corner + vec3f(1.0, 0.0, 0.0)), part.x);
    }
    return mix(mix(along[0], along[1], part.y), mix(along[2], along[3], part.y), part.z);
}

// Steeper than this no ground is: a quad whose corners have no height is marked so.
const NO_GROUND: f32 = 50.0;

@fragment
fn fragment(corner: Corner) -> @location(0) vec4f {
    let found = textureSampleLevel(colours, smooth_sampler, corner.uv, 0.0);
    if found.a < 0.5 {
        discard;
    }
    let slope = textureSampleLevel(slopes, smooth_sampler, corner.uv, 0.0).rg;
    if slope.x > NO_GROUND {
        discard;
    }
    let normal = normalize(vec3f(-slope, 1.0));
    let shine = sunshine(corner.place, normal, corner.clip.xy);
    // Grain finer than the cells, as far as pixels show it.
    let cells = (corner.place - vec3f(ground.origin.xy, 0.0)) / ground.cell.x;
    let fine = clamp(ground.cell.x / pixel_at(corner.place) / 8.0 - 0.25, 0.0, 1.0);
    let grain = 1.0 + ground.cell.w * fine * (bumps(cells * 3.1) + bumps(cells * 7.3) - 1.0);
    return vec4f(matt(found.rgb * grain, normal, shine), 1.0);
}

// The same without shadows and grain.
@fragment
fn fragment_plain(corner: Corner) -> @location(0) vec4f {
    let found = textureSampleLevel(colours, smooth_sampler, corner.uv, 0.0);
    let slope = textureSampleLevel(slopes, smooth_sampler, corner.uv, 0.0).rg;
    if found.a < 0.5 || slope.x > NO_GROUND {
        discard;
    }
    return vec4f(matt(found.rgb, normalize(vec3f(-slope, 1.0)), 1.0), 1.0);
}

@fragment
fn throw_shadow(corner: Corner) {
    let missing = textureSampleLevel(slopes, smooth_sampler, corner.uv, 0.0).r > NO_GROUND;
    if missing || textureSampleLevel(colours, smooth_sampler, corner.uv, 0.0).a < 0.5 {
        discard;
    }
}

// The ground: tiles of a height field, coarser far away, with skirts that hide where two of them meet.
#import light
#import noise

@group(1) @binding(0) var<uniform> ground: Ground;
@group(1) @binding(1) var heights: texture_2d<f32>;
@group(1) @binding(2) var slopes: texture_2d<f32>;
@group(1) @binding(3) var colours: texture_2d<f32>;
@group(1) @binding(4) var smooth_sampler: sampler;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) uv: vec2f,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32, tile: TileInstance) -> Corner {
    let side = QUADS + 1u;
    var at = vec2u(index % side, index / side);
    var sunk = 0.0;
    if index >= side * side {
        // The skirt: four sides of the tile once more, lower.
        let along = (index - side * side) % side;
        let edge = (index - side * side) / side;
        at = select(vec2u(along, select(0u, QUADS, edge == 1u)), vec2u(select(0u, QUADS, edge == 3u), along), edge >= 2u);
        sunk = select(1.0, 0.0, tile.stride == 1u);
    }
    let node = min(tile.first + at * tile.stride, ground.nodes.xy - 1u);
    let height = textureLoad(heights, node, 0).r;
    let skirt = sunk * f32(tile.stride) * 1.5 * max(ground.cell.x, ground.cell.y);
    let position = vec3f(ground.origin.xy + vec2f(node) * ground.cell.xy, height - skirt);
    // Middles of texels are the nodes.
    let uv = (vec2f(node) + 0.5) / vec2f(ground.nodes.xy);
    return Corner(view.clip_from_world * vec4f(position, 1.0), position, uv);
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
    let smooth_normal = normalize(vec3f(-slope, 1.0));
    if ground.cell.w == 0.0 {
        return vec4f(hazed(matt(found.rgb, smooth_normal, sunshine(corner.position, smooth_normal, corner.clip.xy)), corner.position), 1.0);
    }
    let own = natural(corner.position, found.rgb, length(slope), smooth_normal);
    let shine = sunshine(corner.position, smooth_normal, corner.clip.xy);
    return vec4f(hazed(matt(own.colour, own.normal, shine), corner.position), 1.0);
}

// Bare rock and earth, linear: the grain within cells, whose own colours are those of `natural.rs`.
const BARE_ROCK: vec3f = vec3f(0.23, 0.20, 0.165);
const EARTH: vec3f = vec3f(0.145, 0.115, 0.06);
// Slopes at which rock begins to show and from which there is nothing else.
const ROCKY_SLOPES: vec2f = vec2f(0.5, 1.0);
// Octaves of the grain, the longest of which is so many cells long.
const OCTAVES: i32 = 6;
const LONGEST: f32 = 6.0;

// What the ground is made of at a position.
struct Matter {
    colour: vec3f,
    normal: vec3f,
}

// Natural ground of a colour: patches of another green and bare earth, rock where it is steep, and grain as fine as pixels show it.
fn natural(position: vec3f, colour: vec3f, steepness: f32, smooth_normal: vec3f) -> Matter {
    let pixel = pixel_at(position);
    var length = LONGEST * ground.cell.x;
    var tilt = vec3f(0.0);
    // Of long and of short octaves, about 0.
    var patches = 0.0;
    var grain = 0.0;
    for (var octave = 0; octave < OCTAVES; octave++) {
        let seen = clamp(length / pixel / 3.0 - 0.6, 0.0, 1.0);
        if seen > 0.0 {
            let found = bumps_in_space((position - vec3f(ground.origin.xy, 0.0)) / length + 17.0 * f32(octave));
            tilt += seen * found.xyz;
            let about = seen * (found.w - 0.5);
            patches += select(0.0, about, octave < 3);
            grain += select(about, 0.0, octave < 2);
        }
        length *= 0.45;
    }
    let green = colour * (1.0 + ground.cell.w * grain) * mix(vec3f(1.12, 1.02, 0.86), vec3f(0.80, 0.94, 0.82), smoothstep(-0.5, 0.5, patches));
    // Where patches and grain agree the turf is worn.
    let bare = smoothstep(0.50, 0.90, patches + 0.6 * grain);
    let grown = mix(green, EARTH * (1.0 + grain), 0.75 * bare);
    let rocky = smoothstep(ROCKY_SLOPES.x, ROCKY_SLOPES.y, steepness + 0.35 * patches + 0.25 * grain);
    let strength = mix(0.09, 0.22, rocky);
    let normal = normalize(smooth_normal - strength * (tilt - dot(tilt, smooth_normal) * smooth_normal));
    return Matter(mix(grown, BARE_ROCK * (1.0 + 0.9 * grain), rocky), normal);
}

// The same without shadows and grain.
@fragment
fn fragment_plain(corner: Corner) -> @location(0) vec4f {
    let found = textureSampleLevel(colours, smooth_sampler, corner.uv, 0.0);
    let slope = textureSampleLevel(slopes, smooth_sampler, corner.uv, 0.0).rg;
    if found.a < 0.5 || slope.x > NO_GROUND {
        discard;
    }
    return vec4f(hazed(matt(found.rgb, normalize(vec3f(-slope, 1.0)), 1.0), corner.position), 1.0);
}

@fragment
fn throw_shadow(corner: Corner) {
    let missing = textureSampleLevel(slopes, smooth_sampler, corner.uv, 0.0).r > NO_GROUND;
    if missing || textureSampleLevel(colours, smooth_sampler, corner.uv, 0.0).a < 0.5 {
        discard;
    }
}

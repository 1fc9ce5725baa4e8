// What water mirrors: hills and buildings where the line of sight that is thrown back meets them in the picture, the sky where it does not
// (McGuire and Mara, "Efficient GPU Screen-Space Ray Tracing", 2014, with steps that grow).
#import sky

// What is behind the water: its picture, and its depth.
@group(1) @binding(4) var behind_colour: texture_2d<f32>;
@group(1) @binding(5) var behind_depth: texture_depth_2d;
@group(1) @binding(6) var linear: sampler;

const MIRROR_STEPS: i32 = 28;
// First step and growth of the steps, stage units.
const FIRST_STEP: f32 = 0.004;
const GROWTH: f32 = 1.18;

// Where a position is in the picture behind: uv, and depth.
fn in_picture(position: vec3f) -> vec3f {
    let clip = view.clip_from_world * vec4f(position, 1.0);
    return vec3f(clip.xy / clip.w * vec2f(0.5, -0.5) + 0.5, select(-1.0, clip.z / clip.w, clip.w > 0.0));
}

// Light from a direction on a position.
fn mirrored_light(position: vec3f, direction: vec3f) -> vec3f {
    let sky = surroundings(direction);
    var along = FIRST_STEP;
    var step = FIRST_STEP;
    for (var k = 0; k < MIRROR_STEPS; k++) {
        let there = position + along * direction;
        let seen = in_picture(there);
        if any(seen.xy <= vec2f(0.0)) || any(seen.xy >= vec2f(1.0)) || seen.z <= 0.0 {
            return sky;
        }
        let found = textureLoad(behind_depth, vec2i(seen.xy * view.frame.xy), 0);
        // Depth is greater the nearer it is.
        if found > seen.z {
            let met = world_at_pixel(seen.xy * view.frame.xy, found);
            // Behind what is nearer by more than a step the line of sight goes on.
            if length(met - there) < 1.5 * step {
                let inside = min(min(seen.x, 1.0 - seen.x), min(seen.y, 1.0 - seen.y));
                let light = textureSampleLevel(behind_colour, linear, seen.xy, 0.0).rgb;
                return mix(sky, light, smoothstep(0.0, 0.08, inside));
            }
        }
        step *= GROWTH;
        along += step;
    }
    return sky;
}

// Fogged glass: what is behind is scattered, so it blurs and whitens by the area that droplets cover.
#import sky
#import full_screen

@group(1) @binding(0) var covered: texture_2d<f32>;
@group(1) @binding(1) var behind: texture_2d<f32>;
@group(1) @binding(2) var behind_sampler: sampler;

const TAPS: i32 = 48;
// Radius of the blur behind dense fog, part of the picture's height, and the part of light that comes back from it.
const BLUR: f32 = 0.045;
const WHITE: f32 = 0.42;

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let area = textureLoad(covered, vec2i(pixel.xy), 0).r;
    if area < 0.002 {
        discard;
    }
    // Droplets do not overlap: they merge where they touch.
    let part = min(area, 1.0);
    let uv = pixel.xy / view.frame.xy;
    let radius = BLUR * sqrt(part) * vec2f(view.frame.y / view.frame.x, 1.0);
    var blurred = vec3f(0.0);
    for (var tap = 0; tap < TAPS; tap++) {
        let angle = GOLDEN_ANGLE * f32(tap);
        let out = sqrt((f32(tap) + 0.5) / f32(TAPS)) * vec2f(cos(angle), sin(angle));
        blurred += textureSampleLevel(behind, behind_sampler, clamp(uv + radius * out, vec2f(0.0), vec2f(1.0)), 0.0).rgb;
    }
    let all_round = view.sunlight.w * mix(view.horizon.rgb, view.above.rgb, 0.5) + 0.12 * view.sunlight.rgb;
    let sharp = textureSampleLevel(behind, behind_sampler, uv, 0.0).rgb;
    return vec4f(mix(sharp, mix(blurred / f32(TAPS), all_round, WHITE), part), 1.0);
}

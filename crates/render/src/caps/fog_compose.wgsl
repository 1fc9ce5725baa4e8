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

// A colour with its opacity multiplied in.
fn weighed(colour: vec4f) -> vec4f {
    return vec4f(colour.a * colour.rgb, colour.a);
}

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
    // With their opacities multiplied in: what is left out of the background weighs nothing.
    var blurred = vec4f(0.0);
    for (var tap = 0; tap < TAPS; tap++) {
        let angle = GOLDEN_ANGLE * f32(tap);
        let out = sqrt((f32(tap) + 0.5) / f32(TAPS)) * vec2f(cos(angle), sin(angle));
        blurred += weighed(textureSampleLevel(behind, behind_sampler, clamp(uv + radius * out, vec2f(0.0), vec2f(1.0)), 0.0));
    }
    let all_round = view.sunlight.w * mix(view.horizon.rgb, view.above.rgb, 0.5) + 0.12 * view.sunlight.rgb;
    let sharp = weighed(textureSampleLevel(behind, behind_sampler, uv, 0.0));
    let seen = mix(sharp, mix(blurred / f32(TAPS), vec4f(all_round, 1.0), WHITE), part);
    return vec4f(seen.rgb / max(seen.a, 1e-6), seen.a);
}

// Light on matt and shiny surfaces, with the sun's shadows.
#import sky

const SHADOW_TAPS: i32 = 16;
// The same on what shows shadows less.
const FEW_SHADOW_TAPS: i32 = 6;

// A number from 0 to 1 that differs from pixel to pixel (interleaved gradient noise: Jimenez, SIGGRAPH 2014 course).
fn noise(pixel: vec2f) -> f32 {
    return fract(52.9829189 * fract(dot(pixel, vec2f(0.06711056, 0.00583715))));
}

// The part of the sun that a position sees. The edge of a shadow is as wide as the sun is seen over a typical distance; taps on
// a spiral turned from pixel to pixel.
fn sunshine(position: vec3f, normal: vec3f, pixel: vec2f) -> f32 {
    return sunshine_by(SHADOW_TAPS, position, normal, pixel);
}

fn sunshine_by(taps: i32, position: vec3f, normal: vec3f, pixel: vec2f) -> f32 {
    // A map of one pixel stands for none: nothing throws shadows.
    if textureDimensions(sun_depth).x == 1u {
        return 1.0;
    }
    let texel = 2.04 / f32(textureDimensions(sun_depth).x);
    let slant = clamp(dot(normal, view.sun.xyz), 0.0, 1.0);
    // Moved off the surface by as much as a texel's slant hides.
    let lifted = position + normal * texel * (1.5 + 2.0 * (1.0 - slant));
    let seen = view.sun_from_world * vec4f(lifted, 1.0);
    let uv = seen.xy * vec2f(0.5, -0.5) + 0.5;
    if any(uv < vec2f(0.0)) || any(uv > vec2f(1.0)) {
        return 1.0;
    }
    let radius = max(0.08 * view.sun.w, 1.0 / f32(textureDimensions(sun_depth).x));
    let turn = 2.0 * PI * noise(pixel);
    var lit = 0.0;
    for (var tap = 0; tap < taps; tap++) {
        let angle = turn + GOLDEN_ANGLE * f32(tap);
        let out = radius * sqrt((f32(tap) + 0.5) / f32(taps));
        // Farther from the middle the surface may rise towards the sun.
        // Beyond the map's far end (0) all that was drawn is nearer to the sun.
        let reference = max(seen.z + 0.5 * out * sqrt(1.0 - slant * slant) / max(slant, 0.2), 0.0);
        lit += textureSampleCompareLevel(sun_depth, sun_compare, uv + out * vec2f(cos(angle), sin(angle)), reference);
    }
    return lit / f32(taps);
}

// Distance over which air leaves 1/e of the light of what is seen through it, m: a visual range of 100 km, of clear mountain air, by
// Koschmieder's 3.912 = range over this distance (1924).
const CLEAR_AIR: f32 = 25600.0;

// Light from a position as it comes through the air, which adds light of its own. The air begins where what is drawn does, at the sphere of one
// unit round it: a camera stands so far off only to see all of it.
fn hazed(light: vec3f, position: vec3f) -> vec3f {
    let before = max(length(view.eye.xyz) - 1.0, 0.0);
    let through = max(length(position - view.eye.xyz) - before, 0.0);
    let left = exp(-through * view.frame.z / CLEAR_AIR);
    // Indoors there is none, and a map is seen from straight above.
    return select(mix(view.horizon.rgb, light, left), light, (view.frame.w > 0.5) | (view.eye.w < 0.5));
}

// Light that a matt surface of a colour gives back.
fn matt(colour: vec3f, normal: vec3f, shine: f32) -> vec3f {
    return matt_turned(colour, dot(normal, view.sun.xyz), normal.z, shine);
}

// The same by the cosines of its normal to the sun and upwards.
fn matt_turned(colour: vec3f, to_sun: f32, upwards: f32, shine: f32) -> vec3f {
    let sun = view.sunlight.rgb * max(to_sun, 0.0) * shine;
    return colour * (sun / PI * 2.0 + light_from_all_round(upwards));
}

// Part of light that a smooth surface mirrors, by the cosine of the angle of incidence (Schlick, Computer Graphics Forum 13,
// 1994, 3, eq. 15).
fn mirrored(cosine: f32, straight: f32) -> f32 {
    return straight + (1.0 - straight) * pow(1.0 - clamp(cosine, 0.0, 1.0), 5.0);
}

// Light that a surface of a colour under a clear coat gives back.
fn coated(colour: vec3f, normal: vec3f, to_eye: vec3f, shine: f32, gloss: f32) -> vec3f {
    let back = reflect(-to_eye, normal);
    let fresnel = mirrored(dot(normal, to_eye), 0.04) * gloss;
    let half_way = normalize(view.sun.xyz + to_eye);
    let spark = pow(max(dot(normal, half_way), 0.0), 90.0) * 2.2 * gloss * shine;
    return matt(colour, normal, shine) * (1.0 - fresnel) + surroundings(back) * fresnel + spark * view.sunlight.rgb * 0.35;
}

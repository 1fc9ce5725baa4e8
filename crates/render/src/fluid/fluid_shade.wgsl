// Colour of the fluid: C = a (1 - F) + b F + k_s (n.h)^alpha (flood paper of 2021), a what is seen through it, weakened by its
// thickness, b what it mirrors, F Fresnel's part, and the sun's highlight after Phong; foam over it. Water that flows has ripples.
#import fluid
#import light
#import ripples
#import mirror
#import wetness

@group(1) @binding(1) var distances: texture_2d<f32>;
@group(1) @binding(2) var normals: texture_2d<u32>;
@group(1) @binding(3) var thickness: texture_2d<f32>;
// Colour; 0 in the last where there is nothing to draw.
@group(1) @binding(7) var shaded: texture_storage_2d<rgba16float, write>;
@group(1) @binding(8) var flow: texture_2d<f32>;

// Refractive index of air over that of water, and what water mirrors of light that falls straight on it.
const AIR_OVER_WATER_INDEX: f32 = 1.0 / 1.333;
const STRAIGHT: f32 = 0.02;
// Light that a bed gives back that is out of sight.
const BED: vec3f = vec3f(0.16, 0.15, 0.09);
// How well particles cover a position in closed water: a sum of poly6 weights.
const CLOSED_COVER: f32 = 3.1;
// How well they cover a position (halfway out of a straight shore 1.5) where water begins to be seen, and where
// nothing else is: shores follow this, not the rims of discs.
const SHORE: vec2f = vec2f(0.35, 0.65);
// Speeds at which ripples begin to be seen and from which they are steepest, m/s.
const RIPPLED: vec2f = vec2f(0.02, 2.0);
// Less than this of the light mirrored is not looked up in the picture.
const LEAST_MIRRORED: f32 = 0.03;

fn unfold(packed: u32) -> vec3f {
    let flat = unpack2x16snorm(packed);
    let up = 1.0 - abs(flat.x) - abs(flat.y);
    let signs = select(vec2f(-1.0), vec2f(1.0), flat >= vec2f(0.0));
    return normalize(vec3f(select((1.0 - abs(flat.yx)) * signs, flat, up >= 0.0), up));
}

// What is behind the surface in the direction of the refracted light, where its way in water ends; 1 in the last where that is ground in the picture.
fn seen_through(pixel: vec2i, position: vec3f, way: vec3f) -> vec4f {
    let straight = (vec2f(pixel) + 0.5) / view.frame.xy;
    // Where the ground is cut off, so is the view.
    let end = vec3f(clamp(position.xy + way.xy, fluid.within.xy, fluid.within.zw), position.z + way.z);
    let clip = view.clip_from_world * vec4f(end, 1.0);
    let bent = clip.xy / clip.w * vec2f(0.5, -0.5) + 0.5;
    let inside = all(bent > vec2f(0.0)) && all(bent < vec2f(1.0));
    let at = vec2i(bent * view.frame.xy);
    // What stands before the water is not seen through it.
    let nearer = inside && textureLoad(behind_depth, clamp(at, vec2i(0), vec2i(view.frame.xy) - 1), 0) > depth_at(position);
    let uv = select(straight, bent, inside && !nearer);
    // Past the end of the ground one would look into the water's far side, which is not drawn: its bed stands for it.
    let depth = textureLoad(behind_depth, clamp(vec2i(uv * view.frame.xy), vec2i(0), vec2i(view.frame.xy) - 1), 0);
    let met = world_at_pixel(uv * view.frame.xy, max(depth, 1e-6)).xy;
    let past = any(met < fluid.within.xy) || any(met > fluid.within.zw);
    let light = select(textureSampleLevel(behind_colour, linear, uv, 0.0).rgb, BED, past);
    return vec4f(light, select(1.0, 0.0, past || depth == 0.0));
}

// Water in the line of sight, m. Beyond the border of what is drawn there are no particles whose share could be added.
fn whole_thickness(matter: vec4f, position: vec3f) -> f32 {
    let inside = min(position.xy - fluid.within.xy, fluid.within.zw - position.xy);
    let beside = 1.0 - smoothstep(0.0, 2.0 * fluid.smoothing.x, min(inside.x, inside.y));
    return matter.r * mix(1.0, clamp(CLOSED_COVER / max(matter.a, 0.1), 1.0, 4.0), beside);
}

@compute @workgroup_size(PIXELS_ACROSS, PIXELS_DOWN)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let pixel = vec2i(id.xy);
    if any(pixel >= vec2i(textureDimensions(distances))) {
        return;
    }
    let distance = textureLoad(distances, pixel, 0).r;
    let position = position_at(pixel, distance);
    if distance == 0.0 || textureLoad(behind_depth, pixel, 0) > depth_at(position) {
        textureStore(shaded, pixel, vec4f(0.0));
        return;
    }
    let uv = (vec2f(pixel) + 0.5) / view.frame.xy;
    let matter = textureSampleLevel(thickness, linear, uv, 0.0);
    let covered = smoothstep(SHORE.x, SHORE.y, matter.a);
    let ground_depth = textureLoad(behind_depth, pixel, 0);
    var damp = smoothstep(0.01, 0.5 * SHORE.x, matter.a);
    if covered < 1.0 && ground_depth > 0.0 {
        damp = max(damp, wetness(world_at_pixel(vec2f(pixel) + 0.5, ground_depth)));
    }
    let beside = textureLoad(behind_colour, pixel, 0).rgb * (1.0 - WET * damp);
    let velocity = textureSampleLevel(flow, linear, uv, 0.0).xy / max(matter.a, 1e-3);
    let patterns = carried(position.xy, velocity / view.frame.z);
    let moving = smoothstep(RIPPLED.x, RIPPLED.y, length(velocity));
    let pixel_here = pixel_at(position);
    let smooth_normal = unfold(textureLoad(normals, pixel, 0).r);
    let to_eye = towards_eye(position);
    var normal = smooth_normal;
    if moving * fluid.ripples.y > 0.0 {
        // Seen at a grazing angle the sides of ripples that face away are hidden.
        let facing = clamp(2.5 * dot(smooth_normal, to_eye), 0.0, 1.0);
        let slope = fluid.ripples.y * moving * facing * ripples(patterns, pixel_here);
        normal = normalize(smooth_normal - vec3f(slope, 0.0));
    }
    let cosine = clamp(dot(normal, to_eye), 0.0, 1.0);
    let water = whole_thickness(matter, position);
    // A film so thin that it does not close is not seen.
    let closed = smoothstep(0.0, fluid.surface.y, water * cosine);

    let refracted = refract(-to_eye, normal, AIR_OVER_WATER_INDEX);
    let steep = max(-dot(refracted, normal), 0.1);
    let path = water * cosine / steep;
    let shine = sunshine_by(FEW_SHADOW_TAPS, position, normal, vec2f(pixel));
    let seen = seen_through(pixel, position, refracted * path / view.frame.z);
    var ground = seen.rgb;
    // Waves gather light on the bed where the water is neither a film nor deep.
    let gathered = shine * sqrt(moving) * (1.0 - exp(-8.0 * path)) * exp(-1.2 * path);
    if select(0.0, gathered, fluid.ripples.y > 0.0) > 0.01 {
        let bed = carried(position.xy + refracted.xy * path / view.frame.z, velocity / view.frame.z);
        ground *= 1.0 + 0.6 * gathered * caustics(bed, pixel_here);
    }
    // The light that the ground gives back came through the water too.
    let down = max(dot(refract(-view.sun.xyz, normal, AIR_OVER_WATER_INDEX), -normal), 0.3);
    let left = exp(-fluid.absorption.rgb * (path + path * steep / down));
    let daylight = view.sunlight.rgb * max(dot(normal, view.sun.xyz), 0.0) * shine * 0.4 + light_from_all_round(normal.z);
    // Where water is so thin that all light goes through, its bed is as dark as wet ground beside it.
    let bed_seen = ground * left * (1.0 - WET * seen.a * left);
    let inner = bed_seen + fluid.colour.rgb * daylight * (1.0 - left);

    let fresnel = mirrored(cosine, STRAIGHT) * closed;
    let back = reflect(-to_eye, normal);
    let upwards = normalize(vec3f(back.xy, abs(back.z)));
    var mirror = surroundings(upwards);
    if fresnel > LEAST_MIRRORED {
        mirror = mirrored_light(position, upwards);
    }
    let half_way = normalize(view.sun.xyz + to_eye);
    let highlight = fluid.colour.w * pow(max(dot(normal, half_way), 0.0), fluid.surface.x) * shine * closed;
    var colour = inner * (1.0 - fresnel) + mirror * fresnel + highlight * view.sunlight.rgb;

    let foam = 1.0 - exp(-fluid.absorption.w * matter.g / max(matter.b, 1e-6));
    if foam > 0.01 {
        let white = lace(patterns, foam, pixel_here);
        colour = mix(colour, matt(vec3f(0.9), normal, shine), clamp(white * closed, 0.0, 0.95));
    }
    colour = hazed(colour, position);
    textureStore(shaded, pixel, vec4f(mix(beside, colour, covered), 1.0));
}

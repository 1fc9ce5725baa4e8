// Normals of the smoothed surface, from the differences of positions to the neighbouring pixels.
#import fluid

@group(1) @binding(1) var distances: texture_2d<f32>;
// Two numbers of 16 bits each, see unfold(); 0x80008000, which no direction has, where there is no fluid.
@group(1) @binding(2) var normals: texture_storage_2d<r32uint, write>;

// The difference to a neighbour; none where there is no fluid.
fn difference(pixel: vec2i, step: vec2i, here: vec3f, distance: f32) -> vec4f {
    let at = pixel + step;
    if any(at < vec2i(0)) || any(at >= vec2i(textureDimensions(distances))) {
        return vec4f(0.0, 0.0, 0.0, 1e9);
    }
    let there = textureLoad(distances, at, 0).r;
    if there == 0.0 {
        return vec4f(0.0, 0.0, 0.0, 1e9);
    }
    return vec4f(position_at(at, there) - here, abs(there - distance));
}

// The slope along an axis: from both sides, or from the one whose distance differs less where the other is beyond an edge.
fn slope(pixel: vec2i, step: vec2i, here: vec3f, distance: f32) -> vec3f {
    let after = difference(pixel, step, here, distance);
    let before = difference(pixel, -step, here, distance);
    let edge = fluid.smoothing.y;
    if max(after.w, before.w) < edge {
        return after.xyz - before.xyz;
    }
    return select(-before.xyz, after.xyz, after.w < before.w);
}

// A direction as two numbers (octahedral: Meyer et al. 2010).
fn fold(normal: vec3f) -> u32 {
    let flat = normal / (abs(normal.x) + abs(normal.y) + abs(normal.z));
    let signs = select(vec2f(-1.0), vec2f(1.0), flat.xy >= vec2f(0.0));
    return pack2x16snorm(select((1.0 - abs(flat.yx)) * signs, flat.xy, flat.z >= 0.0));
}

@compute @workgroup_size(PIXELS_ACROSS, PIXELS_DOWN)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let pixel = vec2i(id.xy);
    if any(pixel >= vec2i(textureDimensions(distances))) {
        return;
    }
    let distance = textureLoad(distances, pixel, 0).r;
    if distance == 0.0 {
        textureStore(normals, pixel, vec4u(0x80008000u));
        return;
    }
    let here = position_at(pixel, distance);
    let across = slope(pixel, vec2i(1, 0), here, distance);
    let down = slope(pixel, vec2i(0, 1), here, distance);
    let product = cross(down, across);
    let towards = towards_eye(here);
    // A lone pixel faces the eye.
    let normal = select(towards, normalize(product), dot(product, product) > 0.0);
    textureStore(normals, pixel, vec4u(fold(select(-normal, normal, dot(normal, towards) > 0.0))));
}

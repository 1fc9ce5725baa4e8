// Bindings of the filters of depth: they read distances, 0 where there is no fluid, and write them.
#import fluid

@group(1) @binding(1) var distances: texture_2d<f32>;
@group(1) @binding(2) var smoothed: texture_storage_2d<r32float, write>;
@group(1) @binding(3) var<uniform> direction: Direction;

fn distance_at(pixel: vec2i) -> f32 {
    let last = vec2i(textureDimensions(distances)) - 1;
    if any(pixel < vec2i(0)) || any(pixel > last) {
        return 0.0;
    }
    return textureLoad(distances, pixel, 0).r;
}

fn gauss(offset: f32, sigma: f32) -> f32 {
    return exp(-0.5 * offset * offset / (sigma * sigma));
}

// Bindings of the passes over pixels.
#import view

@group(1) @binding(0) var<uniform> fluid: FluidUniforms;

// Height of a pixel at a distance.
fn pixel_size(distance: f32) -> f32 {
    return view.forward.w * select(1.0, max(distance, 1e-4), view.eye.w > 0.5);
}

// The position at a distance, along the picture's middle line of sight, in a pixel.
fn position_at(pixel: vec2i, distance: f32) -> vec3f {
    let away = (vec2f(pixel) + 0.5 - 0.5 * view.frame.xy) * pixel_size(distance);
    let right = view.world_from_view[0].xyz;
    let up = view.world_from_view[1].xyz;
    return view.eye.xyz + distance * view.forward.xyz + away.x * right - away.y * up;
}

// Radius of the smoothing at a distance, pixels.
fn width_in_pixels(distance: f32) -> i32 {
    return i32(clamp(fluid.smoothing.x / pixel_size(distance), 1.0, fluid.smoothing.w));
}

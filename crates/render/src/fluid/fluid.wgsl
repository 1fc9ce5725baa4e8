// What the passes over pixels know of the fluid (settings.rs).
#import view

struct Fluid {
    // Part of light that is lost in a metre of water (1/m); density of foam that hides what is below.
    absorption: vec4f,
    // Light that deep water gives back in full light; strength of the sun's highlight.
    colour: vec4f,
    // Half the width of the smoothing, how far depths may part, what is farther is taken for (stage units); most pixels.
    smoothing: vec4f,
    // Exponent of the highlight; depth over which a film begins to be seen, m.
    surface: vec4f,
    // West, south, east and north end of what is drawn.
    within: vec4f,
}

@group(1) @binding(0) var<uniform> fluid: Fluid;

// The place at a distance, along the picture's middle line of sight, in a pixel.
fn place_at(pixel: vec2i, distance: f32) -> vec3f {
    let ray = ray_at_pixel(vec2f(pixel) + 0.5);
    return ray.origin + ray.direction * (distance - dot(ray.origin - view.eye.xyz, view.forward.xyz))
        / dot(ray.direction, view.forward.xyz);
}

// Height of a pixel at a distance.
fn pixel_size(distance: f32) -> f32 {
    return view.forward.w * select(1.0, max(distance, 1e-4), view.eye.w > 0.5);
}

// How many pixels smoothing looks to each side at a distance.
fn width_in_pixels(distance: f32) -> i32 {
    return i32(clamp(fluid.smoothing.x / pixel_size(distance), 1.0, fluid.smoothing.w));
}

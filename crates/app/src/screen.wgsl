// Lays a picture into its place in the window, pixel by pixel.

@group(0) @binding(0) var picture: texture_2d<f32>;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) at: vec2f,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Corner {
    // One triangle that covers the place.
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    return Corner(vec4f(4.0 * corner - 1.0, 0.0, 1.0), vec2f(2.0 * corner.x, 1.0 - 2.0 * corner.y));
}

fn pixel(at: vec2f) -> vec3f {
    let size = vec2f(textureDimensions(picture));
    return textureLoad(picture, vec2u(clamp(at * size, vec2f(0.0), size - 1.0)), 0).rgb;
}

@fragment
fn fragment(corner: Corner) -> @location(0) vec4f {
    return vec4f(pixel(corner.at), 1.0);
}

// The same for a window that takes linear light (IEC 61966-2-1).
@fragment
fn fragment_linear(corner: Corner) -> @location(0) vec4f {
    let bytes = pixel(corner.at);
    let linear = select(pow((bytes + 0.055) / 1.055, vec3f(2.4)), bytes / 12.92, bytes <= vec3f(0.04045));
    return vec4f(linear, 1.0);
}

// Lays a picture into its part of a window, pixel by pixel. What is the same for a whole pass is said when the pipeline is made:
// software in place of a GPU would compute both sides of a choice.
#import declared
#import press

// Highlights are pressed; the window takes linear light.
override pressed: bool = false;
override linear: bool = false;

@group(0) @binding(0) var picture: texture_2d<f32>;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) at: vec2f,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Corner {
    // One triangle that covers the part.
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    return Corner(vec4f(4.0 * corner - 1.0, 0.0, 1.0), vec2f(2.0 * corner.x, 1.0 - 2.0 * corner.y));
}

fn pixel(at: vec2f) -> vec3f {
    let size = vec2f(textureDimensions(picture));
    return textureLoad(picture, vec2u(clamp(at * size, vec2f(0.0), size - 1.0)), 0).rgb;
}

// Linear light of sRGB (IEC 61966-2-1).
fn decode(bytes: vec3f) -> vec3f {
    return select(pow((bytes + SRGB_OFFSET) / SRGB_SCALE, vec3f(SRGB_EXPONENT)), bytes / SRGB_SLOPE, bytes <= vec3f(SRGB_LINE_END));
}

// A finished picture.
@fragment
fn fragment_finished(corner: Corner) -> @location(0) vec4f {
    let bytes = pixel(corner.at);
    return vec4f(select(bytes, decode(bytes), linear), 1.0);
}

// sRGB bytes of linear light by square roots alone, a quarter of the work of powers: within 0.1 of 255 of IEC 61966-2-1 (least greatest
// error of these four terms; a test holds it).
fn encode_quickly(colour: vec3f) -> vec3f {
    let root = sqrt(colour);
    let high = 0.8337642 * root + 0.2980988 * sqrt(root) - 0.0553211 * colour - 0.0769015;
    return select(high, SRGB_SLOPE * colour, colour <= vec3f(SRGB_LINE_END_LINEAR));
}

// Linear light with one sample a pixel.
@fragment
fn fragment_light(corner: Corner) -> @location(0) vec4f {
    let sample = max(pixel(corner.at), vec3f(0.0));
    let colour = select(min(sample, vec3f(1.0)), press(sample), pressed);
    return vec4f(select(encode_quickly(colour), colour, linear), 1.0);
}

// Shades the balls whose numbers were drawn, each pixel once.
#import ball

@group(2) @binding(0) var numbers: texture_2d<u32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    return vec4f(4.0 * corner - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> Drawn {
    let number = textureLoad(numbers, vec2i(pixel.xy), 0).r;
    if number == 0u {
        discard;
    }
    let sight = ray_at_pixel(pixel.xy);
    let found = hit(sight, sphere(number - 1u));
    return shaded(found, colour_of(number - 1u), sight, pixel.xy);
}

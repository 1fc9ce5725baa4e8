// Shades the balls whose numbers were drawn, each pixel once.
#import ball
#import full_screen

@group(2) @binding(0) var numbers: texture_2d<u32>;

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

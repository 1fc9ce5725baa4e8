// Draws the backdrop over the whole target.
#import sky
#import full_screen

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    return vec4f(sky(ray_at_pixel(pixel.xy).direction), 1.0);
}

// Puts the shaded fluid into the picture, with its depth.
#import fluid
#import full_screen

@group(1) @binding(1) var distances: texture_2d<f32>;
@group(1) @binding(2) var shaded: texture_2d<f32>;

@fragment
fn fragment(@builtin(position) at: vec4f) -> Drawn {
    let pixel = vec2i(at.xy);
    let colour = textureLoad(shaded, pixel, 0);
    if colour.a == 0.0 {
        discard;
    }
    return Drawn(vec4f(colour.rgb, 1.0), depth_at(place_at(pixel, textureLoad(distances, pixel, 0).r)));
}

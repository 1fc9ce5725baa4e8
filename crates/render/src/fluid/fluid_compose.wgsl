// Puts the shaded fluid into the picture, with its depth, and darkens ground beside it that is wet.
#import fluid
#import full_screen
#import wetness

@group(1) @binding(1) var distances: texture_2d<f32>;
@group(1) @binding(2) var shaded: texture_2d<f32>;
@group(1) @binding(3) var behind_colour: texture_2d<f32>;
@group(1) @binding(4) var behind_depth: texture_depth_2d;

// Less is not seen.
const LEAST_DARKER: f32 = 0.004;

@fragment
fn fragment(@builtin(position) at: vec4f) -> Drawn {
    let pixel = vec2i(at.xy);
    let colour = textureLoad(shaded, pixel, 0);
    if colour.a == 0.0 {
        let depth = textureLoad(behind_depth, pixel, 0);
        if depth == 0.0 {
            discard;
        }
        let darker = WET * wetness(world_at_pixel(at.xy, depth));
        if darker < LEAST_DARKER {
            discard;
        }
        return Drawn(vec4f(textureLoad(behind_colour, pixel, 0).rgb * (1.0 - darker), 1.0), depth);
    }
    return Drawn(vec4f(colour.rgb, 1.0), depth_at(position_at(pixel, textureLoad(distances, pixel, 0).r)));
}

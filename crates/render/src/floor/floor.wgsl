// A floor in the colours of the backdrop, visible only by the shadows on it.
#import light
#import full_screen

@group(1) @binding(0) var<uniform> plane: Floor;

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> Drawn {
    let sight = ray_at_pixel(pixel.xy);
    let distance = (plane.height - sight.origin.z) / sight.direction.z;
    if distance <= 0.0 || sight.direction.z >= 0.0 {
        discard;
    }
    let position = sight.origin + distance * sight.direction;
    let shine = sunshine(position, vec3f(0.0, 0.0, 1.0), pixel.xy);
    let shadow = 1.0 - plane.darkness * (1.0 - shine);
    return Drawn(vec4f(surroundings(sight.direction) * shadow, 1.0), depth_at(position));
}

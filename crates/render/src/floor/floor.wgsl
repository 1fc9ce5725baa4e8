// A floor that cannot be told from the backdrop but by the shadows on it.
#import light

@group(1) @binding(0) var<uniform> plane: Floor;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    return vec4f(4.0 * corner - 1.0, 0.0, 1.0);
}

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> Drawn {
    let sight = ray_at_pixel(pixel.xy);
    let distance = (plane.height - sight.origin.z) / sight.direction.z;
    if distance <= 0.0 || sight.direction.z >= 0.0 {
        discard;
    }
    let place = sight.origin + distance * sight.direction;
    let shine = sunshine(place, vec3f(0.0, 0.0, 1.0), pixel.xy);
    let shadow = 1.0 - plane.darkness * (1.0 - shine);
    return Drawn(vec4f(surroundings(sight.direction) * shadow, 1.0), depth_at(place));
}

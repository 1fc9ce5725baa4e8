// Solids as meshes: matt and coated. Buildings have roofs and windows.
#import light
#import surface

@group(1) @binding(0) var<uniform> style: SolidUniforms;

// Height of a storey and distance of windows, m; the middle of a window in its field, and half its size, parts of the field.
const FIELD: vec2f = vec2f(2.8, 3.0);
const MIDDLE: vec2f = vec2f(0.5, 0.52);
const HALF: vec2f = vec2f(0.21, 0.25);
// Light that a room gives back through its window.
const PANE: vec3f = vec3f(0.03, 0.04, 0.05);

// How much of a pixel at a position on a wall a window covers.
fn window_at(position: vec3f, normal: vec3f) -> f32 {
    let along = vec2f(dot(position.xy, normalize(vec2f(-normal.y, normal.x))), position.z) * view.frame.z / FIELD;
    let pixel = pixel_at(position) * view.frame.z / FIELD;
    // Smaller than some pixels they are a grey wall.
    let seen = clamp(0.5 / max(pixel.x, pixel.y) / 2.5 - 0.6, 0.0, 1.0);
    let away = abs(fract(along) - MIDDLE) - HALF;
    let inside = clamp(0.5 - away / max(pixel, vec2f(1e-6)), vec2f(0.0), vec2f(1.0));
    return mix(4.0 * HALF.x * HALF.y, inside.x * inside.y, seen);
}

@fragment
fn fragment(corner: Corner) -> @location(0) vec4f {
    let to_eye = towards_eye(corner.position);
    var normal = normalize(corner.normal);
    normal = select(-normal, normal, dot(normal, to_eye) > 0.0);
    let shine = sunshine(corner.position, normal, corner.clip.xy);
    let is_building = style.roof.w > 0.5;
    let is_roof = is_building & (normal.z > 0.5);
    let colour = select(style.colour.rgb, style.roof.rgb, is_roof);
    var light = coated(colour, normal, to_eye, shine, style.gloss.x);
    if is_building & (abs(normal.z) < 0.3) {
        let mirror = surroundings(reflect(-to_eye, normal)) * mirrored(dot(normal, to_eye), 0.08);
        light = mix(light, PANE + mirror, window_at(corner.position, normal));
    }
    return vec4f(hazed(light, corner.position), 1.0);
}

@fragment
fn throw_shadow(corner: Corner) {
}

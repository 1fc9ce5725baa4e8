// Solids as meshes: matt and coated.
#import light

struct Style {
    colour: vec4f,
    // Part of light that the coat mirrors.
    gloss: vec4f,
}

@group(1) @binding(0) var<uniform> style: Style;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) place: vec3f,
    @location(1) normal: vec3f,
}

@vertex
fn vertex(@location(0) place: vec4f, @location(1) normal: vec4f) -> Corner {
    return Corner(view.clip_from_world * vec4f(place.xyz, 1.0), place.xyz, normal.xyz);
}

@fragment
fn fragment(corner: Corner) -> @location(0) vec4f {
    let to_eye = towards_eye(corner.place);
    var normal = normalize(corner.normal);
    normal = select(-normal, normal, dot(normal, to_eye) > 0.0);
    let shine = sunshine(corner.place, normal, corner.clip.xy);
    return vec4f(coated(style.colour.rgb, normal, to_eye, shine, style.gloss.x), 1.0);
}

@fragment
fn throw_shadow(corner: Corner) {
}

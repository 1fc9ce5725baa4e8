// Solids as meshes: matt and coated.
#import light
#import surface

@group(1) @binding(0) var<uniform> style: SolidUniforms;

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

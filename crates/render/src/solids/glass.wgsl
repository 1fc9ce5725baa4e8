// Solids of glass: what is behind is seen through them, shifted as by a slab, and what is before is mirrored. Where the background is left out they are as
// opaque as they keep light back, and where they shine.
#import light
#import surface

@group(1) @binding(0) var<uniform> style: SolidUniforms;
@group(2) @binding(0) var behind: texture_2d<f32>;
@group(2) @binding(1) var behind_sampler: sampler;

@fragment
fn fragment(corner: Corner) -> @location(0) vec4f {
    let to_eye = towards_eye(corner.position);
    let normal = normalize(corner.normal);
    let facing = dot(normal, to_eye);
    if facing <= 0.0 {
        discard;
    }
    // Bent towards the normal, then on for a slab's thickness; seen where that meets the picture.
    let bent = refract(-to_eye, normal, 1.0 / 1.5);
    let shifted = corner.position + (bent + to_eye) * 0.03;
    let clip = view.clip_from_world * vec4f(shifted, 1.0);
    let uv = clip.xy / clip.w * vec2f(0.5, -0.5) + 0.5;
    let seen = textureSampleLevel(behind, behind_sampler, clamp(uv, vec2f(0.0), vec2f(1.0)), 0.0);
    // Two surfaces mirror; longer ways through the edge take more light (Beer).
    let fresnel = min(2.0 * mirrored(facing, 0.04), 0.9);
    let through = pow(style.colour.rgb, vec3f(1.0 / max(facing, 0.15)));
    let half_way = normalize(view.sun.xyz + to_eye);
    let spark = 1.5 * pow(max(dot(normal, half_way), 0.0), 220.0);
    let passed = through * (1.0 - fresnel);
    let colour = seen.a * seen.rgb * passed + surroundings(reflect(-to_eye, normal)) * fresnel + spark * view.sunlight.rgb;
    // One opacity for all colours: of the light from behind that is kept back. No colour is brighter than its opacity: a highlight hides what is behind.
    let kept_back = 1.0 - (1.0 - seen.a) * dot(passed, vec3f(1.0 / 3.0));
    let opacity = clamp(max(kept_back, max(colour.r, max(colour.g, colour.b))), 1e-3, 1.0);
    return vec4f(colour / opacity, opacity);
}

// The faces that are seen from within: depth alone.
@fragment
fn far_side(corner: Corner) {
    if dot(corner.normal, towards_eye(corner.position)) > 0.0 {
        discard;
    }
}

// Solids of glass: what is behind is seen through them, shifted as by a slab, and what is before is mirrored.
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
    let seen = textureSampleLevel(behind, behind_sampler, clamp(uv, vec2f(0.0), vec2f(1.0)), 0.0).rgb;
    // Two surfaces mirror; longer ways through the edge take more light (Beer).
    let fresnel = min(2.0 * mirrored(facing, 0.04), 0.9);
    let through = pow(style.colour.rgb, vec3f(1.0 / max(facing, 0.15)));
    let half_way = normalize(view.sun.xyz + to_eye);
    let spark = 1.5 * pow(max(dot(normal, half_way), 0.0), 220.0);
    let colour = seen * through * (1.0 - fresnel) + surroundings(reflect(-to_eye, normal)) * fresnel;
    return vec4f(colour + spark * view.sunlight.rgb, 1.0);
}

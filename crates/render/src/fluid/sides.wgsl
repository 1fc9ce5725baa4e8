// Upright faces of water, cut off where the ground is.
#import light
#import cut

@fragment
fn fragment(corner: Corner) -> @location(0) vec4f {
    let to_eye = towards_eye(corner.position);
    // Those on the far side would be seen through the water.
    if dot(corner.normal, to_eye) < 0.0 {
        discard;
    }
    // Light comes from above and is lost on its way down.
    let left = exp(-vec3f(0.5, 0.22, 0.16) * corner.deep * view.frame.z);
    let colour = mix(vec3f(0.02, 0.075, 0.10), vec3f(0.16, 0.36, 0.38), left);
    let fresnel = 0.6 * mirrored(dot(corner.normal, to_eye), 0.02);
    let lit = matt(colour, vec3f(0.0, 0.0, 1.0), 0.8);
    return vec4f(mix(lit, surroundings(reflect(-to_eye, corner.normal)), fresnel), 1.0);
}

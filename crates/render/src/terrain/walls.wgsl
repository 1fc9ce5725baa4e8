// The sides of the block of ground, cut upright.
#import light
#import cut

@fragment
fn fragment(corner: Corner) -> @location(0) vec4f {
    let shine = sunshine(corner.position, corner.normal, corner.clip.xy);
    // Turf, then earth, paler with depth.
    let earth = mix(vec3f(0.16, 0.115, 0.075), vec3f(0.30, 0.25, 0.20), smoothstep(0.0, 0.12, corner.deep));
    let turf = 1.0 - smoothstep(0.002, 0.006, corner.deep);
    return vec4f(hazed(matt(mix(earth, vec3f(0.10, 0.13, 0.05), turf), corner.normal, shine), corner.position), 1.0);
}

@fragment
fn throw_shadow(corner: Corner) {
}

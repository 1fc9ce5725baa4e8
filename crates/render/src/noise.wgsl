// Smooth noise in space.

// A number from 0 to 1 for a place (Hoskins, "Hash without sine").
fn scattered_in_space(place: vec3f) -> f32 {
    let bent = fract(place * 0.1031);
    let turned = bent + dot(bent, bent.zyx + 31.32);
    return fract((turned.x + turned.y) * turned.z);
}

// Noise from 0 to 1 with bumps of length 1, and its slope along the three axes.
fn bumps_in_space(place: vec3f) -> vec4f {
    let cell = floor(place);
    let part = place - cell;
    let blend = part * part * (3.0 - 2.0 * part);
    let change = 6.0 * part * (1.0 - part);
    var corners = array(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for (var k = 0u; k < 8u; k++) {
        corners[k] = scattered_in_space(cell + vec3f(f32(k & 1u), f32((k >> 1u) & 1u), f32(k >> 2u)));
    }
    let along = mix(
        vec4f(corners[0], corners[2], corners[4], corners[6]),
        vec4f(corners[1], corners[3], corners[5], corners[7]),
        blend.x,
    );
    let rise = vec4f(corners[1] - corners[0], corners[3] - corners[2], corners[5] - corners[4], corners[7] - corners[6]);
    let planes = mix(along.xz, along.yw, blend.y);
    let east = mix(mix(rise.x, rise.y, blend.y), mix(rise.z, rise.w, blend.y), blend.z);
    let north = mix(along.y - along.x, along.w - along.z, blend.z);
    let slope = change * vec3f(east, north, planes.y - planes.x);
    return vec4f(slope, mix(planes.x, planes.y, blend.z));
}

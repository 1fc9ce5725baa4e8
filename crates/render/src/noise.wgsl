// Numbers that look random and smooth noise made of them, in the plane and in space (Hoskins, "Hash without sine", 2014).

// A number from 0 to 1 for a position in the plane.
fn scattered(at: vec2f) -> f32 {
    let bent = fract(at.xyx * 0.1031);
    let turned = bent + dot(bent, bent.yzx + 33.33);
    return fract((turned.x + turned.y) * turned.z);
}

// Smooth noise from 0 to 1 with bumps of length 1, and its slope.
struct Bumps {
    height: f32,
    slope: vec2f,
}

fn bumps(at: vec2f) -> Bumps {
    let cell = floor(at);
    let part = at - cell;
    // Smooth to the second derivative (Perlin, "Improving Noise", 2002).
    let blend = part * part * part * (part * (part * 6.0 - 15.0) + 10.0);
    let change = 30.0 * part * part * (part * (part - 2.0) + 1.0);
    let low = vec2f(scattered(cell), scattered(cell + vec2f(1.0, 0.0)));
    let high = vec2f(scattered(cell + vec2f(0.0, 1.0)), scattered(cell + vec2f(1.0, 1.0)));
    let rows = mix(low, high, blend.y);
    let columns = mix(vec2f(low.x, high.x), vec2f(low.y, high.y), blend.x);
    return Bumps(mix(rows.x, rows.y, blend.x), change * vec2f(rows.y - rows.x, columns.y - columns.x));
}

// Three numbers from 0 to 1 for a position in the plane.
fn three_scattered(at: vec2f) -> vec3f {
    var mixed = fract(at.xyx * vec3f(0.1031, 0.1030, 0.0973));
    mixed += dot(mixed, mixed.yxz + 33.33);
    return fract((mixed.xxy + mixed.yzz) * mixed.zyx);
}

// A number from 0 to 1 for a position in space.
fn scattered_in_space(position: vec3f) -> f32 {
    let bent = fract(position * 0.1031);
    let turned = bent + dot(bent, bent.zyx + 31.32);
    return fract((turned.x + turned.y) * turned.z);
}

// Noise from 0 to 1 with bumps of length 1, and its slope along the three axes.
fn bumps_in_space(position: vec3f) -> vec4f {
    let cell = floor(position);
    let part = position - cell;
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

// What the kernels of humid air share: numbers of the run, particles of air, and what the host learns of a step.
#import declared
#import compensated_sums

fn unpacked(packed: Packed) -> Particle {
    let a = packed.position_and_density;
    let b = packed.velocity_and_fog;
    let c = packed.acceleration_and_deposit;
    let d = packed.spreading_and_id;
    let e = packed.temperature_and_vapour;
    let f = packed.role_and_idle;
    let spreading = bitcast<vec3f>(d.xyz);
    return Particle(
        a.xyz, a.w, b.xyz, b.w, c.xyz, c.w, spreading, d.w, e.xy, e.zw, f.x, bitcast<f32>(f.y), vec2f(0.0)
    );
}

fn packed(particle: Particle) -> Packed {
    return Packed(
        vec4f(particle.position, particle.density),
        vec4f(particle.velocity, particle.fog),
        vec4f(particle.acceleration, particle.deposit),
        vec4u(bitcast<vec3u>(particle.spreading), particle.id),
        vec4f(particle.temperature, particle.vapour),
        vec4u(particle.role, bitcast<u32>(particle.idle), 0u, 0u),
    );
}

// What neighbours read of a particle; its pressure over the square of the density, Pa m6/kg2.
struct Column {
    position: vec3f,
    pressure: f32,
    velocity: vec3f,
    temperature: f32,
    // By which the Laplacian is exact where particles stand as they do: xx, yy, zz and, doubled, xy, xz, yz.
    diagonal: vec3f,
    vapour: f32,
    doubled: vec3f,
    // What of the vapour diffuses: its part of the mass, or relative humidity.
    humidity: f32,
}

fn unpacked_column(packed: PackedColumn) -> Column {
    let a = packed.position_and_pressure;
    let b = packed.velocity_and_temperature;
    let c = packed.diagonal_and_vapour;
    let d = packed.doubled_and_humidity;
    return Column(a.xyz, a.w, b.xyz, b.w, c.xyz, c.w, d.xyz, d.w);
}

// e^T Q e of a tensor of a column for an offset. Twin of `factor` in `normalisation/mod.rs`.
fn factor(diagonal: vec3f, doubled: vec3f, offset: vec3f) -> f32 {
    let across = offset.xxy * offset.yzz;
    return (dot(diagonal, offset * offset) + dot(doubled, across)) / max(dot(offset, offset), 1e-30);
}

// Temperature from that at which the air's properties are as uploaded, K.
fn from_reference(temperature: f32) -> f32 {
    return temperature - parameters.reference;
}

fn face(number: u32) -> u32 {
    return parameters.faces[number / 4u][number % 4u];
}

// A coordinate beyond a side, mirrored at it, but not beyond the opposite side. Twin of `Room::mirrored_inside`.
fn mirrored_inside(at: f32, number: u32) -> f32 {
    let low = parameters.low[number / 2u];
    let high = parameters.high[number / 2u];
    // The largest number below the high side.
    let last = bitcast<f32>(bitcast<u32>(high) - 1u);
    return clamp(2.0 * select(high, low, number % 2u == 0u) - at, low, last);
}

fn is_set(flag: u32) -> bool {
    return (parameters.flags & flag) != 0u;
}

// Adds four numbers (Kahan 1965).
fn add_four(sums: FourSums, values: vec4f) -> FourSums {
    let more = values + sums.errors;
    let sum = opaque_four(sums.values + more);
    return FourSums(sum, more - opaque_four(sum - sums.values));
}

fn opaque_four(numbers: vec4f) -> vec4f {
    return bitcast<vec4f>(bitcast<vec4u>(numbers) ^ vec4u(parameters.zero));
}

// Particles of a model as whoever draws them finds them on the device. Twin of `particles.rs`.

struct DeviceParticle {
    // From the origin, m.
    place: vec3f,
    // Distance to its neighbours, m.
    spacing: f32,
    // m/s.
    velocity: vec3f,
    // Of the water under it, m; 0 in the air.
    depth: f32,
    // m3; 0 where there is no particle.
    volume: f32,
    id: u32,
    // Of air, degrees C.
    temperature: f32,
    unused: u32,
}

struct DeviceParticles {
    count: u32,
    unused_a: u32,
    unused_b: u32,
    unused_c: u32,
    all: array<DeviceParticle>,
}

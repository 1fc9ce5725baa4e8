// Brings the air into the order of its cells; parcels in the last cell, which have gone, are out of the count. Twin of
// `Arrangement::arrange`.
#import dew_card

@group(0) @binding(1) var<storage, read_write> status: Status;
@group(0) @binding(2) var<storage, read> start: array<u32>;
@group(0) @binding(3) var<storage, read> order: array<u32>;
@group(0) @binding(4) var<storage, read> particles: array<Particle>;
@group(0) @binding(5) var<storage, read_write> ordered: array<Particle>;
@group(0) @binding(6) var<storage, read_write> spots: array<vec4f>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    let staying = start[status.cells - 1u];
    if i < staying {
        let particle = particles[order[i]];
        ordered[i] = particle;
        spots[i] = vec4f(particle.place, 0.0);
    }
    if i == 0u {
        status.particles = staying;
    }
}

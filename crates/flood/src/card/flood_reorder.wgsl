// Brings the particles into the order of their cells, with the smoothing lengths that they have come to need; those in the last cell,
// which have left, are out of the count.
#import flood_card

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read_write> status: Status;
@group(0) @binding(2) var<storage, read> start: array<u32>;
@group(0) @binding(3) var<storage, read> order: array<u32>;
@group(0) @binding(4) var<storage, read> particles: array<Packed>;
@group(0) @binding(5) var<storage, read_write> sorted: array<Packed>;
// Place, weight (in scheme sph-swe volume) and reach of each.
@group(0) @binding(6) var<storage, read_write> sites: array<vec4f>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    let left = start[status.cells - 1u];
    if i < left {
        var particle = unpacked(particles[order[i]]);
        // Where nothing moves, particles are only laid out anew.
        if status.step > 0.0 {
            particle.h = particle.next_h;
        }
        sorted[i] = packed(particle);
        let weight = select(particle.weight, particle.volume, parameters.scheme == SPH_SWE);
        sites[i] = vec4f(particle.place, weight, parameters.reach_over_h * particle.h);
    }
    if i == 0u {
        status.particles = left;
    }
}

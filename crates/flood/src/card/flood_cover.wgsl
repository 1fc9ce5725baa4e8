// The area that the particles in each cell of the ground stand for. Twin of `Ground::covered` in `rain.rs`.
#import flood_wetness

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> status: Status;
@group(0) @binding(2) var<storage, read> particles: array<Particle>;
@group(0) @binding(3) var<storage, read_write> tallies: array<atomic<u32>>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= status.particles {
        return;
    }
    let particle = particles[id.x];
    if is_rained_on(particle) {
        let part = min(particle.volume / (particle.depth * parameters.patch_area), WIDEST);
        atomicAdd(&tallies[2u * patch_of(parameters, particle.place)], u32(round(part * AREA)));
    }
}

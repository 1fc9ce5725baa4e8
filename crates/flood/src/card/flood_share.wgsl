// Gives particles their part of what rains on their cell, and takes theirs of what soaks in. Twin of `Ground::share` in `rain.rs`.
#import flood_wetness

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> status: Status;
@group(0) @binding(2) var<storage, read_write> particles: array<Particle>;
@group(0) @binding(3) var<storage, read> ground: array<Patch>;
@group(0) @binding(4) var<storage, read_write> tallies: array<atomic<u32>>;
@group(0) @binding(5) var<storage, read_write> sums: array<vec4f>;

// A particle that has lost all but this share of its water to the ground is gone.
const DRAINED = 1e-6;

var<workgroup> of_threads: array<vec3f, 256>;

// What a particle gains and loses, m3, and the momentum over density that goes with what it loses, m4/s.
fn shared_out(i: u32) -> vec3f {
    var particle = particles[i];
    if !is_rained_on(particle) {
        return vec3f(0.0);
    }
    let cell = patch_of(parameters, particle.place);
    let area = particle.volume / particle.depth;
    let before = particle.volume;
    let full = before + area * ground[cell].gain;
    let demand = area * ground[cell].demand;
    let left = select(0.0, full - demand, demand < (1.0 - DRAINED) * full);
    let drunk = full - left;
    particle.velocity *= before / full;
    particle.volume = left;
    particle.weight *= left / before;
    particles[i] = particle;
    if drunk > 0.0 {
        atomicAdd(&tallies[2u * cell + 1u], u32(round(min(drunk / parameters.patch_area, DEEPEST) * DEPTH)));
    }
    return vec3f(full - before, drunk, drunk * (particle.velocity.x + particle.velocity.y));
}

@compute @workgroup_size(256)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    of_threads[thread] = vec3f(0.0);
    if id.x < status.particles {
        of_threads[thread] = shared_out(id.x);
    }
    workgroupBarrier();
    for (var half = 128u; half > 0u; half /= 2u) {
        if thread < half {
            of_threads[thread] += of_threads[thread + half];
        }
        workgroupBarrier();
    }
    if thread == 0u {
        let groups_of_cells = (parameters.patches.x * parameters.patches.y + 255u) / 256u;
        sums[groups_of_cells + group.x] = vec4f(of_threads[0], 0.0);
    }
}

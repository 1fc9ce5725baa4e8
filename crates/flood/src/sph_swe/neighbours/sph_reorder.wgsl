// Sorts the particles by their cells, with their new smoothing lengths; those in the last cell, which have left, are
// out of the count.
#import sph_common

@compute @workgroup_size(GROUP)
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
        spots[i] = vec4f(particle.position, particle.volume, particle.h);
    }
    if i == 0u {
        status.particles = left;
    }
}

// Sorts the air by its cells; particles in the last cell, which have left, are not counted. Twin of
// `Arrangement::arrange`. Air outside open sides gets its velocity. Twin of `move_outside` in `faces/open.rs`.
#import dew_columns

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    let staying = start[status.cells - 1u];
    if i < staying {
        var particle = unpacked(particles[order[i]]);
        if (particle.role & ROLE_MASK) == OUTSIDE {
            let number = particle.role >> FACE_BITS;
            particle.velocity = vec3f(0.0);
            particle.velocity[number / 2u] = outside_columns[column_of(number, particle.position)].velocity;
            particle.acceleration = vec3f(0.0);
            particle.spreading = vec3f(0.0);
        }
        ordered[i] = packed(particle);
        spots[i] = vec4f(particle.position, 0.0);
    }
    if i == 0u {
        status.particles = staying;
    }
}

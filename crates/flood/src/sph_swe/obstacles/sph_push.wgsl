// The push of boundary particles on each particle. Twin of `push_of_walls` and `add_walls` in `push.rs`.
#import sph_common
#import sph_neighbours
#import sph_kernels

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= status.particles {
        return;
    }
    let own = columns[i];
    var push = vec2f(0.0);
    var obstacle = 0u;
    if is_near(parameters.walls, own.position, own.h) {
        // a = -sum_k rho0 V_k (p_i / rho_i^2) grad W_ik (Akinci et al. 2012, equation 9).
        let strength = parameters.rest_density * own.pressure / (own.density * own.density);
        var nearest = own.h;
        let cells = cells_round(parameters.walls, own.position, own.h);
        for (var row = cells.y; row <= cells.w; row++) {
            let line = row * parameters.walls.columns;
            for (var k = site_start[line + cells.x]; k < site_start[line + cells.z + 1u]; k++) {
                let way = sites[k].position - own.position;
                let r = length(way);
                if r >= own.h {
                    continue;
                }
                push -= strength * sites[k].volume * kernel_slope(r, own.h) / max(r, 1e-9 * own.h) * way;
                if r < nearest {
                    nearest = r;
                    obstacle = sites[k].obstacle + 1u;
                }
            }
        }
    }
    var particle = unpacked(sorted[i]);
    particle.acceleration = push;
    sorted[i] = packed(particle);
    let of_inside = select(0u, obstacle, particle.outside == 0u);
    pushes[i] = vec4f(-particle.volume * push, f32(of_inside), 0.0);
}

// The push of boundary particles on each particle in scheme sph-swe. Twin of `push_of_walls` and `add_walls` in `sph_swe.rs`.
#import flood_sph_swe

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> status: Status;
@group(0) @binding(2) var<storage, read> parcels: array<Parcel>;
@group(0) @binding(3) var<storage, read> wall_start: array<u32>;
@group(0) @binding(4) var<storage, read> walls: array<WallSite>;
@group(0) @binding(5) var<storage, read_write> particles: array<Particle>;
// The push on each obstacle, m4/s2, and from 1 the number of the obstacle that is nearest; 0 for none.
@group(0) @binding(6) var<storage, read_write> pushes: array<vec3f>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= status.particles {
        return;
    }
    let own = parcels[i];
    var push = vec2f(0.0);
    var obstacle = 0u;
    if is_near(parameters.walls, own.place, own.h) {
        // a = -sum_k rho0 V_k (p_i / rho_i^2) grad W_ik (Akinci et al. 2012, equation 9).
        let strength = parameters.rest_density * own.pressure / (own.density * own.density);
        var nearest = own.h;
        let cells = cells_round(parameters.walls, own.place, own.h);
        for (var row = cells.y; row <= cells.w; row++) {
            let line = row * parameters.walls.columns;
            for (var k = wall_start[line + cells.x]; k < wall_start[line + cells.z + 1u]; k++) {
                let way = walls[k].place - own.place;
                let r = length(way);
                if r >= own.h {
                    continue;
                }
                push -= strength * walls[k].volume * spiky_slope(r, own.h) / max(r, 1e-9 * own.h) * way;
                if r < nearest {
                    nearest = r;
                    obstacle = walls[k].obstacle + 1u;
                }
            }
        }
    }
    let counts = particles[i].outside == 0u;
    particles[i].acceleration = push;
    pushes[i] = vec3f(-particles[i].volume * push, f32(select(0u, obstacle, counts)));
}

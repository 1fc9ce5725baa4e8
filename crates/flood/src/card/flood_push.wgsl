// The push of obstacles on each particle. Twin of `push` in `balanced/walls.rs`.
#import flood_walls

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> status: Status;
@group(0) @binding(2) var<storage, read> columns: array<PackedColumn>;
@group(0) @binding(3) var<storage, read> slopes: array<PackedSlopes>;
@group(0) @binding(4) var<storage, read> wall_start: array<u32>;
@group(0) @binding(5) var<storage, read> walls: array<WallSite>;
// Takes the push in place of the acceleration, over the density of water, m4/s2: `flood_forces` adds it.
@group(0) @binding(6) var<storage, read_write> particles: array<Particle>;
// The push of walls alone on each, and from 1 the number of the obstacle that is nearest; 0 for none.
@group(0) @binding(7) var<storage, read_write> pushes: array<vec3f>;

fn half_way(slope: vec2f, e: vec2f) -> f32 {
    return 0.5 * dot(slope, e);
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= status.particles {
        return;
    }
    let own = unpacked_column(columns[i]);
    let h = 1.0 / own.per_h;
    var push = vec2f(0.0);
    var by_walls = vec2f(0.0);
    var obstacle = 0u;
    if is_near(parameters.walls, own.place, 2.0 * h) {
        let gravity = parameters.gravity;
        let sloped = unpacked_slopes(slopes[i]);
        let b = sloped.renormalisation;
        let ground = own.surface - own.depth;
        let wave_speed = sqrt(gravity * own.depth);
        let own_pressure = 0.5 * gravity * own.depth * own.depth * (1.0 - sloped.rest);
        var nearest = 2.0 * h;
        let cells = cells_round(parameters.walls, own.place, 2.0 * h);
        for (var row = cells.y; row <= cells.w; row++) {
            let line = row * parameters.walls.columns;
            for (var k = wall_start[line + cells.x]; k < wall_start[line + cells.z + 1u]; k++) {
                let site = walls[k];
                let e = site.place - own.place;
                let apart = length(e);
                if apart >= 2.0 * h {
                    continue;
                }
                let r = max(apart, 1e-9 * h);
                // A = V_i V_k 2 B_i grad W(h_i): the mirror of a particle has its B and its h.
                let areas = 2.0 * own.area * site.area * spline_slope(r, own.per_h) / r;
                let area = areas * turned(b, e);
                let surface = own.surface + clamp(half_way(sloped.surface, e), -own.depth, own.depth);
                let middle = max(ground + half_way(sloped.ground, e), own.surface - SHARED * own.depth);
                let depth = max(surface - middle, 1e-6 * own.depth);
                let moved = own.velocity + vec2f(half_way(sloped.u, e), half_way(sloped.v, e));
                let at_wall = dot(moved, site.normal);
                var across = dot(own.velocity, site.normal);
                // Towards the wall the flow across it ebbs; where the slopes say otherwise they are noise.
                across = select(sign(across) * min(abs(at_wall), abs(across)), 0.0, at_wall * across <= 0.0);
                let impact = depth * wave_speed * across * dot(e, site.normal) / r;
                let pressure = max(0.5 * gravity * depth * depth + impact, 0.0);
                let own_depth = max(own.surface - middle, 0.0);
                let ground_push = own_pressure - 0.5 * gravity * own_depth * own_depth;
                push += area * (pressure + ground_push);
                by_walls += area * pressure;
                if r < nearest {
                    nearest = r;
                    obstacle = site.obstacle + 1u;
                }
            }
        }
    }
    let counts = particles[i].outside == 0u;
    particles[i].acceleration = push;
    pushes[i] = vec3f(by_walls, f32(select(0u, obstacle, counts)));
}

// First-order exact slopes of surface and velocity. Twin of `balanced/gradients.rs`.
#import flood_walls
#import flood_near

@group(0) @binding(1) var<storage, read> status: Status;
@group(0) @binding(4) var<storage, read> columns: array<PackedColumn>;
@group(0) @binding(5) var<storage, read> particles: array<Packed>;
@group(0) @binding(6) var<storage, read_write> slopes: array<PackedSlopes>;
@group(0) @binding(7) var<storage, read> wall_start: array<u32>;
@group(0) @binding(8) var<storage, read> walls: array<WallSite>;
@group(0) @binding(9) var nodes: texture_2d<f32>;

// Difference of surface over depth, or of velocity over wave speed, at which water counts as moving.
const REST = 0.05;
// Difference of surface over that of the ground at which water counts as tilted.
const TILT = 0.6;
// Trace of the moment matrix from which a particle is in company.
const COMPANY = 0.4;

// Inverse of the moment matrix (xx, xy, yy), made invertible where the neighbours stand in a line or are missing.
fn renormalisation(moment: vec3f) -> vec3f {
    var m = moment;
    let trace = m.x + m.z;
    if m.x * m.z - m.y * m.y <= 0.02 * trace * trace || trace <= 0.2 {
        let more = 0.1 * max(trace, 0.1);
        m.x += more;
        m.z += more;
    }
    return vec3f(m.z, -m.y, m.x) / (m.x * m.z - m.y * m.y);
}

// What walls add to the moment matrix, and the largest difference between the velocity and its mirror image beyond a wall. They take part
// in the areas that the particle shares, but not in its slopes: what water does along a wall goes on there.
fn of_walls(own: Column) -> vec4f {
    let h = 1.0 / own.per_h;
    if !is_near(parameters.walls, own.place, 2.0 * h) {
        return vec4f(0.0);
    }
    var sum = vec4f(0.0);
    let cells = cells_round(parameters.walls, own.place, 2.0 * h);
    for (var row = cells.y; row <= cells.w; row++) {
        let line = row * parameters.walls.columns;
        for (var k = wall_start[line + cells.x]; k < wall_start[line + cells.z + 1u]; k++) {
            let site = walls[k];
            let e = site.place - own.place;
            let r = length(e);
            if r >= 2.0 * h {
                continue;
            }
            let weight = site.area * spline_slope(r, own.per_h) / max(r, 1e-9 * h);
            sum += vec4f(weight * vec3f(e.x * e.x, e.x * e.y, e.y * e.y), 0.0);
            sum.w = max(sum.w, 2.0 * abs(dot(own.velocity, site.normal)));
        }
    }
    return sum;
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= status.particles {
        return;
    }
    let own = unpacked_column(columns[i]);
    let h = 1.0 / own.per_h;
    var moment = vec3f(0.0);
    var surface = vec2f(0.0);
    var u = vec2f(0.0);
    var v = vec2f(0.0);
    var surface_step = 0.0;
    var velocity_step = 0.0;
    var ground_step = 0.0;
    var walk = walk_round(i);
    while next_near(&walk, own.place, 2.0 * h) {
        let mirror = mirror(walk.mirror, parameters);
        let here = columns[walk.near].place_area_per_h;
        let there = shown(mirror, here.xy);
        let e = there - own.place;
        let r = max(length(e), 2e-12 * h);
        if r >= 2.0 * h || (walk.mirror > 0u && !has_image(mirror, parameters, there, 2.0 / here.w)) {
            continue;
        }
        let near = column_of(here, columns[walk.near].velocity_surface_depth);
        // The gradient of W at i is slope / r * e.
        let weight = spline_slope(r, own.per_h) / r * near.area * e;
        moment += vec3f(weight.x * e.x, weight.x * e.y, weight.y * e.y);
        var ds = near.surface - own.surface;
        if walk.mirror > 0u {
            ds += step_up(mirror, parameters, nodes, near.place);
        }
        let dv = mirror.sign * near.velocity - own.velocity;
        surface += weight * ds;
        u += weight * dv.x;
        v += weight * dv.y;
        surface_step = max(surface_step, abs(ds));
        ground_step = max(ground_step, abs(ds - (near.depth - own.depth)));
        velocity_step = max(velocity_step, dot(dv, dv));
    }
    let b = renormalisation(moment);
    let wave = sqrt(parameters.gravity * own.depth);
    let of_walls = of_walls(own);
    let all = moment + of_walls.xyz;
    let unrest = max(surface_step / own.depth, max(sqrt(velocity_step), of_walls.w) / wave) / REST;
    let tilt = surface_step / max(TILT * ground_step, 1e-12 * own.depth);
    let calm = min(unrest, tilt);
    let alone = max(1.0 - (all.x + all.z) / COMPANY, 0.0);
    let outside = select(0.0, 1.0, particles[i].slope_and_id.w > 0u);
    let ground_slope = ground_under(parameters, nodes, own.place).yz;
    var of_areas = b;
    if any(of_walls.xyz != vec3f(0.0)) {
        of_areas = renormalisation(all);
    }
    let rest = exp(-calm * calm);
    let sloped = Slopes(of_areas, outside, turned(b, surface), ground_slope, turned(b, u), turned(b, v), rest, alone);
    slopes[i] = packed_slopes(sloped);
}

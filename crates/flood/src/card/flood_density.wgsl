// How many particles stand here, so how deep the water is, and the ground under it. Twin of `density.rs` and of `find_depths` and
// `fill_columns` in `balanced/mod.rs`.
#import flood_walls
#import flood_near

@group(0) @binding(1) var<storage, read> status: Status;
// Place, weight and reach of each.
@group(0) @binding(4) var<storage, read> sites: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> particles: array<Packed>;
@group(0) @binding(6) var<storage, read_write> columns: array<PackedColumn>;
@group(0) @binding(7) var<storage, read> wall_start: array<u32>;
@group(0) @binding(8) var<storage, read> walls: array<WallSite>;
@group(0) @binding(9) var nodes: texture_2d<f32>;

// Least depth beyond an edge whose level falls below the ground, over the depth as it was.
const SHALLOWEST_STAGE = 1e-3;

// Neighbours within this much more than the reach are written down too: who reads the list rounds otherwise.
const CLOSE_BY = 1.00001;

// Number density, that of particles like this one, and how the first changes with h. Writes the neighbours down.
fn densities(i: u32, place: vec2f, weight: f32, h: f32) -> vec3f {
    let per_h = 1.0 / h;
    let own = spline(0.0, per_h);
    var number = 0.0;
    var weighted = 0.0;
    var r_slope = 0.0;
    var listed = 0u;
    let mirrors = mirrors_round(parameters, place);
    for (var k = 0u; k < mirrors; k++) {
        let mirror = mirror(k, parameters);
        let truth = behind(mirror, place);
        let reach = max(longest_reach(truth), 2.0 * h);
        if !sees(mirror, parameters, place, reach) {
            continue;
        }
        let cells = cells_round(parameters.grid, truth, reach);
        for (var row = cells.y; row <= cells.w; row++) {
            let across = columns_round(parameters.grid, truth, reach, row);
            let line = row * parameters.grid.columns;
            let end = start[line + across.y + 1u];
            for (var j = start[line + across.x]; j < end; j++) {
                let site = sites[j];
                let there = shown(mirror, site.xy);
                let r = max(distance(there, place), 2e-12 * h);
                let is_near = r < CLOSE_BY * max(2.0 * h, site.w);
                if !is_near || (j == i && k == 0u) || (k > 0u && !has_image(mirror, parameters, there, site.w)) {
                    continue;
                }
                listed += 1u;
                if listed <= parameters.most_near {
                    neighbours[place_in_list(listed, i)] = j | (k << MIRROR_BITS);
                }
                if r >= 2.0 * h {
                    continue;
                }
                let w = spline(r, per_h);
                number += w;
                weighted += w * site.z;
                r_slope += r * spline_slope(r, per_h);
            }
        }
    }
    neighbours[place_in_list(0u, i)] = listed;
    number += own;
    return vec3f(number, own + weighted / weight, (r_slope - 2.0 * number) / h);
}

// What obstacles cover of the kernel at a place, and how that changes with h. Twin of `Obstacles::coverage`.
fn coverage(place: vec2f, h: f32) -> vec2f {
    if !is_near(parameters.walls, place, 2.0 * h) {
        return vec2f(0.0);
    }
    var part = 0.0;
    var r_slope = 0.0;
    let cells = cells_round(parameters.walls, place, 2.0 * h);
    for (var row = cells.y; row <= cells.w; row++) {
        let line = row * parameters.walls.columns;
        for (var k = wall_start[line + cells.x]; k < wall_start[line + cells.z + 1u]; k++) {
            let r = distance(walls[k].place, place);
            part += walls[k].area * spline(r, 1.0 / h);
            r_slope += walls[k].area * r * spline_slope(r, 1.0 / h);
        }
    }
    if part > MOST_COVERED {
        return vec2f(MOST_COVERED, 0.0);
    }
    return vec2f(part, (r_slope - 2.0 * part) / h);
}

// Densities as they are where obstacles cover a part of the kernel: the water that is seen stands for what is not.
fn beside(density: vec3f, covered: vec2f) -> vec3f {
    let seen = 1.0 - covered.x;
    return vec3f(density.xy / seen, density.z / seen + density.x * covered.y / (seen * seen));
}

// The smoothing length for which n = (eta / h)^2, by one Newton step from h, kept within a fifth of it.
fn next_h(h: f32, number: f32, slope_in_h: f32) -> f32 {
    let residual = number * h * h - parameters.eta * parameters.eta;
    let slope = slope_in_h * h * h + 2.0 * number * h;
    var change = h;
    if slope > 1e-6 * number * h {
        change = -residual / slope;
    }
    return min(h + clamp(change, -0.2 * h, 0.2 * h), parameters.largest_h);
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= status.particles {
        return;
    }
    var particle = unpacked(particles[i]);
    let seen = densities(i, particle.place, particle.weight, particle.h);
    let density = beside(seen, coverage(particle.place, particle.h));
    let ground = ground_under(parameters, nodes, particle.place);
    particle.depth = particle.volume * density.y;
    particle.next_h = next_h(particle.h, density.x, density.z);
    particle.ground = ground.x;
    if particle.outside > 0u && parameters.rules[particle.outside - 1u] == STAGE {
        let level = status.next_stages[particle.outside - 1u];
        particle.depth = max(level - particle.ground, SHALLOWEST_STAGE * particle.depth);
    }
    let ahead = particle.velocity + 0.5 * status.step * particle.acceleration;
    // From here on it holds what obstacles push.
    particle.acceleration = vec2f(0.0);
    particles[i] = packed(particle);
    let surface = particle.ground + particle.depth;
    columns[i] = packed_column(Column(particle.place, ahead, surface, particle.depth, 1.0 / density.y, 1.0 / particle.h));
}

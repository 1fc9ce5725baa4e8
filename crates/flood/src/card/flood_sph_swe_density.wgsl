// Density of each particle in scheme sph-swe, the ground under it, and what follows for the forces. Twin of `find_densities` and
// `fill_parcels` in `sph_swe.rs`.
#import flood_sph_swe

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> status: Status;
@group(0) @binding(2) var<storage, read> start: array<u32>;
// Place, volume and reach of each.
@group(0) @binding(3) var<storage, read> sites: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> particles: array<Packed>;
@group(0) @binding(5) var<storage, read_write> parcels: array<Parcel>;
@group(0) @binding(6) var<storage, read> wall_start: array<u32>;
@group(0) @binding(7) var<storage, read> walls: array<WallSite>;
@group(0) @binding(8) var nodes: texture_2d<f32>;

// sum_j V_j W_poly6(r_ij, h_i), the particle itself included, m.
fn depth_of_water(i: u32, place: vec2f, h: f32) -> f32 {
    var sum = sites[i].z;
    let mirrors = mirrors_round(parameters, place);
    for (var k = 0u; k < mirrors; k++) {
        let mirror = mirror(k, parameters);
        if !sees(mirror, parameters, place, h) {
            continue;
        }
        let truth = behind(mirror, place);
        let cells = cells_round(parameters.grid, truth, h);
        for (var row = cells.y; row <= cells.w; row++) {
            let across = columns_round(parameters.grid, truth, h, row);
            let line = row * parameters.grid.columns;
            let end = start[line + across.y + 1u];
            for (var j = start[line + across.x]; j < end; j++) {
                let site = sites[j];
                let there = shown(mirror, site.xy);
                let way = there - place;
                if (j == i && k == 0u) || (k > 0u && !has_image(mirror, parameters, there, site.w)) {
                    continue;
                }
                let inside = max(1.0 - dot(way, way) / (h * h), 0.0);
                sum += site.z * inside * inside * inside;
            }
        }
    }
    return poly6(0.0, h) * sum;
}

// What boundary particles add to the density, over that of the water at rest (Akinci et al. 2012, equation 6).
fn covered(place: vec2f, h: f32) -> f32 {
    if !is_near(parameters.walls, place, h) {
        return 0.0;
    }
    var sum = 0.0;
    let cells = cells_round(parameters.walls, place, h);
    for (var row = cells.y; row <= cells.w; row++) {
        let line = row * parameters.walls.columns;
        for (var k = wall_start[line + cells.x]; k < wall_start[line + cells.z + 1u]; k++) {
            sum += walls[k].volume * poly6(distance(walls[k].place, place), h);
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
    var particle = unpacked(particles[i]);
    let relative = depth_of_water(i, particle.place, particle.h) + covered(particle.place, particle.h);
    particle.depth = relative;
    particle.next_h = min(parameters.first_h / sqrt(relative), parameters.widest_h);
    particle.ground = ground_under(parameters, nodes, particle.place).x;
    // From here on it holds what obstacles push.
    particle.acceleration = vec2f(0.0);
    particles[i] = packed(particle);
    let density = parameters.rest_density * relative;
    parcels[i] = Parcel(
        particle.place,
        particle.velocity,
        particle.volume / relative,
        density,
        sph_swe_pressure(parameters, density),
        particle.h,
    );
}

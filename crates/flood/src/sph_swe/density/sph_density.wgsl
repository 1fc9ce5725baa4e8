// Density of each particle, the ground under it, and what follows for the forces. Twin of `find_densities` and `fill_columns` in `mod.rs`.
#import sph_common
#import sph_neighbours
#import sph_kernels
#import sph_ground


// sum_j V_j W(r_ij, h_i), the particle itself included, m.
fn depth_of_water(i: u32, position: vec2f, h: f32) -> f32 {
    var sum = spots[i].z * value_shape(0.0);
    let mirrors = mirrors_round(position);
    for (var k = 0u; k < mirrors; k++) {
        let mirror = mirror(k);
        if !sees(mirror, position, h) {
            continue;
        }
        let truth = behind(mirror, position);
        let cells = cells_round(parameters.grid, truth, h);
        for (var row = cells.y; row <= cells.w; row++) {
            let across = columns_round(parameters.grid, truth, h, row);
            let line = row * parameters.grid.columns;
            let end = start[line + across.y + 1u];
            for (var j = start[line + across.x]; j < end; j++) {
                let site = spots[j];
                let there = ghost_of(mirror, site.xy);
                let way = there - position;
                if (j == i && k == 0u) || (k > 0u && !has_ghost(mirror, there, site.w)) {
                    continue;
                }
                sum += site.z * value_shape(dot(way, way) / (h * h));
            }
        }
    }
    return VALUE_FACTOR / (h * h) * sum;
}

// What boundary particles add to the density, over that of the water at rest (Akinci et al. 2012, equation 6).
fn covered(position: vec2f, h: f32) -> f32 {
    if !is_near(parameters.walls, position, h) {
        return 0.0;
    }
    var sum = 0.0;
    let cells = cells_round(parameters.walls, position, h);
    for (var row = cells.y; row <= cells.w; row++) {
        let line = row * parameters.walls.columns;
        for (var k = site_start[line + cells.x]; k < site_start[line + cells.z + 1u]; k++) {
            sum += sites[k].volume * kernel_value(distance(sites[k].position, position), h);
        }
    }
    return sum;
}

fn pressure_of(density: f32) -> f32 {
    let pressure = parameters.gas_constant * (density - parameters.rest_density);
    return select(pressure, max(pressure, 0.0), parameters.clips_pressure == 1u);
}

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= status.particles {
        return;
    }
    var particle = unpacked(sorted[i]);
    let relative = depth_of_water(i, particle.position, particle.h) + covered(particle.position, particle.h);
    particle.depth = relative;
    particle.next_h = min(parameters.first_h / sqrt(relative), parameters.widest_h);
    particle.ground = ground_under(particle.position).x;
    // From here on it holds what obstacles push.
    particle.acceleration = vec2f(0.0);
    sorted[i] = packed(particle);
    let density = parameters.rest_density * relative;
    columns[i] = Column(
        particle.position,
        particle.velocity,
        particle.volume / relative,
        density,
        pressure_of(density),
        particle.h,
    );
}

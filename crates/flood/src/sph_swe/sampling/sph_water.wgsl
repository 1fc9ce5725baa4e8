// Samples the water at a position from the particles near it. Twin of `Sampler` in `sampling/mod.rs`.
#import sph_common
#import sph_neighbours
#import sph_spline
#import sph_ground

// The part of the surroundings of a position that ghost particles beyond walls and periodic sides cover.
fn covered_by_ghosts(position: vec2f, search_radius: f32) -> f32 {
    var sum = 0.0;
    let mirrors = mirrors_round(position);
    for (var k = 1u; k < mirrors; k++) {
        let mirror = mirror(k);
        if !sees(mirror, position, search_radius) {
            continue;
        }
        let cells = cells_round(parameters.grid, behind(mirror, position), search_radius);
        for (var row = cells.y; row <= cells.w; row++) {
            let line = row * parameters.grid.columns;
            for (var j = start[line + cells.x]; j < start[line + cells.z + 1u]; j++) {
                let particle = unpacked(particles[j]);
                let there = ghost_of(mirror, particle.position);
                let h = SAMPLED * particle.h;
                if has_ghost(mirror, there, 2.0 * h) {
                    sum += particle.volume / particle.depth * spline(distance(there, position), 1.0 / h);
                }
            }
        }
    }
    return sum;
}

// The part that obstacles cover, by the mean smoothing length of the particles that cover the rest.
fn covered_by_obstacles(position: vec2f, mean_h: f32) -> f32 {
    if parameters.walls.columns == 0u {
        return 0.0;
    }
    let h = SAMPLED * mean_h;
    if !is_near(parameters.walls, position, 2.0 * h) {
        return 0.0;
    }
    var part = 0.0;
    let near = cells_round(parameters.walls, position, 2.0 * h);
    for (var row = near.y; row <= near.w; row++) {
        let line = row * parameters.walls.columns;
        for (var k = site_start[line + near.x]; k < site_start[line + near.z + 1u]; k++) {
            part += sites[k].area * spline(distance(sites[k].position, position), 1.0 / h);
        }
    }
    return min(part, MOST_COVERED);
}

fn weight_at(particle: Particle, offset: vec2f) -> f32 {
    return particle.volume / particle.depth * spline(length(offset), 1.0 / (SAMPLED * particle.h));
}

// The largest support of particles near a position; 0 where there are none.
fn reach_at(position: vec2f) -> f32 {
    let is_empty = start[parameters.grid.columns * parameters.grid.rows] == 0u;
    return select(reaches[cell_at(parameters.grid, position)], 0.0, is_empty);
}

// The position at the end of the step of the water that is at `position` `since` s later.
fn origin(position: vec2f, since: f32) -> vec2f {
    if since == 0.0 {
        return position;
    }
    var total = 0.0;
    var sum = vec2f(0.0);
    let cells = cells_round(parameters.grid, position, reach_at(position));
    for (var row = cells.y; row <= cells.w; row++) {
        let line = row * parameters.grid.columns;
        for (var j = start[line + cells.x]; j < start[line + cells.z + 1u]; j++) {
            let particle = unpacked(particles[j]);
            let weight = spline(distance(position, particle.position), 1.0 / particle.h);
            total += weight;
            sum += weight * particle.velocity;
        }
    }
    return position - since / max(total, 1e-30) * sum;
}

// Depth, m, and velocity, m/s, at a position; nothing where it is dry.
fn water_at(position: vec2f) -> vec3f {
    return water_later(position, 0.0);
}

// The same `since` s after the step. A Shepard mean over the particles, of the surface's height where the surface is the smoother field, and of
// the depth where that is.
fn water_later(position: vec2f, since: f32) -> vec3f {
    if reach_at(position) <= 0.0 {
        return vec3f(0.0);
    }
    let before = origin(position, since);
    let reach = reach_at(before);
    if reach <= 0.0 {
        return vec3f(0.0);
    }
    let search_radius = SEARCH_MARGIN * reach;
    let cells = cells_round(parameters.grid, before, search_radius);
    var total = 0.0;
    var lengths = 0.0;
    // Surface, depth and velocity.
    var sums = vec4f(0.0);
    for (var row = cells.y; row <= cells.w; row++) {
        let line = row * parameters.grid.columns;
        for (var j = start[line + cells.x]; j < start[line + cells.z + 1u]; j++) {
            let particle = unpacked(particles[j]);
            let weight = weight_at(particle, position - particle.position - since * particle.velocity);
            total += weight;
            lengths += weight * particle.h;
            sums += weight * vec4f(particle.ground + particle.depth, particle.depth, particle.velocity);
        }
    }
    var covered = total;
    if total > 0.0 && total < COVERED {
        covered += covered_by_ghosts(position, SEARCH_MARGIN * reach_at(position)) + covered_by_obstacles(position, lengths / total);
    }
    if covered < COVERED {
        return vec3f(0.0);
    }
    sums /= total;
    var surface_spread = 0.0;
    var depth_spread = 0.0;
    var deepest = 0.0;
    for (var row = cells.y; row <= cells.w; row++) {
        let line = row * parameters.grid.columns;
        for (var j = start[line + cells.x]; j < start[line + cells.z + 1u]; j++) {
            let particle = unpacked(particles[j]);
            let weight = weight_at(particle, position - particle.position - since * particle.velocity);
            if weight > 0.0 {
                let surface = particle.ground + particle.depth;
                surface_spread += weight * (surface - sums.x) * (surface - sums.x);
                depth_spread += weight * (particle.depth - sums.y) * (particle.depth - sums.y);
                deepest = max(deepest, particle.depth);
            }
        }
    }
    let from_surface = min(sums.x - ground_at(position).x, DEEPER * deepest);
    // Variances squared, so that the smoother field decides alone unless the two are similar; over the depth, as single
    // precision holds no squares of what is very small.
    let scale = 1.0 / max(deepest * deepest, 1e-30);
    let spreads = vec2f(surface_spread, depth_spread) * scale;
    let spread = dot(spreads, spreads);
    let share = select(1.0, spreads.y * spreads.y / spread, spread > 0.0);
    return vec3f(max(share * from_surface + (1.0 - share) * sums.y, 0.0), sums.zw);
}

// Writes the water of each cell as a particle for drawing, at the time shown: see `frame` in `model.rs`.
#import declared
#import voronoi_storage

fn particle_of(cell: u32) -> DeviceParticle {
    var particle = DeviceParticle();
    let now = columns[cell];
    let before = columns[parameters.cells + cell];
    let area = ground[cell].area;
    let volume = mix(before.volume.x, now.volume.x, shown.share);
    let momentum = bounded_momentum(mix(before.momentum, now.momentum, shown.share), volume, area);
    let own = water_in(cell, Column(vec2f(volume, 0.0), momentum), area);
    if own.depth <= shown.least_depth {
        return particle;
    }
    let position = positions[cell];
    particle.position = vec3f(position.at, position.bed + own.depth + own.shift);
    particle.spacing = sqrt(area);
    particle.velocity = vec3f(own.velocity, 0.0);
    particle.depth = own.depth;
    particle.volume = volume;
    particle.id = position.id;
    return particle;
}

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x == 0u {
        drawn.count = parameters.cells;
    }
    if id.x < parameters.cells {
        drawn.all[id.x] = particle_of(id.x);
    }
}

// Water in the air falls until it meets ground or water, and is then a particle. Twin of `falling.rs` and of `flood/exchange.rs` (gain).
#import flood_water
#import flood_air

@group(0) @binding(9) var<storage, read_write> air: Air;

fn has_landed(drop: Drop) -> bool {
    let ground = ground_at(parameters, nodes, drop.place).x;
    return drop.z <= ground || drop.z <= ground + water_at(drop.place).x;
}

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= parameters.in_air || air.drops[id.x].is_up == 0u {
        return;
    }
    var drop = air.drops[id.x];
    drop.z += status.step * (drop.w - 0.5 * parameters.gravity * status.step);
    drop.w -= parameters.gravity * status.step;
    drop.place += status.step * drop.velocity;
    if has_landed(drop) {
        drop.is_up = 0u;
        var particle: Particle;
        particle.place = drop.place;
        particle.velocity = drop.velocity;
        particle.volume = drop.volume;
        particle.weight = drop.volume;
        particle.h = drop.h;
        particle.next_h = drop.h;
        particle.id = drop.id;
        // The sort brings them into their order.
        particles[status.particles + atomicAdd(&air.landed, 1u)] = particle;
    }
    air.drops[id.x] = drop;
}

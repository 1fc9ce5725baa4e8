// What an air particle has beyond saturation: fog, or water for solids near it. Twin of `exchange::excess`, `Exchange::shares`, and of `saturate`
// in `dew/transfer.rs`.
#import dew_neighbours
#import dew_humid

// Twin of `exchange::excess`, whose slope is a difference that single precision would lose.
fn excess(particle: Particle) -> f32 {
    let warming = parameters.latent_heat / parameters.heat_capacity;
    let temperature = total(particle.temperature);
    let vapour = total(particle.vapour);
    if !(particle.fog > 0.0 || vapour > saturation(temperature).x) {
        return 0.0;
    }
    var condensed = 0.0;
    for (var k = 0u; k < 3u; k++) {
        let saturated = saturation(temperature + warming * condensed);
        condensed += (vapour - condensed - saturated.x) / (1.0 + warming * saturated.y);
    }
    return max(condensed, -particle.fog);
}

// Sum of the weights of the boundary particles near, and with the part of the heat that each takes. Twin of `Exchange::shares`.
fn weights_near(position: vec3f) -> vec2f {
    var sums = vec2f(0.0);
    let low = cell_index(position - parameters.h);
    let high = cell_index(position + parameters.h);
    for (var z = low.z; z <= high.z; z++) {
        for (var y = low.y; y <= high.y; y++) {
            let across = columns_round(position, y, z);
            let row = row_of(y, z);
            let end = site_start[row + across.y + 1u];
            for (var k = site_start[row + across.x]; k < end; k++) {
                if (sites[k].flags & (BOUNDARY | GHOST_PARTICLE_BEYOND)) == BOUNDARY {
                    let away = (position - sites[k].position) * parameters.per_h;
                    let weight = sites[k].volume * value_shape(dot(away, away));
                    sums += vec2f(weight, weight * sites[k].part);
                }
            }
        }
    }
    return sums;
}

// Deposits the supersaturated vapour of an air particle onto solids near it, or turns it into fog; returns the vapour that became fog.
fn saturate(particle: ptr<function, Particle>) -> f32 {
    let excess = excess(*particle);
    if excess == 0.0 {
        return 0.0;
    }
    let warming = parameters.latent_heat / parameters.heat_capacity * excess;
    if excess > 0.0 {
        let weights = weights_near((*particle).position);
        if weights.x > 0.0 {
            (*particle).deposit = parameters.mass * excess / weights.x;
            (*particle).vapour = add((*particle).vapour, -excess);
            (*particle).temperature = add((*particle).temperature, warming * (1.0 - weights.y / weights.x));
            return 0.0;
        }
    }
    if !is_set(FOGS) {
        return 0.0;
    }
    (*particle).vapour = add((*particle).vapour, -excess);
    (*particle).temperature = add((*particle).temperature, warming);
    (*particle).fog += excess;
    return excess;
}

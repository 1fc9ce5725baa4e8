// Saturation, and what passes between air and the surface of a solid. Twin of `humid_air/mod.rs` and of `Exchange::flux`.
#import dew_particles

// exp(x) - 1 without losing the digits of what is small: the series for a sixteenth of x, then four times (1 + e)^2 - 1.
fn exp_less_one(x: f32) -> f32 {
    let y = x / 16.0;
    var e = y * (1.0 + y / 2.0 * (1.0 + y / 3.0 * (1.0 + y / 4.0 * (1.0 + y / 5.0 * (1.0 + y / 6.0)))));
    for (var k = 0u; k < 4u; k++) {
        e *= 2.0 + e;
    }
    return e;
}

// Pressure of saturated vapour less that at the ambient temperature, Pa, at a temperature from the ambient air's: Bolton's formula over its value there.
fn saturation_pressure(temperature: f32) -> f32 {
    let ambient = BOLTON_C + parameters.celsius;
    return parameters.saturated * exp_less_one(BOLTON_B * BOLTON_C * temperature / (ambient * (ambient + temperature)));
}

// Part of the mass that is vapour in saturated air, less that of the ambient air, and its slope over temperature, 1/K. Where water boils it is all of it.
fn saturation(temperature: f32) -> vec2f {
    let higher = min(saturation_pressure(temperature), parameters.air_pressure - parameters.saturated);
    let pressure = parameters.saturated + higher;
    let rest = parameters.air_pressure - (1.0 - MASS_RATIO) * pressure;
    let at_ambient = parameters.air_pressure - (1.0 - MASS_RATIO) * parameters.saturated;
    let above = BOLTON_C + parameters.celsius + temperature;
    let slope = MASS_RATIO * parameters.air_pressure / (rest * rest) * pressure * BOLTON_B * BOLTON_C / (above * above);
    let more = MASS_RATIO * parameters.air_pressure * higher / (rest * at_ambient);
    return vec2f(more + parameters.lacking, slope);
}

struct Flux {
    // Conductances with which the air is warmed, W/K, and the solid.
    to_air: f32,
    to_solid: f32,
    // Temperature of the air less that of the solid, K.
    difference: f32,
    // Water that condenses, kg/s; evaporation is negative.
    water: f32,
}

// Between a site and air, q their distance over h, `offset` from one to the other as the air's column has axes.
fn flux(site: Site, surface: Surface, air: Column, offset: vec3f, q: f32) -> Flux {
    let of_pair = parameters.of_pair * site.volume * laplacian_shape(q) * factor(air.diagonal, air.doubled, offset);
    let difference = air.temperature - surface.temperature;
    // The air conducts as at the mean of both temperatures.
    let warmer = 1.0 + parameters.conductivity_per_kelvin * from_reference(0.5 * (air.temperature + surface.temperature));
    let mean = site.part + (1.0 - site.part) * warmer;
    let conducts = of_pair * select(mean, warmer / mean, is_set(IS_HARMONIC));
    var water = 0.0;
    if is_set(DIFFUSES) && (site.flags & BOUNDARY) != 0u {
        let at_surface = surface.temperature + (1.0 - site.part) * difference;
        let diffuses = 1.0 + parameters.diffusivity_per_kelvin * from_reference(0.5 * (air.temperature + at_surface));
        water = parameters.vapour_reach * diffuses * of_pair * (air.vapour - saturation(at_surface).x);
        if water < 0.0 {
            water *= select(0.0, surface.evaporation, surface.water > 0.0);
        }
    }
    return Flux(conducts * site.to_air, conducts * site.to_solid, difference, water);
}

// What every particle of a solid gets from the air and through the solid, as they stand. Twin of `Exchange::to_solid` and of
// `Conduction::heat`.
#import dew_neighbours
#import dew_humid

// Heat by difference of temperature, W, condensation and evaporation, kg/s, and the sum of conductances, W/K.
fn from_air(site: Site, surface: Surface) -> vec4f {
    var sums = FourSums(vec4f(0.0), vec4f(0.0));
    let mirrors = mirrors_round(site.position);
    for (var k = 0u; k < mirrors; k++) {
        let mirror = mirror(k, site.position);
        let truth = behind(mirror, site.position);
        let low = cell_index(truth - parameters.h);
        let high = cell_index(truth + parameters.h);
        for (var z = low.z; z <= high.z; z++) {
            for (var y = low.y; y <= high.y; y++) {
                let across = columns_round(truth, y, z);
                let row = row_of(y, z);
                let end = start[row + across.y + 1u];
                for (var j = start[row + across.x]; j < end; j++) {
                    let away = shown(mirror, columns[j].position_and_pressure.xyz) - site.position;
                    let q = length(away) * parameters.per_h;
                    if q >= 1.0 {
                        continue;
                    }
                    let air = unpacked_column(columns[j]);
                    let flux = flux(site, surface, air, mirror.sign * away, q);
                    let heat = flux.to_solid * flux.difference;
                    sums = add_four(sums, vec4f(heat, max(flux.water, 0.0), max(-flux.water, 0.0), flux.to_solid));
                }
            }
        }
    }
    return sums.values + sums.errors;
}

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= arrayLength(&own) {
        return;
    }
    let site = own[i];
    let solid = solids[i];
    let water = max(waters[i].uploaded + total(waters[i].gained), 0.0);
    var surface = Surface(total(solid.temperature), water, 1.0, 0.0, 0.0, 0.0, 0.0, waters[i].evaporation);
    if (site.flags & NEAR_SURFACE) != 0u {
        let sums = from_air(site, surface);
        let step = parameters.time_factor * status.step;
        if sums.z * step > water {
            surface.share = water / (sums.z * step);
        }
        surface.gain = sums.y - surface.share * sums.z;
        surface.heat = sums.x + site.part * parameters.latent_heat * surface.gain;
        surface.conductance = sums.w;
    }
    surface.all_heat = surface.heat;
    for (var k = site.first; k < site.end; k++) {
        let conductance = bitcast<f32>(pairs[k].y);
        let other = solids[pairs[k].x].temperature;
        surface.all_heat += conductance * difference(other, solid.temperature);
        surface.conductance += conductance;
    }
    surfaces[i] = surface;
}

// Particles of solids take up what they get in a step: heat, and water from vapour that diffuses to them and from air particles near them
// that are beyond saturation. Twin of `exchange` and `deposit_of` in `dew/transfer.rs`.
#import dew_neighbours
#import dew_particles

// Water that air particles lay on a boundary particle, kg.
fn deposited(site: Site) -> f32 {
    var water = 0.0;
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
                    let deposit = particles[j].acceleration_and_deposit.w;
                    if deposit > 0.0 {
                        let away = (shown(mirror, spots[j].xyz) - site.position) * parameters.per_h;
                        water += deposit * site.volume * value_shape(dot(away, away));
                    }
                }
            }
        }
    }
    return water;
}

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= arrayLength(&own) {
        return;
    }
    let site = own[i];
    let surface = surfaces[i];
    var solid = solids[i];
    var laid = 0.0;
    if is_set(SATURATES) && (site.flags & (BOUNDARY | NEAR_SURFACE)) == (BOUNDARY | NEAR_SURFACE) {
        laid = deposited(site);
    }
    let step = status.step;
    let factor = parameters.time_factor;
    let released = site.part * parameters.latent_heat * laid;
    let heat = step * surface.all_heat + released;
    let is_held = (site.flags & HELD) != 0u;
    if !is_held {
        solid.temperature = add(solid.temperature, factor * heat / site.capacity);
    }
    // What rounding leaves of the last of the water is nothing.
    waters[i].gained = add(add(waters[i].gained, max(factor * step * surface.gain, -surface.water)), factor * laid);
    solid.flow = surface.heat + released / step;
    solid.held = select(0.0, -factor * heat, is_held);
    solid.stiff = select(factor * surface.conductance / site.capacity, 0.0, is_held);
    solid.water = step * surface.gain + laid;
    solids[i] = solid;
}

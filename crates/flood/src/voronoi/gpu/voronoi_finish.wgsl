// Books a step, and decides whether there is another before the time that the host waits for.
#import declared
#import flood_sums
#import voronoi_tables

var<workgroup> volumes: array<vec4f, 256>;
var<workgroup> others: array<vec4f, 256>;
var<workgroup> rains: array<vec4f, 256>;
var<workgroup> steps: array<f32, 256>;
var<workgroup> counts: array<vec2u, 256>;

fn groups_for(count: u32) -> u32 {
    return (count + GROUP - 1u) / GROUP;
}

// Sums up over the groups of cells.
fn collect(thread: u32) {
    let zero = vec4f(0.0);
    var volume = zero;
    var other = zero;
    var rain = zero;
    var step = 3.0e38;
    var count = vec2u(0u);
    let all = groups_for(parameters.cells);
    if thread == 0u {
        // What structures did.
        volume = vec4f(passed[all].outflow, passed[all].inflow);
        other = vec4f(passed[all].energy, passed[all].momentum, 0.0);
    }
    for (var group = thread; group < all; group += 256u) {
        let of_group = passed[group];
        volume = vec4f(add_pair(volume.xy, of_group.outflow), add_pair(volume.zw, of_group.inflow));
        other += vec4f(of_group.energy, of_group.momentum, f32(of_group.is_broken));
        let energy = found[group].energy;
        other += vec4f(max(-energy, 0.0), max(energy, 0.0), found[group].momentum, 0.0);
        volume = vec4f(volume.xy, add_pair(volume.zw, found[group].supplied));
        rain = vec4f(add_pair(rain.xy, found[group].rained), add_pair(rain.zw, found[group].infiltrated));
        step = min(step, found[group].step);
        count += vec2u(found[group].wet, found[group].at_rim);
    }
    volumes[thread] = volume;
    others[thread] = other;
    rains[thread] = rain;
    steps[thread] = step;
    counts[thread] = count;
    for (var half = 128u; half > 0u; half /= 2u) {
        workgroupBarrier();
        if thread < half {
            let own = volumes[thread];
            let more = volumes[thread + half];
            volumes[thread] = vec4f(add_pair(own.xy, more.xy), add_pair(own.zw, more.zw));
            others[thread] += others[thread + half];
            let fell = rains[thread];
            let fell_too = rains[thread + half];
            rains[thread] = vec4f(add_pair(fell.xy, fell_too.xy), add_pair(fell.zw, fell_too.zw));
            steps[thread] = min(steps[thread], steps[thread + half]);
            counts[thread] += counts[thread + half];
        }
    }
}

fn book() {
    let volume = volumes[0];
    let other = others[0];
    status.last_step = status.step;
    status.clock = tidy(add(status.clock, status.step));
    status.outflow = tidy(add_pair(status.outflow, volume.xy));
    status.inflow = tidy(add_pair(status.inflow, volume.zw));
    status.energy_out = tidy(add(status.energy_out, other.x));
    status.energy_in = tidy(add(status.energy_in, other.y));
    status.momentum_in = tidy(add(status.momentum_in, max(other.z, 0.0)));
    status.momentum_out = tidy(add(status.momentum_out, max(-other.z, 0.0)));
    status.rained = tidy(add_pair(status.rained, rains[0].xy));
    status.infiltrated = tidy(add_pair(status.infiltrated, rains[0].zw));
    status.steps += 1u;
    status.all_steps += 1u;
    let drank = status.all_steps % STEPS_A_DRAUGHT == 0u;
    status.since_draught = select(status.since_draught + status.step, 0.0, drank);
    status.wet = counts[0].x;
    status.at_rim = counts[0].y;
    status.is_broken = u32(other.w > 0.0);
    let low = status.cell_steps.x + status.wet;
    status.cell_steps = vec2u(low, status.cell_steps.y + u32(low < status.wet));
    status.step = min(COURANT * steps[0], parameters.longest);
}

fn decide() -> u32 {
    if status.is_broken != 0u || !is_finite(status.step) {
        return BROKEN;
    }
    if status.at_rim != 0u {
        return AT_RIM;
    }
    let left = (status.until.x - status.clock.x) + (status.until.y - status.clock.y);
    return select(ARRIVED, GOING, left > 0.0);
}

// What a table comes to in the next step.
fn look_up(table: u32) {
    let header = TABLE * table;
    let sum = integral(table, status.clock, status.step);
    tables[header + INTEGRAL] = bitcast<u32>(sum);
    tables[header + MEAN] = bitcast<u32>(sum / status.step);
    tables[header + AT_BEGINNING] = bitcast<u32>(value_at(table, status.clock));
    tables[header + AT_BEGINNING + 1u] = bitcast<u32>(value_at(table, add(status.clock, status.step)));
}

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_index) thread: u32) {
    let was = status.halted;
    collect(thread);
    if thread == 0u {
        if was == GOING {
            book();
        }
        if was == GOING || was == BATCH_START {
            status.halted = decide();
        }
        let goes_on = status.halted == GOING;
        groups[0] = select(0u, groups_for(parameters.cells), goes_on);
        groups[3] = select(0u, groups_for(parameters.faces), goes_on);
        groups[6] = select(0u, groups_for(parameters.borders), goes_on);
        groups[9] = select(0u, parameters.discharges, goes_on);
        groups[12] = select(0u, groups_for(parameters.crests), goes_on);
        groups[15] = select(0u, groups_for(parameters.beside_crests), goes_on);
        groups[18] = select(0u, 1u, goes_on);
        for (var table = 0u; table < parameters.tables && goes_on; table++) {
            look_up(table);
        }
    }
}

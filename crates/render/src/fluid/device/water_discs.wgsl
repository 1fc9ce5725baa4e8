// Discs in the water's surface and their new foam; balls of particles in the air. Twin of `disc` and `in_air`
// in `water.rs`.
#import water_planes
#import water_borders

// Linear step between two values: 0 at the first, 1 at the second.
fn part(value: f32, between: vec2f) -> f32 {
    return clamp((value - between.x) / (between.y - between.x), 0.0, 1.0);
}

fn volume(i: u32) -> f32 {
    return bitcast<f32>(matter[i].x);
}

fn numbered(i: u32) -> f32 {
    return f32(matter[i].y % DRAWN_NUMBERS);
}

fn in_air(i: u32) -> DropletInstance {
    let radius = water.unit * pow(0.75 * volume(i) / PI, 1.0 / 3.0);
    let position = water.unit * sites[i].xyz;
    return DropletInstance(position, radius, vec3f(0.0, 0.0, 1.0), 1.0, vec4f(0.0, SPRAY_FOAM, radius, numbered(i)), vec2f(0.0), vec2f(0.0));
}

// Whether a position is no farther than that from a border of the ground, m.
fn is_at_border(position: vec2f, reach: f32) -> bool {
    let low = abs(position - water.ground_corner);
    let high = abs(position - node_position(water, water.ground_nodes - 1u));
    return min(min(low.x, low.y), min(high.x, high.y)) < OVER_REACH * reach;
}

fn disc(i: u32) -> DropletInstance {
    let own = sites[i];
    let fit = fit_at(i);
    var slope = vec2f(fit.east.x, fit.north.x);
    slope *= min(1.0, STEEPEST / max(length(slope), 1e-12));
    let normal = normalize(vec3f(-slope, 1.0));
    let radius = DISC * own.w;
    let reach = REACH * own.w;
    if is_at_border(own.xy, reach) {
        atomicMax(&sizes.farthest, bitcast<u32>(reach));
    }
    let middle = vec3f(own.xy, fit.here.x) - FLATNESS * radius * normal;
    // Convergence of the water of a disc.
    let closing = -(fit.east.y + fit.north.z) * reach;
    let velocity = bitcast<vec2f>(matter[i].zw);
    foam[i] = part(closing, TRAPPED) * part(0.5 * dot(velocity, velocity), ENERGY) * part(fit.weight, CLOSED);
    let depth = 4.0 * volume(i) / (PI * reach * reach);
    return DropletInstance(
        water.unit * middle,
        water.unit * radius,
        normal,
        FLATNESS,
        vec4f(depth, 0.0, water.unit * reach, numbered(i)),
        fit.here.yz,
        vec2f(0.0),
    );
}

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i < start[of_ground(water)] {
        instances[i] = disc(i);
    } else if i < start[of_ground(water) + 1u] {
        instances[i] = in_air(i);
    }
}

// Discharge through culverts and over weirs: see `hydraulics.rs`, which names the sources.
#import declared

// Of a level where there is no water.
const NO_LEVEL = -FAR;

fn over_weir(crest: f32, width: f32, coefficient: f32, upper: f32, lower: f32) -> f32 {
    let head = max(upper - crest, 0.0);
    if head <= 0.0 {
        return 0.0;
    }
    let behind = clamp(lower - crest, 0.0, head);
    let free = coefficient * width * head * sqrt(head);
    let ratio = behind / head;
    return free * pow(max(1.0 - ratio * sqrt(ratio), 0.0), SUBMERGENCE_EXPONENT);
}

struct Culvert {
    height: f32,
    area: f32,
    radius: f32,
    length: f32,
    floor: vec2f,
    manning: f32,
    entrance_loss: f32,
    barrels: f32,
}

fn sill(culvert: Culvert, depth: f32, gravity: f32) -> f32 {
    let critical = 2.0 / 3.0 * depth;
    return culvert.area / culvert.height * critical * sqrt(critical) * sqrt(gravity);
}

fn orifice(culvert: Culvert, depth: f32, gravity: f32) -> f32 {
    return ORIFICE * culvert.area * sqrt(2.0 * gravity * (depth - 0.5 * culvert.height));
}

fn inlet(culvert: Culvert, depth: f32, gravity: f32) -> f32 {
    let transition = SUBMERGED * culvert.height;
    if depth < transition {
        return sill(culvert, depth, gravity);
    }
    return sill(culvert, transition, gravity) * orifice(culvert, depth, gravity) / orifice(culvert, transition, gravity);
}

// The level that a discharge through one barrel needs above it where the outlet decides.
fn outlet_level(culvert: Culvert, discharge: f32, lower: f32, outlet: f32, gravity: f32) -> f32 {
    let per_width = discharge * culvert.height / culvert.area;
    let critical = min(pow(per_width * per_width / gravity, 1.0 / 3.0), culvert.height);
    let behind = max(outlet + critical, lower);
    let velocity = discharge / culvert.area;
    let friction = 2.0 * gravity * culvert.manning * culvert.manning * culvert.length / pow(culvert.radius, 4.0 / 3.0);
    return behind + (1.0 + culvert.entrance_loss + friction) * velocity * velocity / (2.0 * gravity);
}

// `floors` are those at the inlet and at the outlet.
fn through_culvert(culvert: Culvert, upper: f32, lower: f32, floors: vec2f, gravity: f32) -> f32 {
    let most = inlet(culvert, max(upper - floors.x, 0.0), gravity);
    // Sought by halving: the discharge that needs no more than the level there is.
    if outlet_level(culvert, most, lower, floors.y, gravity) <= upper {
        return culvert.barrels * most;
    }
    var low = 0.0;
    var high = most;
    for (var k = 0u; k < 30u; k++) {
        let middle = 0.5 * (low + high);
        if outlet_level(culvert, middle, lower, floors.y, gravity) > upper {
            high = middle;
        } else {
            low = middle;
        }
    }
    return culvert.barrels * low;
}

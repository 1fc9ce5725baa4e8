// How much water goes through culverts and over weirs. Twin of `hydraulics.rs`, which names the sources. A link takes so many numbers of
// `works`: zones of its ends; whether it leads both ways; which law; and the law's own.
#import flood_water

const CULVERT = 0u;
const WEIR = 1u;
const RATING = 2u;

const ORIFICE = 0.6;
const SUBMERGED = 1.2;

// Of a level where there is no water.
const DRY = -3.0e38;

fn over_weir(law: u32, upper: f32, lower: f32) -> f32 {
    let crest = work(law);
    let head = max(upper - crest, 0.0);
    if head <= 0.0 {
        return 0.0;
    }
    let behind = clamp(lower - crest, 0.0, head);
    let free = work(law + 2u) * work(law + 1u) * head * sqrt(head);
    let ratio = behind / head;
    return free * pow(max(1.0 - ratio * sqrt(ratio), 0.0), 0.385);
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

fn sill(culvert: Culvert, depth: f32) -> f32 {
    let critical = 2.0 / 3.0 * depth;
    return culvert.area / culvert.height * critical * sqrt(critical) * sqrt(parameters.gravity);
}

fn orifice(culvert: Culvert, depth: f32) -> f32 {
    return ORIFICE * culvert.area * sqrt(2.0 * parameters.gravity * (depth - 0.5 * culvert.height));
}

fn inlet(culvert: Culvert, depth: f32) -> f32 {
    let transition = SUBMERGED * culvert.height;
    if depth < transition {
        return sill(culvert, depth);
    }
    return sill(culvert, transition) * orifice(culvert, depth) / orifice(culvert, transition);
}

// The level that a discharge through one barrel needs above it where the outlet decides.
fn outlet_level(culvert: Culvert, discharge: f32, lower: f32, outlet: f32) -> f32 {
    let gravity = parameters.gravity;
    let per_width = discharge * culvert.height / culvert.area;
    let critical = min(pow(per_width * per_width / gravity, 1.0 / 3.0), culvert.height);
    let behind = max(outlet + critical, lower);
    let velocity = discharge / culvert.area;
    let friction = 2.0 * gravity * culvert.manning * culvert.manning * culvert.length / pow(culvert.radius, 4.0 / 3.0);
    return behind + (1.0 + culvert.entrance_loss + friction) * velocity * velocity / (2.0 * gravity);
}

fn through_culvert(law: u32, upper: f32, lower: f32, forward: bool) -> f32 {
    let culvert = Culvert(
        work(law),
        work(law + 1u),
        work(law + 2u),
        work(law + 3u),
        work_pair(law + 4u),
        work(law + 6u),
        work(law + 7u),
        work(law + 8u),
    );
    let floors = select(culvert.floor.yx, culvert.floor, forward);
    let most = inlet(culvert, max(upper - floors.x, 0.0));
    // Sought by halving: the discharge that needs no more than the level there is.
    if outlet_level(culvert, most, lower, floors.y) <= upper {
        return culvert.barrels * most;
    }
    var low = 0.0;
    var high = most;
    for (var k = 0u; k < 30u; k++) {
        let middle = 0.5 * (low + high);
        if outlet_level(culvert, middle, lower, floors.y) > upper {
            high = middle;
        } else {
            low = middle;
        }
    }
    return culvert.barrels * low;
}

// Discharge, m3/s, from the end where the water stands at `upper` to where it stands at `lower`; `forward` from the first to the second.
fn by_law(link: u32, upper: f32, lower: f32, forward: bool) -> f32 {
    let law = link + 4u;
    switch works[link + 3u] {
        case CULVERT: { return through_culvert(law, upper, lower, forward); }
        case WEIR: { return over_weir(law, upper, lower); }
        default: {
            // Where it has run dry the fall is not known: as from the same ground.
            let head = select(upper - lower, 0.0, lower == DRY);
            return in_table(works[law], works[law + 1u], head);
        }
    }
}

// Discharge, m3/s, positive from the first end to the second. Twin of `Link::discharge`.
fn of_link(link: u32, first: f32, second: f32) -> f32 {
    if first >= second {
        return select(by_law(link, first, second, true), 0.0, first == DRY);
    }
    if works[link + 2u] == 1u {
        return -by_law(link, second, first, false);
    }
    return 0.0;
}

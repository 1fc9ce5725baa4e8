// How much water links lead. A link takes so many numbers of
// `works`: zones of its ends; whether it leads both ways; which law; and the law's own.
#import flood_water
#import hydraulics

const CULVERT = 0u;
const WEIR = 1u;
const RATING = 2u;

fn culvert_of(law: u32) -> Culvert {
    return Culvert(
        work(law),
        work(law + 1u),
        work(law + 2u),
        work(law + 3u),
        work_pair(law + 4u),
        work(law + 6u),
        work(law + 7u),
        work(law + 8u),
    );
}

// Discharge, m3/s, from the end where the water stands at `upper` to where it stands at `lower`; `forward` from the first to the second.
fn by_law(link: u32, upper: f32, lower: f32, forward: bool) -> f32 {
    let law = link + 4u;
    switch works[link + 3u] {
        case CULVERT: {
            let culvert = culvert_of(law);
            let floors = select(culvert.floor.yx, culvert.floor, forward);
            return through_culvert(culvert, upper, lower, floors, parameters.gravity);
        }
        case WEIR: { return over_weir(work(law), work(law + 1u), work(law + 2u), upper, lower); }
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

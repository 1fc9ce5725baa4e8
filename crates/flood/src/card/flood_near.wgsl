// The neighbours of a particle, in the order in which `flood_density` found them and wrote them down. Who has more than there is room
// for looks for them again.
//
// `neighbours` has first the longest reach round each cell, as bits; then how many neighbours each particle has; and then the first of each
// particle, the second of each, and so on: particles that are computed together read what lies together.
#import flood_neighbours

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(2) var<storage, read> start: array<u32>;
@group(0) @binding(3) var<storage, read_write> neighbours: array<u32>;

// A neighbour as it is written down: its number, and in the highest bits that of the mirror in which it is seen.
const MIRROR_BITS = 28u;

struct Walk {
    particle: u32,
    is_listed: bool,
    // Where the walk is and where it ends: along the list, or among the particles in a row of cells.
    at: u32,
    end: u32,
    row: u32,
    // The neighbour that it has come to, and in which mirror.
    near: u32,
    mirror: u32,
}

fn place_in_list(number: u32, particle: u32) -> u32 {
    return parameters.near_first + number * parameters.near_stride + particle;
}

// Before the first neighbour.
fn walk_round(particle: u32) -> Walk {
    let listed = neighbours[place_in_list(0u, particle)];
    let is_listed = listed <= parameters.most_near;
    return Walk(particle, is_listed, 0u, select(0u, listed, is_listed), 0u, 0u, 0u);
}

// Goes to the next neighbour of a particle that stands at `place` and reaches `reach` far; false where there is none. In a walk that is not
// along the list it may be out of reach.
fn next_near(walk: ptr<function, Walk>, place: vec2f, reach: f32) -> bool {
    if !(*walk).is_listed {
        return next_candidate(walk, place, reach);
    }
    if (*walk).at == (*walk).end {
        return false;
    }
    (*walk).at += 1u;
    let entry = neighbours[place_in_list((*walk).at, (*walk).particle)];
    (*walk).near = entry & ((1u << MIRROR_BITS) - 1u);
    (*walk).mirror = entry >> MIRROR_BITS;
    return true;
}

fn next_candidate(walk: ptr<function, Walk>, place: vec2f, reach: f32) -> bool {
    loop {
        if (*walk).at < (*walk).end {
            (*walk).near = (*walk).at;
            (*walk).at += 1u;
            if (*walk).near != (*walk).particle || (*walk).mirror > 0u {
                return true;
            }
        } else if !next_row(walk, place, reach) {
            return false;
        }
    }
    return false;
}

// Goes on to a row of cells: the next one in this mirror, or the first in the next that shows anything. `row` counts from 1.
fn next_row(walk: ptr<function, Walk>, place: vec2f, reach: f32) -> bool {
    let mirrors = mirrors_round(parameters, place);
    while (*walk).mirror < mirrors {
        let mirror = mirror((*walk).mirror, parameters);
        let truth = behind(mirror, place);
        let far = max(longest_reach(truth), reach);
        let cells = cells_round(parameters.grid, truth, far);
        (*walk).row = max((*walk).row, cells.y) + 1u;
        if sees(mirror, parameters, place, far) && (*walk).row <= cells.w + 1u {
            let across = columns_round(parameters.grid, truth, far, (*walk).row - 1u);
            let line = ((*walk).row - 1u) * parameters.grid.columns;
            (*walk).at = start[line + across.x];
            (*walk).end = start[line + across.y + 1u];
            return true;
        }
        (*walk).mirror += 1u;
        (*walk).row = 0u;
    }
    return false;
}

// How far who stands round a place reaches at most, m.
fn longest_reach(place: vec2f) -> f32 {
    return bitcast<f32>(neighbours[cell_at(parameters.grid, place)]);
}

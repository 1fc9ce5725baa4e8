// The neighbours of a particle, in the order in which `flood_density` found them and wrote them down. Who has more than there is room
// for looks for them again.
//
// `neighbours` has first the longest reach round each cell, as bits. Then come the first four numbers of each particle, the second four of
// each, and so on, so that particles that are computed together read what lies together. A particle's numbers are how many neighbours it
// has, and these.
#import flood_neighbours

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(2) var<storage, read> start: array<u32>;
@group(0) @binding(3) var<storage, read_write> neighbours: array<vec4u>;

// A neighbour as it is written down: its number, and in the highest bits that of the mirror in which it is seen.
const MIRROR_BITS = 28u;

// What is yet to be written down: the first four numbers, and the last up to four.
struct Notes {
    first: vec4u,
    last: vec4u,
    count: u32,
}

fn place_in_list(four: u32, particle: u32) -> u32 {
    return parameters.near_first + four * parameters.near_stride + particle;
}

fn note(notes: ptr<function, Notes>, particle: u32, near: u32, mirror: u32) {
    (*notes).count += 1u;
    if (*notes).count > parameters.most_near {
        return;
    }
    (*notes).last = vec4u((*notes).last.yzw, near | (mirror << MIRROR_BITS));
    if (*notes).count == 3u {
        (*notes).first = (*notes).last;
    } else if (*notes).count % 4u == 3u {
        neighbours[place_in_list((*notes).count / 4u, particle)] = (*notes).last;
    }
}

// Writes down what is left of the notes, and how many there are.
fn finish_notes(notes: Notes, particle: u32) {
    var first = notes.first;
    if notes.count <= parameters.most_near && notes.count % 4u != 3u {
        var last = notes.last;
        for (var k = notes.count % 4u; k < 3u; k++) {
            last = vec4u(last.yzw, 0u);
        }
        if notes.count < 3u {
            first = last;
        } else {
            neighbours[place_in_list(notes.count / 4u, particle)] = last;
        }
    }
    first.x = notes.count;
    neighbours[place_in_list(0u, particle)] = first;
}

struct Walk {
    particle: u32,
    is_listed: bool,
    // Where the walk is and where it ends: along the list, or among the particles in a row of cells.
    at: u32,
    end: u32,
    row: u32,
    // The next numbers of the list.
    four: vec4u,
    // The neighbour that it has come to, and in which mirror.
    near: u32,
    mirror: u32,
}

// Before the first neighbour.
fn walk_round(particle: u32) -> Walk {
    let four = neighbours[place_in_list(0u, particle)];
    let is_listed = four.x <= parameters.most_near;
    return Walk(particle, is_listed, 0u, select(0u, four.x, is_listed), 0u, four, 0u, 0u);
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
    (*walk).four = vec4u((*walk).four.yzw, 0u);
    if (*walk).at % 4u == 0u {
        (*walk).four = neighbours[place_in_list((*walk).at / 4u, (*walk).particle)];
    }
    (*walk).near = (*walk).four.x & ((1u << MIRROR_BITS) - 1u);
    (*walk).mirror = (*walk).four.x >> MIRROR_BITS;
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
    let cell = cell_at(parameters.grid, place);
    return bitcast<f32>(neighbours[cell / 4u][cell % 4u]);
}

// Neighbour search: cells to search, and ghost particles beyond the edges.
//
// Ghost particles are not stored as on the CPU: near an edge the search is repeated from the mirrored position, and what it finds is
// mirrored. So each pass loops over `Mirror`s, the first of which is the identity.
#import sph_common

struct Mirror {
    // The ghost particle of a position p stands at sign * p + shift.
    sign: vec2f,
    shift: vec2f,
    // Beyond which side along x and y it stands: -1, 0 or 1.
    beyond: vec2f,
    // Whether there are ghost particles.
    is_there: bool,
}

const MIRRORS = 9u;

// Number of mirrors to search from a position: away from the edges the first alone.
fn mirrors_round(position: vec2f) -> u32 {
    let farthest = parameters.widest_h;
    let is_amid = all(position - farthest > parameters.bounds.xz) && all(position + farthest < parameters.bounds.yw);
    return select(MIRRORS, 1u, is_amid);
}

// Sign, shift and whether there are ghost particles beyond one side of an axis.
fn along(beyond: i32, low: f32, high: f32, rules: vec2u) -> vec3f {
    if beyond == 0 {
        return vec3f(1.0, 0.0, 1.0);
    }
    let rule = select(rules.y, rules.x, beyond < 0);
    if rule == PERIODIC {
        return vec3f(1.0, f32(beyond) * (high - low), 1.0);
    }
    if rule == WALL {
        return vec3f(-1.0, 2.0 * select(high, low, beyond < 0), 1.0);
    }
    return vec3f(1.0, 0.0, 0.0);
}

// The mirror of a number below MIRRORS; 0 is the identity.
fn mirror(number: u32) -> Mirror {
    if number == 0u {
        return Mirror(vec2f(1.0), vec2f(0.0), vec2f(0.0), true);
    }
    let beyond = vec2i(i32((number + 1u) % 3u), i32(((number + 3u) / 3u) % 3u)) - 1;
    let x = along(beyond.x, parameters.bounds.x, parameters.bounds.y, parameters.rules.xy);
    let y = along(beyond.y, parameters.bounds.z, parameters.bounds.w, parameters.rules.zw);
    return Mirror(vec2f(x.x, y.x), vec2f(x.y, y.y), vec2f(beyond), x.z * y.z > 0.0);
}

// The original position of a ghost particle at `position`.
fn behind(mirror: Mirror, position: vec2f) -> vec2f {
    return mirror.sign * (position - mirror.shift);
}

// The position of the ghost particle of a particle at `position`.
fn ghost_of(mirror: Mirror, position: vec2f) -> vec2f {
    return mirror.sign * position + mirror.shift;
}

// Whether the mirror may have ghost particles within `reach` of a position.
fn sees(mirror: Mirror, position: vec2f, reach: f32) -> bool {
    if !mirror.is_there {
        return false;
    }
    let truth = behind(mirror, position);
    let bounds = parameters.bounds;
    // Along an open side, particles that have left have ghost particles too.
    let along = mirror.beyond == vec2f(0.0);
    return all(along | ((truth + reach >= bounds.xz) & (truth - reach <= bounds.yw)));
}

// Whether a particle has a ghost particle at `position`: not too far from the edge.
fn has_ghost(mirror: Mirror, position: vec2f, reach: f32) -> bool {
    let bounds = parameters.bounds;
    let out = max(bounds.xz - position, position - bounds.yw);
    let near = (out >= vec2f(0.0)) & (out < vec2f(GHOST_MARGIN * reach));
    return all(near | (mirror.beyond == vec2f(0.0)));
}

// First and last column and row of the cells within `reach` of a position.
fn cells_round(grid: Grid, position: vec2f, reach: f32) -> vec4u {
    let last = vec2u(grid.columns, grid.rows) - 1u;
    let low = max((position - reach - grid.corner) * grid.per_cell, vec2f(0.0));
    let high = max((position + reach - grid.corner) * grid.per_cell, vec2f(0.0));
    return vec4u(min(vec2u(low), last), min(vec2u(high), last));
}

// First and last column of those cells of a row in which particles may be within `reach` of a position: fewer than those of `cells_round`, in
// rows away from the position. None: the first is after the last.
fn columns_round(grid: Grid, position: vec2f, reach: f32, row: u32) -> vec2u {
    let border = CELL_BORDER * grid.cell;
    let south = grid.corner.y + f32(row) * grid.cell - border;
    // Particles beyond the first and the last row are stored in these.
    let from_south = select(south - position.y, 0.0, row == 0u);
    let from_north = select(position.y - (south + grid.cell + 2.0 * border), 0.0, row + 1u == grid.rows);
    let apart = max(max(from_south, from_north), 0.0);
    if apart > reach {
        return vec2u(1u, 0u);
    }
    let half = sqrt(reach * reach - apart * apart) + border;
    let ends = max((position.x + vec2f(-half, half) - grid.corner.x) * grid.per_cell, vec2f(0.0));
    return min(vec2u(ends), vec2u(grid.columns - 1u));
}

fn cell_at(grid: Grid, position: vec2f) -> u32 {
    let cell = cells_round(grid, position, 0.0);
    return cell.y * grid.columns + cell.x;
}

// Whether cells lie within `reach` of a position.
fn is_near(grid: Grid, position: vec2f, reach: f32) -> bool {
    let high = grid.corner + grid.cell * vec2f(vec2u(grid.columns, grid.rows));
    return grid.columns > 0u && all(position + reach >= grid.corner) && all(position - reach <= high);
}

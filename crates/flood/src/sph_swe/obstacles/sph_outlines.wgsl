// Outlines of obstacles as a list of numbers: where the list of each cell begins, with one more for the end; then those lists, of three
// numbers an outline: its obstacle, its first side and the one after its last; and, counted by fours from the start of all, the sides:
// two corners each.
#import declared

// The way from a side to a position.
fn way_from(position: vec2f, side: vec4f) -> vec2f {
    let along = side.zw - side.xy;
    let part = clamp(dot(position - side.xy, along) / max(dot(along, along), 1e-30), 0.0, 1.0);
    return position - side.xy - part * along;
}

// Whether a ray to the east crosses a side.
fn crosses(position: vec2f, side: vec4f) -> bool {
    let part = (position.y - side.y) / (side.w - side.y);
    return ((side.y > position.y) != (side.w > position.y)) && position.x < side.x + part * (side.z - side.x);
}

fn side(number: u32) -> vec4f {
    let at = 4u * number;
    return vec4f(
        bitcast<f32>(outlines[at]),
        bitcast<f32>(outlines[at + 1u]),
        bitcast<f32>(outlines[at + 2u]),
        bitcast<f32>(outlines[at + 3u]),
    );
}

// The cell by which outlines near a position are found; NONE where there is none.
fn outline_cell(position: vec2f) -> u32 {
    let grid = parameters.outlines;
    let at = (position - grid.corner) * grid.per_cell;
    if grid.columns == 0u || any(at < vec2f(0.0)) || any(at >= vec2f(vec2u(grid.columns, grid.rows))) {
        return NONE;
    }
    return u32(at.y) * grid.columns + u32(at.x);
}

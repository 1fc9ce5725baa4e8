// The longest reach that touches each cell from its own row. Twin of `Cells::set_reach` in the crate sph.
#import declared

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let cell = id.x;
    if cell >= parameters.grid.columns * parameters.grid.rows {
        return;
    }
    let column = cell % parameters.grid.columns;
    let first = column - min(column, parameters.farthest);
    let last = min(column + parameters.farthest, parameters.grid.columns - 1u);
    var longest = 0.0;
    for (var other = first; other <= last; other++) {
        let reach = own_reaches[cell - column + other];
        let apart = max(column, other) - min(column, other);
        if reach > longest && apart <= u32(reach * parameters.grid.per_cell) + 1u {
            longest = reach;
        }
    }
    reaches_along_rows[cell] = longest;
}

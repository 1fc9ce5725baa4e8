// Search radius in each cell that finds all particles whose support covers a particle there. Twin of `Cells::set_reach` in the crate sph.
#import declared

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let cell = id.x;
    if cell >= parameters.grid.columns * parameters.grid.rows {
        return;
    }
    let row = cell / parameters.grid.columns;
    let column = cell % parameters.grid.columns;
    let first = row - min(row, parameters.farthest);
    let last = min(row + parameters.farthest, parameters.grid.rows - 1u);
    var longest = 0.0;
    for (var other = first; other <= last; other++) {
        let reach = reaches_along_rows[other * parameters.grid.columns + column];
        let apart = max(row, other) - min(row, other);
        if reach > longest && reach >= f32(max(apart, 1u) - 1u) * parameters.grid.cell {
            longest = reach;
        }
    }
    reaches[cell] = longest;
}

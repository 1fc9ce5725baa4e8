// The longest reach in each cell, m.
#import declared

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let cell = id.x;
    if cell >= parameters.grid.columns * parameters.grid.rows {
        return;
    }
    var longest = 0.0;
    for (var i = start[cell]; i < start[cell + 1u]; i++) {
        longest = max(longest, spots[i].w);
    }
    own_reaches[cell] = longest;
}

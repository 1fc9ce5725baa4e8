// The longest reach in each cell, m.
#import flood_card

@group(0) @binding(0) var<uniform> parameters: Parameters;
@group(0) @binding(1) var<storage, read> start: array<u32>;
@group(0) @binding(2) var<storage, read> sites: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> own: array<f32>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let cell = id.x;
    if cell >= parameters.grid.columns * parameters.grid.rows {
        return;
    }
    var longest = 0.0;
    for (var i = start[cell]; i < start[cell + 1u]; i++) {
        longest = max(longest, sites[i].w);
    }
    own[cell] = longest;
}

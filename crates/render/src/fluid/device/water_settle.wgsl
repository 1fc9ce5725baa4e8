// Takes down what stands steeper than water can. Twin of `settle` in `water.rs`.
#import water_device

@group(0) @binding(0) var<uniform> water: Water;
@group(0) @binding(1) var<storage, read> start: array<u32>;
@group(0) @binding(2) var<storage, read> sites: array<vec4f>;
@group(0) @binding(3) var<storage, read> motions: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> settled: array<vec4f>;
// See `water_begin`.
@group(0) @binding(5) var<storage, read_write> sizes: array<atomic<u32>>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= start[of_ground(water)] {
        return;
    }
    let own = sites[i];
    let reach = REACH * own.w;
    let steepest = STEEPEST + length(motions[i].zw);
    let low = cell_at(water, own.xy - reach);
    let high = cell_at(water, own.xy + reach);
    var height = own.z;
    for (var row = low.y; row <= high.y; row++) {
        let end = start[row * water.columns + high.x + 1u];
        for (var k = start[row * water.columns + low.x]; k < end; k++) {
            let near = sites[k].xyz;
            let distance = length(near.xy - own.xy);
            height = select(height, min(height, near.z + steepest * distance), distance < reach);
        }
    }
    settled[i] = vec4f(own.xy, height, own.w);
    if height < own.z {
        atomicMax(&sizes[2], 1u);
    }
}

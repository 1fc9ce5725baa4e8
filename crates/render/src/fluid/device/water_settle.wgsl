// Limits the slope of the surface. Twin of `settle` in `water.rs`.
#import water_device

@compute @workgroup_size(GROUP)
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
        atomicMax(&sizes.has_changed, 1u);
    }
}

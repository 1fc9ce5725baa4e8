// Particles tremble, more so in scheme sph-swe; what is seen is what they do together. What is in the air stays as it is.
#import water_planes

@group(0) @binding(4) var<storage, read_write> calm_sites: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> calm_motions: array<vec4f>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= start[of_ground(water) + 1u] {
        return;
    }
    let own = sites[i];
    if i >= start[of_ground(water)] {
        calm_sites[i] = own;
        return;
    }
    let here = fit_at(i).here;
    calm_sites[i] = vec4f(own.xy, here.x, own.w);
    calm_motions[i] = vec4f(here.yz, motions[i].zw);
}

// Particles are noisy, more so in scheme sph-swe: their mean motion is drawn. Particles in the air are unchanged.
#import water_planes

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let i = id.x;
    if i >= start[of_ground(water) + 1u] {
        return;
    }
    let own = sites[i];
    if i >= start[of_ground(water)] {
        settled[i] = own;
        return;
    }
    let here = fit_at(i).here;
    settled[i] = vec4f(own.xy, here.x, own.w);
    calmed[i] = vec4f(here.yz, motions[i].zw);
}

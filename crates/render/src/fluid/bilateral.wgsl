// Bilateral Gaussian filter of depth, rows and columns apart as is usual for speed (Tomasi and Manduchi 1998; for fluids
// van der Laan, Green and Sainz 2009 and the flood paper of 2021, which repeats it).
#import smoothing

@compute @workgroup_size(PIXELS_ACROSS, PIXELS_DOWN)
fn along(@builtin(global_invocation_id) id: vec3u) {
    let pixel = vec2i(id.xy);
    if any(pixel >= vec2i(textureDimensions(distances))) {
        return;
    }
    let here = distance_at(pixel);
    var sum = here;
    var weights = 1.0;
    let width = select(0, width_in_pixels(here), here > 0.0);
    let sigma = max(f32(width) / 3.0, 0.5);
    for (var out = 1; out <= width; out++) {
        let spatial = gauss(f32(out), sigma);
        for (var side = -1; side <= 1; side += 2) {
            let there = distance_at(pixel + side * out * direction.step);
            let weight = select(0.0, spatial * gauss(there - here, fluid.smoothing.y), there > 0.0);
            sum += weight * there;
            weights += weight;
        }
    }
    textureStore(smoothed, pixel, vec4f(sum / weights));
}

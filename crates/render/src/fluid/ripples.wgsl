// Patterns that go with the water: ripples, foam and caustics. A pattern is carried by the velocity at each position for a while, then comes anew;
// two of them take turns, so that none is seen to come or go (Max and Becker, "Flow Visualization Using Moving Textures", 1995).
#import fluid
#import noise

// A pattern at a position: where it has come from, in lengths of the longest ripples, and how much it counts.
struct Carried {
    at: vec2f,
    weight: f32,
}

// The two patterns of now that water of a velocity, stage units a second, has brought to a position.
fn carried(position: vec2f, velocity: vec2f) -> array<Carried, 2> {
    var both = array(Carried(), Carried());
    for (var k = 0; k < 2; k++) {
        let turns = fluid.ripples.z / fluid.ripples.w + 0.5 * f32(k);
        let age = fract(turns);
        // Another piece of the pattern at each turn.
        let piece = vec2f(37.0, 17.0) * (floor(turns) % 64.0 + 100.0 * f32(k));
        let origin = position - velocity * (age - 0.5) * fluid.ripples.w;
        both[k] = Carried(origin / fluid.ripples.x + piece, 1.0 - abs(2.0 * age - 1.0));
    }
    return both;
}

// How much of a pattern of a length is seen where a pixel is so large, stage units.
fn seen_of(length: f32, pixel: f32) -> f32 {
    return clamp(length / pixel / 3.0 - 0.6, 0.0, 1.0);
}

// Ripples of a length run through the water as waves of deep water do: the speed is sqrt(g length / 2 pi), here in lengths a second.
fn run_of(length: f32) -> f32 {
    return sqrt(GRAVITY / (2.0 * PI * length * view.frame.z));
}

// Slope of the ripples, each octave half as long as the one before.
fn ripples(both: array<Carried, 2>, pixel: f32) -> vec2f {
    var patterns = both;
    var slope = vec2f(0.0);
    var length = fluid.ripples.x;
    var scale = 1.0;
    for (var octave = 0; octave < 4; octave++) {
        let seen = seen_of(length, pixel);
        if seen > 0.0 {
            let run = 0.5 * run_of(length) * fluid.ripples.z;
            let turned = mat2x2f(0.8, 0.6, -0.6, 0.8);
            for (var k = 0; k < 2; k++) {
                let at = patterns[k].at * scale;
                // Two that run across each other never look alike.
                let one = bumps(at + vec2f(run, 0.3 * run) + 11.0 * f32(octave));
                let other = bumps(turned * (1.3 * at) - vec2f(0.2 * run, run));
                slope += seen * patterns[k].weight * (one.slope + transpose(turned) * other.slope);
            }
        }
        length *= 0.5;
        scale *= 2.0;
    }
    return 0.5 * slope;
}

// Whether foam that covers a part of the water is at a position: threads and patches, from 0 to 1.
fn lace(both: array<Carried, 2>, part: f32, pixel: f32) -> f32 {
    var patterns = both;
    var covered = 0.0;
    let fine = seen_of(0.25 * fluid.ripples.x, pixel);
    for (var k = 0; k < 2; k++) {
        let at = 2.0 * patterns[k].at;
        let large = bumps(at).height;
        // Ridges where two levels of noise meet look like threads.
        let threads = 1.0 - abs(2.0 * bumps(2.3 * at + 3.0 * large + 5.0).height - 1.0);
        let grain = mix(0.5, bumps(7.1 * at).height, fine);
        let pattern = 0.40 * large + 0.42 * threads + 0.18 * grain;
        covered += patterns[k].weight * smoothstep(0.84 - 0.36 * part, 1.06 - 0.40 * part, pattern);
    }
    return covered;
}

// Light that waves gather on the bed, over its mean: bright threads between wide dim cells.
fn caustics(both: array<Carried, 2>, pixel: f32) -> f32 {
    var patterns = both;
    var light = 0.0;
    let run = run_of(0.5 * fluid.ripples.x) * fluid.ripples.z;
    for (var k = 0; k < 2; k++) {
        let at = 2.0 * patterns[k].at;
        let one = 1.0 - abs(2.0 * bumps(at + 0.5 * run).height - 1.0);
        let other = 1.0 - abs(2.0 * bumps(mat2x2f(0.8, 0.6, -0.6, 0.8) * at * 1.2 - 0.4 * run).height - 1.0);
        light += patterns[k].weight * pow(one * other, 3.0);
    }
    return seen_of(0.5 * fluid.ripples.x, pixel) * (3.0 * light - 0.6);
}

// From linear light to the bytes of a picture: samples averaged, highlights pressed, the overlay laid over.

struct Tone {
    // Samples each way in a pixel.
    samples: u32,
    // 0 for colours as they are.
    pressed: u32,
    overlay: u32,
    unused: u32,
}

@group(0) @binding(0) var<uniform> tone: Tone;
@group(0) @binding(1) var light: texture_2d<f32>;
@group(0) @binding(2) var overlay: texture_2d<f32>;

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    return vec4f(4.0 * corner - 1.0, 0.0, 1.0);
}

// Presses highlights below 1 and leaves base colours as they are (Khronos PBR Neutral tone mapper, 2024).
fn press(colour: vec3f) -> vec3f {
    let start = 0.8 - 0.04;
    let least = min(colour.r, min(colour.g, colour.b));
    let offset = select(0.04, least - 6.25 * least * least, least < 0.08);
    let base = colour - offset;
    let peak = max(base.r, max(base.g, base.b));
    if peak < start {
        return base;
    }
    let room = 1.0 - start;
    let pressed = 1.0 - room * room / (peak + room - start);
    let grey = 1.0 - 1.0 / (0.15 * (peak - pressed) + 1.0);
    return mix(base * pressed / peak, vec3f(pressed), grey);
}

// sRGB from linear light (IEC 61966-2-1).
fn encode(colour: vec3f) -> vec3f {
    let high = 1.055 * pow(max(colour, vec3f(0.0)), vec3f(1.0 / 2.4)) - 0.055;
    return select(high, 12.92 * colour, colour <= vec3f(0.0031308));
}

@fragment
fn fragment(@builtin(position) place: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(place.xy);
    var sum = vec3f(0.0);
    for (var y = 0u; y < tone.samples; y++) {
        for (var x = 0u; x < tone.samples; x++) {
            let sample = textureLoad(light, pixel * tone.samples + vec2u(x, y), 0).rgb;
            // Pressed before they are averaged: one bright sample must not outweigh its neighbours.
            sum += select(clamp(sample, vec3f(0.0), vec3f(1.0)), press(max(sample, vec3f(0.0))), tone.pressed == 1u);
        }
    }
    var colour = encode(sum / f32(tone.samples * tone.samples));
    if tone.overlay == 1u {
        // Opacity is multiplied in already.
        let over = textureLoad(overlay, pixel, 0);
        colour = over.rgb + (1.0 - over.a) * colour;
    }
    return vec4f(colour, 1.0);
}

// From linear light to the bytes of a picture: samples averaged, highlights pressed, the overlay laid over.
#import declared
#import press
#import full_screen

@group(0) @binding(0) var<uniform> tone: Tone;
@group(0) @binding(1) var light: texture_2d<f32>;
@group(0) @binding(2) var overlay: texture_2d<f32>;

// The mean of a pixel's samples, of those that show something where the background is left out, and their part.
fn covered_pixel_at(pixel: vec2u) -> vec4f {
    var sum = vec4f(0.0);
    for (var y = 0u; y < tone.samples; y++) {
        for (var x = 0u; x < tone.samples; x++) {
            let sample = textureLoad(light, pixel * tone.samples + vec2u(x, y), 0);
            let opacity = select(1.0, sample.a, tone.transparent == 1u);
            // Pressed before they are averaged: one bright sample must not outweigh its neighbours.
            let plain = clamp(sample.rgb, vec3f(0.0), vec3f(1.0));
            sum += opacity * vec4f(select(plain, press(max(sample.rgb, vec3f(0.0))), tone.pressed == 1u), 1.0);
        }
    }
    return vec4f(encode(sum.rgb / max(sum.a, 1e-6)), sum.a / f32(tone.samples * tone.samples));
}

fn pixel_at(pixel: vec2u) -> vec3f {
    return covered_pixel_at(pixel).rgb;
}

fn brightness(colour: vec3f) -> f32 {
    return dot(colour, vec3f(0.299, 0.587, 0.114));
}

// A pixel whose neighbours' brightness shows an edge through it, mixed along the edge: with one sample a pixel edges are steps
// otherwise (FXAA: Lottes 2009, the short variant, with pixels in place of samples between them).
fn softened(pixel: vec2u) -> vec3f {
    let last = vec2i(textureDimensions(light)) - 1;
    let here = vec2i(pixel);
    let own = pixel_at(pixel);
    let north_west = brightness(pixel_at(vec2u(clamp(here + vec2i(-1, -1), vec2i(0), last))));
    let north_east = brightness(pixel_at(vec2u(clamp(here + vec2i(1, -1), vec2i(0), last))));
    let south_west = brightness(pixel_at(vec2u(clamp(here + vec2i(-1, 1), vec2i(0), last))));
    let south_east = brightness(pixel_at(vec2u(clamp(here + vec2i(1, 1), vec2i(0), last))));
    let middle = brightness(own);
    let least = min(middle, min(min(north_west, north_east), min(south_west, south_east)));
    let most = max(middle, max(max(north_west, north_east), max(south_west, south_east)));
    if most - least < max(0.04, 0.1 * most) {
        return own;
    }
    let slope = vec2f((south_west + south_east) - (north_west + north_east), (north_west + south_west) - (north_east + south_east));
    let along = clamp(slope / max(min(abs(slope.x), abs(slope.y)), 1.0 / 128.0), vec2f(-4.0), vec2f(4.0));
    let near = 0.5 * (between(pixel, along * (1.0 / 3.0 - 0.5)) + between(pixel, along * (2.0 / 3.0 - 0.5)));
    let far = 0.5 * near + 0.25 * (between(pixel, -0.5 * along) + between(pixel, 0.5 * along));
    let found = brightness(far);
    return select(far, near, found < least || found > most);
}

// The picture at an offset from the middle of a pixel, mixed of the four pixels round it.
fn between(pixel: vec2u, offset: vec2f) -> vec3f {
    let position = vec2f(pixel) + offset;
    let corner = floor(position);
    let part = position - corner;
    let last = vec2f(textureDimensions(light)) - 1.0;
    let low = vec2u(clamp(corner, vec2f(0.0), last));
    let high = vec2u(clamp(corner + 1.0, vec2f(0.0), last));
    let upper = mix(pixel_at(low), pixel_at(vec2u(high.x, low.y)), part.x);
    let lower = mix(pixel_at(vec2u(low.x, high.y)), pixel_at(high), part.x);
    return mix(upper, lower, part.y);
}

// A pixel with its opacity, under the overlay. PNG files hold colours without their opacity multiplied in.
fn without_background(pixel: vec2u) -> vec4f {
    let own = covered_pixel_at(pixel);
    var over = vec4f(0.0);
    if tone.overlay == 1u {
        over = textureLoad(overlay, pixel, 0);
    }
    let opacity = over.a + (1.0 - over.a) * own.a;
    if opacity <= 0.0 {
        return vec4f(1.0, 1.0, 1.0, 0.0);
    }
    return vec4f((over.rgb + (1.0 - over.a) * own.a * own.rgb) / opacity, opacity);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(position.xy);
    if tone.transparent == 1u {
        return without_background(pixel);
    }
    var colour = pixel_at(pixel);
    if tone.samples == 1u && tone.pressed == 1u {
        colour = softened(pixel);
    }
    if tone.overlay == 1u {
        // Opacity is multiplied in already.
        let over = textureLoad(overlay, pixel, 0);
        colour = over.rgb + (1.0 - over.a) * colour;
    }
    return vec4f(colour, 1.0);
}

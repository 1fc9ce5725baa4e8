// From linear light to the bytes of a picture, colour by colour.
#import declared

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
    let high = SRGB_SCALE * pow(max(colour, vec3f(0.0)), vec3f(1.0 / SRGB_EXPONENT)) - SRGB_OFFSET;
    return select(high, SRGB_SLOPE * colour, colour <= vec3f(SRGB_LINE_END_LINEAR));
}

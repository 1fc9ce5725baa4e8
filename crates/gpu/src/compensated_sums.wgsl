// Compensated sums, as pairs of a value and its error term, to be added; and counts of more than 32 bits. The importing declaration has `parameters.zero`: always 0, read at
// run time so that the optimiser keeps the sums.
#import declared

// The number itself: its zero is read at run time, so that the optimiser keeps (a + b) - a.
fn opaque(number: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(number) ^ parameters.zero);
}

// Adds a number without error (Knuth 1997, volume 2, theorem 4.2.2 B).
fn add(pair: vec2f, value: f32) -> vec2f {
    let sum = opaque(pair.x + value);
    let back = opaque(sum - pair.x);
    let error = opaque(pair.x - opaque(sum - back)) + opaque(value - back);
    return vec2f(sum, pair.y + error);
}

// The same sum with the second number as small as rounding of the first, and short enough that both fit in double precision together.
fn tidy(pair: vec2f) -> vec2f {
    let sum = opaque(pair.x + pair.y);
    let low = opaque(pair.y - opaque(sum - pair.x));
    // 2^-23 of the sum: what is smaller than 2^-48 of it is rounded off.
    let coarse = 1.1920929e-7 * abs(sum);
    return vec2f(sum, opaque(opaque(low + coarse) - coarse));
}

fn add_pair(a: vec2f, b: vec2f) -> vec2f {
    let sum = add(a, b.x);
    return vec2f(sum.x, sum.y + b.y);
}

// The number that a pair stands for.
fn total(pair: vec2f) -> f32 {
    return pair.x + pair.y;
}

// a - b, exact where both are near each other.
fn difference(a: vec2f, b: vec2f) -> f32 {
    return (a.x - b.x) + (a.y - b.y);
}

// Adds to a count of which the low and the high half are kept.
fn count_up(halves: vec2u, more: u32) -> vec2u {
    let low = halves.x + more;
    return vec2u(low, halves.y + u32(low < more));
}

// By its bits: compilers take a comparison that does not hold for its opposite.
fn is_finite(number: f32) -> bool {
    return (bitcast<u32>(number) & 0x7f800000u) != 0x7f800000u;
}

//! Smooth noise: gradient noise after Perlin (2002), from sums and products only, so the same on every machine.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Numbers in a table; the noise repeats after this many lattice steps along each axis.
const TABLE: usize = 256;

/// Noise that belongs to one seed.
pub(super) struct Noise {
    /// Unit vectors.
    gradients: Vec<[f64; 2]>,
    /// A shuffle of the table's indices.
    order: Vec<usize>,
}

impl Noise {
    /// Noise for a seed; different `stream`s of one seed have nothing in common.
    pub(super) fn new(seed: u64, stream: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(stream);
        let gradients = (0..TABLE).map(|_| unit_vector(&mut random)).collect();
        let mut order: Vec<usize> = (0..TABLE).collect();
        // Fisher and Yates; the modulus' bias of 2^-56 is no matter.
        for last in (1..TABLE).rev() {
            order.swap(last, (random.next_u64() % (last as u64 + 1)) as usize);
        }
        Self { gradients, order }
    }

    /// Smooth noise with hills one unit wide, about -0.7 to 0.7, 0 on average and at whole numbers.
    pub(super) fn at(&self, x: f64, y: f64) -> f64 {
        let (column, row) = (x.floor(), y.floor());
        let (u, v) = (x - column, y - row);
        let corner = |i: f64, j: f64| {
            let index = |position: f64| (position as i64).rem_euclid(TABLE as i64) as usize;
            let gradient = self.gradients[self.order[(self.order[index(column + i)] + index(row + j)) % TABLE]];
            gradient[0] * (u - i) + gradient[1] * (v - j)
        };
        let (fade_u, fade_v) = (fade(u), fade(v));
        let south = mix(corner(0.0, 0.0), corner(1.0, 0.0), fade_u);
        let north = mix(corner(0.0, 1.0), corner(1.0, 1.0), fade_u);
        mix(south, north, fade_v)
    }

    /// Fractal noise: octaves of half the width and `roughness` times the height each, the first 1 wide, until they
    /// are narrower than `finest`.
    pub(super) fn fractal(&self, x: f64, y: f64, roughness: f64, finest: f64) -> f64 {
        octaves(finest)
            .fold((0.0, 1.0), |(sum, height), (octave, scale)| {
                let (x, y) = turned(x * scale, y * scale, octave);
                (sum + height * self.at(x, y), height * roughness)
            })
            .0
    }

    /// Fractal noise with sharp valleys and rounded ridges, 0 in the valleys to about 1; each octave is weaker where the coarser
    /// ones lie low, as slopes are where streams have gathered.
    pub(super) fn eroded(&self, x: f64, y: f64, roughness: f64, finest: f64) -> f64 {
        let mut weight = 1.0;
        let mut height = 1.0;
        let mut sum = 0.0;
        for (octave, scale) in octaves(finest) {
            let (x, y) = turned(x * scale, y * scale, octave);
            let value = (2.0 * self.at(x, y)).abs().min(1.0);
            sum += weight * height * value;
            weight = (weight * (0.25 + 1.5 * value)).min(1.0);
            height *= roughness;
        }
        sum * (1.0 - roughness)
    }
}

/// Number and scale of the octaves down to a width of `finest`, at least one.
fn octaves(finest: f64) -> impl Iterator<Item = (i32, f64)> {
    (0..24)
        .map(|octave| (octave, f64::from(1 << octave)))
        .take_while(move |(octave, scale)| *octave == 0 || finest * scale <= 1.0)
}

/// Turns and shifts an octave, so that the lattices of two octaves never lie on each other.
fn turned(x: f64, y: f64, octave: i32) -> (f64, f64) {
    // The angle of the triangle 3, 4, 5 is no part of a full turn.
    let (mut x, mut y) = (x, y);
    for _ in 0..octave {
        (x, y) = (0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y);
    }
    (x + 17.3 * f64::from(octave), y - 31.7 * f64::from(octave))
}

/// A direction, by rejection: no sine, whose last bits differ between machines.
fn unit_vector(random: &mut ChaCha8Rng) -> [f64; 2] {
    loop {
        let [x, y] = [coordinate(random), coordinate(random)];
        let square = x * x + y * y;
        if (0.01..=1.0).contains(&square) {
            let length = square.sqrt();
            return [x / length, y / length];
        }
    }
}

/// A number from -1 to 1.
fn coordinate(random: &mut ChaCha8Rng) -> f64 {
    (random.next_u64() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// 0 to 1 with no slope and no curvature at either end.
pub(super) fn fade(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * t * (t * (6.0 * t - 15.0) + 10.0)
}

/// From `a` to `b` as `t` goes from 0 to 1.
pub(super) fn mix(a: f64, b: f64, t: f64) -> f64 {
    a + t * (b - a)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_smooth_bounded_and_not_flat() {
        let noise = Noise::new(7, 0);
        let values: Vec<f64> = (0..4000).map(|i| noise.at(0.013 * f64::from(i), 0.0077 * f64::from(i))).collect();
        let largest = values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        assert!((0.3..0.8).contains(&largest), "{largest}");
        let jump = values.windows(2).fold(0.0_f64, |jump, pair| jump.max((pair[1] - pair[0]).abs()));
        assert!(jump < 0.05, "{jump}");
    }

    #[test]
    fn seeds_and_streams_differ_and_repeat() {
        let value = |seed, stream| Noise::new(seed, stream).fractal(12.3, -4.5, 0.5, 0.01);
        assert_eq!(value(1, 0).to_bits(), value(1, 0).to_bits());
        assert_ne!(value(1, 0), value(2, 0));
        assert_ne!(value(1, 0), value(1, 1));
    }
}

//! Random numbers of positions.

/// A number between -1 and 1 for each square `width` m wide, the same for the same seed.
pub(super) fn squares(width: f64, seed: u64) -> impl Fn(f64, f64) -> f64 + Copy + Send + Sync {
    move |x, y| {
        let [column, row] = [x, y].map(|at| (at / width).floor() as i64 as u64);
        let mixed = mix(mix(mix(seed) ^ column) ^ row.rotate_left(32));
        (mixed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// The finaliser of SplitMix64 (Steele, Lea & Flood 2014).
fn mix(value: u64) -> u64 {
    let value = value.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let value = (value ^ (value >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let value = (value ^ (value >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    value ^ (value >> 31)
}

#[cfg(test)]
mod tests {
    use super::squares;

    #[test]
    fn numbers_are_spread_evenly_and_differ_from_square_to_square() {
        let noise = squares(2.0, 5);
        let values: Vec<f64> =
            (0..10_000).map(|k| noise(f64::from(k % 100) * 2.0 - 99.0, f64::from(k / 100) * 2.0)).collect();
        let mean = values.iter().sum::<f64>() / 1e4;
        let square = values.iter().map(|value| value * value).sum::<f64>() / 1e4;
        assert!(mean.abs() < 0.02 && (square - 1.0 / 3.0).abs() < 0.01, "{mean} {square}");
        assert!(values.iter().all(|value| (-1.0..1.0).contains(value)));
        assert_eq!(noise(0.1, 0.2), noise(1.9, 1.8));
    }
}

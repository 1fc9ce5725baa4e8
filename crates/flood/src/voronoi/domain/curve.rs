//! Which process each tile belongs to: parts of a Hilbert curve over the tiles, with as much work each.

/// The process of each of `columns` x `rows` tiles, where each tile has so much work: parts of the curve as equal as tiles allow.
pub(super) fn owners([columns, rows]: [usize; 2], work: &[f64], count: usize) -> Vec<u16> {
    let side = columns.max(rows).next_power_of_two() as u32;
    let mut order: Vec<usize> = (0..columns * rows).collect();
    order.sort_by_cached_key(|tile| along_curve(side, [(tile % columns) as u32, (tile / columns) as u32]));
    let total: f64 = work.iter().sum();
    let mut owners = vec![0; columns * rows];
    let mut before = 0.0;
    for (position, tile) in order.iter().enumerate() {
        // Where there is no work at all, tiles count.
        let middle = if total > 0.0 {
            (before + 0.5 * work[*tile]) / total
        } else {
            (position as f64 + 0.5) / order.len() as f64
        };
        owners[*tile] = ((middle * count as f64) as usize).min(count - 1) as u16;
        before += work[*tile];
    }
    owners
}

/// How far along the Hilbert curve over `side` x `side` squares, a power of two, one lies (Hilbert 1891; Warren 2012, "Hacker's Delight", section 16-1).
fn along_curve(side: u32, [mut x, mut y]: [u32; 2]) -> u64 {
    let mut distance = 0;
    let mut half = side / 2;
    while half > 0 {
        let [right, upper] = [x & half > 0, y & half > 0].map(u64::from);
        distance += u64::from(half) * u64::from(half) * ((3 * right) ^ upper);
        if upper == 0 {
            if right == 1 {
                (x, y) = (side - 1 - x, side - 1 - y);
            }
            (x, y) = (y, x);
        }
        half /= 2;
    }
    distance
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_visits_each_square_once_and_goes_from_one_to_the_next() {
        let mut squares: Vec<[u32; 2]> = (0..256).map(|k| [k % 16, k / 16]).collect();
        squares.sort_by_key(|square| along_curve(16, *square));
        for (position, square) in squares.iter().enumerate() {
            assert_eq!(along_curve(16, *square), position as u64);
        }
        for pair in squares.windows(2) {
            assert_eq!(pair[0][0].abs_diff(pair[1][0]) + pair[0][1].abs_diff(pair[1][1]), 1, "{pair:?}");
        }
    }

    #[test]
    fn all_have_as_much_work() {
        let work: Vec<f64> = (0..30 * 17).map(|tile| f64::from(tile % 7)).collect();
        let owners = owners([30, 17], &work, 5);
        let mut sums = [0.0; 5];
        owners.iter().zip(&work).for_each(|(owner, work)| sums[usize::from(*owner)] += work);
        let mean = sums.iter().sum::<f64>() / 5.0;
        assert!(sums.iter().all(|sum| (sum / mean - 1.0).abs() < 0.05), "{sums:?}");
        let idle = super::owners([4, 4], &[0.0; 16], 4);
        assert!((0..4).all(|process| idle.iter().filter(|owner| **owner == process).count() == 4));
    }
}

//! Cells without data.

use corpuscle_scene::NoData;

/// Height of a wall above the highest ground, m: more than any water stands above it.
const WALL_ABOVE: f64 = 50.0;

/// Sweeps that smooth filled ground.
const SWEEPS: usize = 20;

/// Puts ground where there is none (not-a-number): a level wall [`WALL_ABOVE`] the highest ground, or ground that
/// joins that round it. `columns * rows` heights, at least one of them a number.
pub(crate) fn close(heights: &mut [f64], [columns, rows]: [usize; 2], what: NoData) {
    match what {
        NoData::Wall => {
            let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            heights.iter_mut().filter(|height| height.is_nan()).for_each(|height| *height = highest + WALL_ABOVE);
        }
        NoData::Fill => {
            let holes: Vec<usize> = (0..heights.len()).filter(|&index| heights[index].is_nan()).collect();
            fill(heights, [columns, rows]);
            smooth(heights, [columns, rows], &holes);
        }
    }
}

/// Fills holes from coarser and coarser means of the cells that have data (pull-push): half the resolution, filled the
/// same way, then bilinear between its cells.
fn fill(heights: &mut [f64], [columns, rows]: [usize; 2]) {
    if heights.iter().all(|height| !height.is_nan()) {
        return;
    }
    let half = [columns.div_ceil(2), rows.div_ceil(2)];
    let mut coarse: Vec<f64> = (0..half[0] * half[1])
        .map(|index| mean_of_four(heights, [columns, rows], [2 * (index % half[0]), 2 * (index / half[0])]))
        .collect();
    fill(&mut coarse, half);
    for (index, height) in heights.iter_mut().enumerate().filter(|(_, height)| height.is_nan()) {
        *height = between(&coarse, half, [index % columns, index / columns]);
    }
}

/// Mean of those of four cells that have data; not-a-number where none has.
fn mean_of_four(heights: &[f64], [columns, rows]: [usize; 2], [column, row]: [usize; 2]) -> f64 {
    let cells = [(column, row), (column + 1, row), (column, row + 1), (column + 1, row + 1)];
    let (sum, count) = cells
        .iter()
        .filter(|(column, row)| *column < columns && *row < rows)
        .map(|(column, row)| heights[row * columns + column])
        .filter(|height| !height.is_nan())
        .fold((0.0, 0.0), |(sum, count), height| (sum + height, count + 1.0));
    sum / count
}

/// Bilinear value at a fine cell's centre from a grid of twice the cell size.
fn between(coarse: &[f64], size: [usize; 2], fine: [usize; 2]) -> f64 {
    // The centre of a fine cell lies a quarter of a coarse cell from that of its coarse cell: weights 3/4 and 1/4.
    let beside = |axis: usize| {
        let own = fine[axis] / 2;
        let other = if fine[axis].is_multiple_of(2) { own.saturating_sub(1) } else { (own + 1).min(size[axis] - 1) };
        [(own, 0.75), (other, 0.25)]
    };
    let mut height = 0.0;
    for (row, row_weight) in beside(1) {
        for (column, column_weight) in beside(0) {
            height += row_weight * column_weight * coarse[row * size[0] + column];
        }
    }
    height
}

/// Takes the steps out of filled ground: each filled cell becomes the mean of its neighbours, repeatedly.
fn smooth(heights: &mut [f64], [columns, rows]: [usize; 2], holes: &[usize]) {
    let mut smoothed = vec![0.0; holes.len()];
    for _ in 0..SWEEPS {
        for (target, &index) in smoothed.iter_mut().zip(holes) {
            let (column, row) = (index % columns, index / columns);
            let west = index - usize::from(column > 0);
            let east = index + usize::from(column + 1 < columns);
            let north = if row > 0 { index - columns } else { index };
            let south = if row + 1 < rows { index + columns } else { index };
            *target = 0.25 * (heights[west] + heights[east] + heights[north] + heights[south]);
        }
        for (value, &index) in smoothed.iter().zip(holes) {
            heights[index] = *value;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [usize; 2] = [13, 9];

    /// A plane with a hole of 5 x 3 cells.
    fn plane_with_hole() -> Vec<f64> {
        (0..SIZE[0] * SIZE[1])
            .map(|index| {
                let (column, row) = (index % SIZE[0], index / SIZE[0]);
                let hole = (4..9).contains(&column) && (3..6).contains(&row);
                if hole { f64::NAN } else { 2.0 * column as f64 - row as f64 }
            })
            .collect()
    }

    #[test]
    fn a_wall_stands_over_everything() {
        let mut heights = plane_with_hole();
        close(&mut heights, SIZE, NoData::Wall);
        assert_eq!(heights[4 * SIZE[0] + 6], 24.0 + WALL_ABOVE);
        assert_eq!(heights[0], 0.0);
    }

    #[test]
    fn a_filled_hole_joins_the_ground_round_it() {
        let mut heights = plane_with_hole();
        close(&mut heights, SIZE, NoData::Fill);
        for (index, height) in heights.iter().enumerate() {
            let plane = 2.0 * (index % SIZE[0]) as f64 - (index / SIZE[0]) as f64;
            assert!((height - plane).abs() < 0.3, "cell {index}: {height} on a plane at {plane}");
        }
    }

    #[test]
    fn one_cell_of_data_fills_everything() {
        let mut heights = vec![f64::NAN; 7 * 5];
        heights[11] = 3.5;
        close(&mut heights, [7, 5], NoData::Fill);
        assert!(heights.iter().all(|height| (height - 3.5).abs() < 1e-12));
    }
}

//! The part of a terrain that maps show: all of it, or where the water was if that is a small part.

/// Margin round the cells and positions shown, over their longer side.
const MARGIN: f64 = 0.12;

/// Least margin, cells.
const LEAST_MARGIN: f64 = 8.0;

/// The shorter side over the longer at least: a river's map shows its surroundings too.
const LEAST_ASPECT: f64 = 0.6;

/// A window larger than this part of the grid is widened to all of it.
const NEARLY_ALL: f64 = 0.5;

/// A rectangle of cells of a terrain's map grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Window {
    /// First column and row, counted from the north-west.
    pub first: [usize; 2],
    /// Columns and rows.
    pub count: [usize; 2],
}

impl Window {
    /// All of a grid.
    pub(crate) fn whole(grid: [usize; 2]) -> Self {
        Self { first: [0, 0], count: grid }
    }

    /// Round positions given as fractional (column, row), on a grid with cells of `cell` m; all of it where they lie all over
    /// it, or where there are none.
    pub(crate) fn round(grid: [usize; 2], cell: [f64; 2], positions: impl Iterator<Item = [f64; 2]>) -> Self {
        let none = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        let range = positions.fold(none, |range, position| {
            [0, 1].map(|axis| [range[axis][0].min(position[axis]), range[axis][1].max(position[axis])])
        });
        if range[0][0] > range[0][1] {
            return Self::whole(grid);
        }
        let length = [0, 1].map(|axis| (range[axis][1] - range[axis][0] + 1.0) * cell[axis]);
        let longer = length[0].max(length[1]);
        let window = [0, 1].map(|axis| {
            let margin = (MARGIN * longer / cell[axis]).max(LEAST_MARGIN);
            let wanted = length[axis].max(LEAST_ASPECT * longer) / cell[axis];
            let half = 0.5 * wanted + margin;
            let middle = 0.5 * (range[axis][0] + range[axis][1]) + 0.5;
            let last = grid[axis] as f64;
            let first = (middle - half).clamp(0.0, last - 1.0).floor();
            [first as usize, ((middle + half).min(last).ceil() as usize).saturating_sub(first as usize).max(1)]
        });
        let found = Self { first: window.map(|[first, _]| first), count: window.map(|[_, count]| count) };
        let part = found.count[0] as f64 * found.count[1] as f64 / (grid[0] as f64 * grid[1] as f64);
        if part > NEARLY_ALL { Self::whole(grid) } else { found }
    }

    /// The values in the window of a field with `columns` columns.
    pub(crate) fn crop(&self, values: &[f32], columns: usize) -> Vec<f32> {
        let ([column, row], [width, height]) = (self.first, self.count);
        let rows = values.chunks_exact(columns).skip(row).take(height);
        rows.flat_map(|values| &values[column..column + width]).copied().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_flood_is_shown_close_and_a_large_one_whole() {
        let of = |positions: &[[f64; 2]]| Window::round([400, 300], [10.0, 10.0], positions.iter().copied());
        assert_eq!(of(&[]), Window::whole([400, 300]));
        assert_eq!(of(&[[0.0, 0.0], [399.0, 299.0]]), Window::whole([400, 300]));
        let close = of(&[[100.0, 100.0], [199.0, 110.0]]);
        assert!(close.count[0] > 120 && close.count[0] < 130, "{close:?}");
        // A long, narrow flood has its surroundings on both sides.
        assert!(close.count[1] > 60 && close.first[1] < 75, "{close:?}");
        let corner = of(&[[399.0, 299.0]]);
        assert_eq!([0, 1].map(|axis| corner.first[axis] + corner.count[axis]), [400, 300]);
    }

    #[test]
    fn values_are_cut_out_row_by_row() {
        let values: Vec<f32> = (0..20_u8).map(f32::from).collect();
        let window = Window { first: [1, 2], count: [3, 2] };
        assert_eq!(window.crop(&values, 5), [11.0, 12.0, 13.0, 16.0, 17.0, 18.0]);
    }
}

//! Outlines of obstacles: which positions are inside, and the way to the nearest wall.

use crate::polygon::is_inside;
use corpuscle_terrain::Bounds;

/// A polygon of rings, each closed by itself; positions that an odd number of them hold are inside.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Outline {
    /// The obstacle that it is a part of.
    pub obstacle: usize,
    /// Corners of the rings, m.
    pub rings: Vec<Vec<[f64; 2]>>,
}

/// The nearest point of a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Nearest {
    /// Distance, m; negative inside.
    pub distance: f64,
    /// Unit vector out of the obstacle.
    pub normal: [f64; 2],
    /// Number of the outline.
    pub outline: usize,
}

impl Outline {
    /// A rectangle round it.
    pub fn bounds(&self) -> Bounds {
        let along = |axis: usize| self.rings.iter().flatten().map(move |corner| corner[axis]);
        let [x_min, y_min] = [0, 1].map(|axis| along(axis).fold(f64::INFINITY, f64::min));
        let [x_max, y_max] = [0, 1].map(|axis| along(axis).fold(f64::NEG_INFINITY, f64::max));
        Bounds { x_min, y_min, x_max, y_max }
    }

    /// Its sides, from corner to corner.
    pub fn sides(&self) -> impl Iterator<Item = [[f64; 2]; 2]> {
        self.rings.iter().flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)).map(|(a, b)| [*a, *b]))
    }

    /// Whether a position is inside, by the even-odd rule.
    pub fn contains(&self, [x, y]: [f64; 2]) -> bool {
        self.rings.iter().filter(|ring| is_inside(ring, x, y)).count() % 2 == 1
    }

    /// The way from its nearest wall to a position, m.
    fn way_from_wall(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let way = |[a, b]: [[f64; 2]; 2]| {
            let side = [b[0] - a[0], b[1] - a[1]];
            let length_squared = side[0] * side[0] + side[1] * side[1];
            let along = ((x - a[0]) * side[0] + (y - a[1]) * side[1]) / length_squared.max(f64::MIN_POSITIVE);
            let along = along.clamp(0.0, 1.0);
            [x - (a[0] + along * side[0]), y - (a[1] + along * side[1])]
        };
        let length = |way: &[f64; 2]| way[0].hypot(way[1]);
        self.sides().map(way).min_by(|a, b| length(a).total_cmp(&length(b))).unwrap_or([f64::INFINITY; 2])
    }

    /// The nearest wall; `number` is that of this outline.
    pub fn nearest(&self, position: [f64; 2], number: usize) -> Nearest {
        let way = self.way_from_wall(position);
        let length = way[0].hypot(way[1]);
        let sign = if self.contains(position) { -1.0 } else { 1.0 };
        let normal = if length > 0.0 { way.map(|along| sign * along / length) } else { [0.0; 2] };
        Nearest { distance: sign * length, normal, outline: number }
    }
}

/// All outlines, with an index that finds those near a position.
#[derive(Debug, Default)]
pub(crate) struct Outlines {
    /// The outlines.
    pub all: Vec<Outline>,
    bounds: Option<Bounds>,
    size: f64,
    columns: usize,
    /// Outlines within a cell's size of each cell.
    near: Vec<Vec<u32>>,
}

/// The cells by which outlines are found.
#[cfg(feature = "gpu")]
#[derive(Debug, Clone, Copy)]
pub(crate) struct OutlineCells<'a> {
    /// South-west corner, m.
    pub corner: [f64; 2],
    /// Size of a cell, m.
    pub size: f64,
    pub columns: usize,
    /// Outlines near each cell, row by row.
    pub near: &'a [Vec<u32>],
}

/// Most cells of the grid by which outlines are found.
const MOST_CELLS: f64 = 1e6;
/// Most entries of all cells together, where one outline after another covers all of them.
const MOST_ENTRIES: f64 = 2e7;

impl Outlines {
    /// Takes outlines; positions within `reach` m of one are near it.
    pub fn new(all: Vec<Outline>, reach: f64) -> Self {
        let mut new = Self { all, ..Self::default() };
        let boxes: Vec<Bounds> = new.all.iter().map(|outline| widened(outline.bounds(), reach)).collect();
        let Some(bounds) = boxes.iter().copied().reduce(both) else { return new };
        let [width, height] = [bounds.x_max - bounds.x_min, bounds.y_max - bounds.y_min];
        new.size = reach.max((width * height / MOST_CELLS).sqrt()).max(width.max(height) / MOST_CELLS);
        let cells = |around: &Bounds, size: f64| around.size().map(|length| (length / size).floor() + 2.0);
        let entries = |size: f64| boxes.iter().map(|around| cells(around, size).iter().product::<f64>()).sum::<f64>();
        // In one cell there is one entry for each outline, whose box counts as four at least.
        while entries(new.size) > MOST_ENTRIES.max(8.0 * boxes.len() as f64) {
            new.size *= 2.0;
        }
        new.columns = (width / new.size) as usize + 1;
        new.near = vec![Vec::new(); new.columns * ((height / new.size) as usize + 1)];
        for (number, around) in boxes.iter().enumerate() {
            let index = |along: f64, low: f64| ((along - low) / new.size) as usize;
            for row in index(around.y_min, bounds.y_min)..=index(around.y_max, bounds.y_min) {
                for column in index(around.x_min, bounds.x_min)..=index(around.x_max, bounds.x_min) {
                    new.near[row * new.columns + column].push(number as u32);
                }
            }
        }
        new.bounds = Some(bounds);
        new
    }

    /// The cells by which they are found, where there are any.
    #[cfg(feature = "gpu")]
    pub fn by_cell(&self) -> Option<OutlineCells<'_>> {
        let corner = |bounds: Bounds| [bounds.x_min, bounds.y_min];
        let Self { bounds, size, columns, near, .. } = self;
        bounds.map(|bounds| OutlineCells { corner: corner(bounds), size: *size, columns: *columns, near })
    }

    /// The outlines that may be near a position.
    pub fn near(&self, [x, y]: [f64; 2]) -> &[u32] {
        match self.bounds {
            Some(bounds) if bounds.contains(x, y) => {
                let index = |along: f64, low: f64| ((along - low) / self.size) as usize;
                &self.near[index(y, bounds.y_min) * self.columns + index(x, bounds.x_min)]
            }
            _ => &[],
        }
    }

    /// The outline that a position is inside, by its nearest wall.
    pub fn around(&self, position: [f64; 2]) -> Option<Nearest> {
        let numbers = self.near(position).iter().map(|&number| number as usize);
        let mut holding = numbers.filter(|&number| self.all[number].contains(position));
        holding.next().map(|number| self.all[number].nearest(position, number))
    }

    /// Whether a position is inside one.
    pub fn hold(&self, position: [f64; 2]) -> bool {
        self.around(position).is_some()
    }

    /// The nearest wall of one outline.
    pub fn nearest_of(&self, number: usize, position: [f64; 2]) -> Nearest {
        self.all[number].nearest(position, number)
    }
}

fn widened(bounds: Bounds, by: f64) -> Bounds {
    Bounds { x_min: bounds.x_min - by, y_min: bounds.y_min - by, x_max: bounds.x_max + by, y_max: bounds.y_max + by }
}

fn both(a: Bounds, b: Bounds) -> Bounds {
    Bounds {
        x_min: a.x_min.min(b.x_min),
        y_min: a.y_min.min(b.y_min),
        x_max: a.x_max.max(b.x_max),
        y_max: a.y_max.max(b.y_max),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square_with_a_court() -> Outline {
        let square = |low: f64, high: f64| vec![[low, low], [high, low], [high, high], [low, high]];
        Outline { obstacle: 0, rings: vec![square(0.0, 10.0), square(4.0, 6.0)] }
    }

    #[test]
    fn a_court_is_not_inside() {
        let outline = square_with_a_court();
        assert!(outline.contains([1.0, 1.0]) && !outline.contains([5.0, 5.0]) && !outline.contains([-1.0, 5.0]));
        let within = outline.nearest([1.0, 5.0], 0);
        assert_eq!((within.distance, within.normal), (-1.0, [-1.0, 0.0]));
        let court = outline.nearest([4.5, 5.0], 0);
        assert_eq!((court.distance, court.normal), (0.5, [1.0, 0.0]));
    }

    #[test]
    fn outlines_are_found_near_them_and_not_elsewhere() {
        let far = Outline { obstacle: 1, rings: vec![vec![[50.0, 0.0], [52.0, 0.0], [51.0, 2.0]]] };
        let outlines = Outlines::new(vec![square_with_a_court(), far], 3.0);
        assert_eq!(outlines.around([1.0, 5.0]).unwrap().outline, 0);
        assert_eq!(outlines.around([51.0, 0.5]).unwrap().outline, 1);
        assert!(outlines.around([30.0, 1.0]).is_none() && outlines.around([5.0, 5.0]).is_none());
        assert!(outlines.near([12.5, 5.0]).contains(&0) && outlines.near([30.0, 1.0]).is_empty());
        assert!(outlines.near([1e9, -1e9]).is_empty());
    }

    #[test]
    fn the_index_stays_small_for_many_large_outlines() {
        let large = |obstacle: usize| {
            let high = 1e4 + obstacle as f64;
            Outline { obstacle, rings: vec![vec![[0.0, 0.0], [high, 0.0], [high, high], [0.0, high]]] }
        };
        let outlines = Outlines::new((0..2000).map(large).collect(), 1.0);
        assert!(outlines.near.iter().map(Vec::len).sum::<usize>() as f64 <= MOST_ENTRIES);
        assert_eq!(
            (outlines.near([1.0, 1.0]).len(), outlines.around([11999.5, 1.0]).map(|at| at.outline)),
            (2000, None)
        );
        assert_eq!(outlines.around([11998.5, 1.0]).map(|at| at.outline), Some(1999));
    }

    #[test]
    fn the_index_of_a_long_thin_outline_stays_small() {
        let thin = Outline { obstacle: 0, rings: vec![vec![[0.0, 0.0], [1e12, 0.0], [1e12, 1e-3], [0.0, 1e-3]]] };
        let outlines = Outlines::new(vec![thin], 1e-3);
        assert!(outlines.near.len() <= 4_000_000, "{}", outlines.near.len());
        assert!(outlines.around([5e11, 5e-4]).is_some());
    }
}

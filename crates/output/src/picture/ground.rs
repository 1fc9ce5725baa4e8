//! The ground as pictures need it: heights at pixels, and how the terrain's own coordinates lie in them.

use super::window::Window;
use corpuscle_terrain::Terrain;
use rayon::prelude::*;

/// Most pixels along one side of a map.
const MOST_PIXELS: f64 = 1500.0;
/// Pixels along the short side of a map at least; more elongated terrain is stretched.
const LEAST_PIXELS: f64 = 150.0;

/// Heights of the ground at the pixels of a map, and where that map lies.
#[derive(Debug, Clone)]
pub(crate) struct Ground {
    /// Columns and rows of cells of the terrain's map grid that it covers.
    pub grid: [usize; 2],
    /// Columns and rows of pixels.
    pub pixels: [usize; 2],
    /// Height at the centre of each pixel, m, row by row from the north-west; not-a-number where there is no data.
    pub heights: Vec<f32>,
    /// Extent `[east, north]`, m.
    pub extent: [f64; 2],
    /// North-west corner, in the terrain's own coordinates.
    pub corner: [f64; 2],
    /// Extent `[east, south]`, in the terrain's own coordinates.
    pub own_extent: [f64; 2],
    /// True where the own coordinates are degrees.
    pub geographic: bool,
    /// The reference system's name.
    pub system: Option<String>,
}

impl Ground {
    /// Samples a part of a terrain.
    pub(crate) fn of(terrain: &Terrain, window: &Window) -> Self {
        let grid = terrain.map_grid();
        let georeference = &grid.georeference;
        let cell = grid.cell_size();
        let [columns, rows] = window.count.map(|count| count as f64);
        let corner = [
            georeference.corner[0] + window.first[0] as f64 * georeference.cell[0],
            georeference.corner[1] - window.first[1] as f64 * georeference.cell[1],
        ];
        let extent = [columns * cell[0], rows * cell[1]];
        let pixels = pixels(extent);
        let own_extent = [columns * georeference.cell[0], rows * georeference.cell[1]];
        let height = |index: usize| {
            let pixel = [index % pixels[0], index / pixels[0]];
            let part = [0, 1].map(|axis| (pixel[axis] as f64 + 0.5) / pixels[axis] as f64);
            let [column, row] =
                [0, 1].map(|axis| window.first[axis] + (part[axis] * window.count[axis] as f64) as usize);
            let own = [corner[0] + part[0] * own_extent[0], corner[1] - part[1] * own_extent[1]];
            let [x, y] = terrain.to_model(own);
            if terrain.is_valid_cell(column, row) { terrain.height_once(x, y) as f32 } else { f32::NAN }
        };
        let heights = (0..pixels[0] * pixels[1]).into_par_iter().map(height).collect();
        let system = georeference.system.as_ref();
        Self {
            grid: window.count,
            pixels,
            heights,
            extent,
            corner,
            own_extent,
            geographic: system.is_some_and(|system| system.geographic),
            system: system.map(|system| system.name.clone()),
        }
    }

    /// Where a position in own coordinates lies on the map: 0 to 1 eastwards and southwards.
    pub(crate) fn part(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [(x - self.corner[0]) / self.own_extent[0], (self.corner[1] - y) / self.own_extent[1]]
    }

    /// Lowest and highest ground, m.
    pub(crate) fn height_range(&self) -> [f64; 2] {
        let range = self.heights.iter().filter(|height| !height.is_nan());
        let [low, high] =
            range.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], height| [low.min(*height), high.max(*height)]);
        if low <= high { [low, high].map(f64::from) } else { [0.0, 0.0] }
    }
}

/// Pixels of a map of this extent: true to scale unless it is very elongated.
fn pixels([east, north]: [f64; 2]) -> [usize; 2] {
    let scale = MOST_PIXELS / east.max(north);
    [east, north].map(|length| (length * scale).max(LEAST_PIXELS).round() as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_terrain::Bounds;

    #[test]
    fn pictures_are_bounded_and_true_to_scale() {
        assert_eq!(pixels([3000.0, 1500.0]), [1500, 750]);
        assert_eq!(pixels([0.02, 0.02]), [1500, 1500]);
        assert_eq!(pixels([40_000.0, 10.0]), [1500, 150]);
    }

    #[test]
    fn heights_and_places_agree_with_the_terrain() {
        let bounds = Bounds { x_min: 100.0, x_max: 300.0, y_min: 0.0, y_max: 100.0 };
        let terrain = Terrain::gridded(bounds, 10.0, |x, _| x);
        let ground = Ground::of(&terrain, &Window::whole([20, 10]));
        assert_eq!(ground.grid, [20, 10]);
        assert_eq!(ground.part([150.0, 75.0]), [0.25, 0.25]);
        let middle = ground.heights[ground.pixels[0] * 300 + 750];
        assert!((middle - 200.0).abs() < 0.2, "{middle}");
        let part = Ground::of(&terrain, &Window { first: [5, 5], count: [10, 5] });
        assert_eq!((part.corner, part.extent), ([150.0, 50.0], [100.0, 50.0]));
        let middle = part.heights[part.pixels[0] * 300 + 750];
        assert!((middle - 200.0).abs() < 0.2, "{middle}");
    }
}

//! A picture of the user on the terrain of a flood: an aerial photo for one. A PNG file covers the terrain from corner to corner, or a world
//! file beside it says where it lies; a GeoTIFF says so itself.

use crate::Error;
use corpuscle_drawing::png::decode_rgba;
use corpuscle_gpu::Image;
use corpuscle_scene::{read_bytes, read_text};
use corpuscle_terrain::{Photo, Terrain, Window};
use std::path::Path;

/// Endings of world files of a PNG file.
const WORLD_FILES: [&str; 3] = ["pgw", "pngw", "wld"];
/// Most pixels a side of what is laid on the terrain: what any texture can hold.
const MOST_PIXELS: f64 = 4096.0;

/// Endings of GeoTIFF files.
const GEOTIFF: [&str; 2] = ["tif", "tiff"];
/// Cells each way of the grid between whose nodes positions are interpolated: over a terrain projections bend by far less than a pixel within one.
const GRID_CELLS: usize = 32;

/// The picture of a file, PNG or GeoTIFF, as it lies on a terrain, from corner to corner. Beside it are the pixels of `natural`, which covers the
/// terrain.
///
/// # Errors
/// [`Error::GroundPicture`] where it or its world file cannot be read, or it lies nowhere on the terrain; [`Error::Terrain`] for a GeoTIFF
/// that cannot be read.
pub fn ground_picture(path: &Path, terrain: &Terrain, natural: &Image) -> Result<Image, Error> {
    let wrong = |what: String| Error::GroundPicture { path: path.into(), what };
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase()).unwrap_or_default();
    if GEOTIFF.iter().any(|geotiff| ending == *geotiff) {
        return of_geotiff(path, terrain, natural);
    }
    let bytes = read_bytes(path).map_err(|error| wrong(error.to_string()))?;
    let (width, height, rgba) = decode_rgba(&bytes).map_err(wrong)?;
    let photo = Image { width, height, rgba };
    let mut files = WORLD_FILES.into_iter().map(|ending| path.with_extension(ending));
    let Some(file) = files.find(|file| file.is_file()) else { return Ok(photo) };
    let in_file = |what: &str| wrong(format!("its world file {}: {what}", file.display()));
    let text = read_text(&file).map_err(|error| in_file(&error.to_string()))?;
    let world = World::parse(&text).ok_or_else(|| in_file("six numbers are wanted, the size of a pixel not 0"))?;
    let grid = PixelGrid::over(terrain, |position| Some(world.pixel(terrain.to_own(position))));
    grid.lay(&photo, natural).ok_or_else(|| in_file("the picture lies beside the terrain"))
}

/// The same of a GeoTIFF, of which only the part over the terrain is read.
fn of_geotiff(path: &Path, terrain: &Terrain, natural: &Image) -> Result<Image, Error> {
    let beside = || Error::GroundPicture { path: path.into(), what: "it lies beside the terrain".into() };
    let photo = Photo::open(path)?;
    let grid = PixelGrid::over(terrain, |position| photo.pixel(terrain, position));
    let window = grid.window(photo.size()).ok_or_else(beside)?;
    let [width, height] = window.size.map(|length| length as u32);
    let part = Image { width, height, rgba: photo.read(window)? };
    let [column, row] = window.first.map(|first| first as f64);
    grid.moved([-column, -row]).lay(&part, natural).ok_or_else(beside)
}

/// Columns and rows of a picture at the nodes of a grid over a terrain, row by row from the north-west; none where the terrain's position has no
/// counterpart.
struct PixelGrid {
    nodes: Vec<Option<[f64; 2]>>,
}

impl PixelGrid {
    /// Those that a function gives at positions, m.
    fn over(terrain: &Terrain, pixel: impl Fn([f64; 2]) -> Option<[f64; 2]>) -> Self {
        let bounds = terrain.bounds();
        let part = |node: usize| node as f64 / GRID_CELLS as f64;
        let x = |node: usize| bounds.x_min + part(node) * (bounds.x_max - bounds.x_min);
        let y = |node: usize| bounds.y_max - part(node) * (bounds.y_max - bounds.y_min);
        let nodes = (0..=GRID_CELLS).flat_map(|row| (0..=GRID_CELLS).map(move |column| (column, row)));
        Self { nodes: nodes.map(|(column, row)| pixel([x(column), y(row)])).collect() }
    }

    /// The same in a picture that begins elsewhere.
    fn moved(self, by: [f64; 2]) -> Self {
        let moved = |[column, row]: [f64; 2]| [column + by[0], row + by[1]];
        Self { nodes: self.nodes.into_iter().map(|node| node.map(moved)).collect() }
    }

    /// The part of a picture of a size that lies on the terrain, with a pixel round it; none where none does.
    fn window(&self, size: [usize; 2]) -> Option<Window> {
        let along = |axis: usize| {
            let along_axis = || self.nodes.iter().flatten().map(move |node| node[axis]);
            let (low, high) =
                (along_axis().fold(f64::INFINITY, f64::min), along_axis().fold(f64::NEG_INFINITY, f64::max));
            let (low, high) = ((low - 1.0).floor().max(0.0), (high + 2.0).ceil().min(size[axis] as f64));
            (low < high).then_some((low as usize, (high - low) as usize))
        };
        let ((column, columns), (row, rows)) = (along(0)?, along(1)?);
        Some(Window { first: [column, row], size: [columns, rows] })
    }

    /// Column and row at parts of the terrain's sides, from the north-west.
    fn at(&self, x: f64, y: f64) -> Option<[f64; 2]> {
        let cell = |part: f64| ((part * GRID_CELLS as f64).floor().clamp(0.0, GRID_CELLS as f64 - 1.0)) as usize;
        let (column, row) = (cell(x), cell(y));
        let (right, down) = (x * GRID_CELLS as f64 - column as f64, y * GRID_CELLS as f64 - row as f64);
        let node = |column: usize, row: usize| self.nodes[row * (GRID_CELLS + 1) + column];
        let [a, b] = [node(column, row)?, node(column + 1, row)?];
        let [c, d] = [node(column, row + 1)?, node(column + 1, row + 1)?];
        let along = |a: f64, b: f64| a + right * (b - a);
        Some(std::array::from_fn(|k| along(a[k], b[k]) + down * (along(c[k], d[k]) - along(a[k], b[k]))))
    }

    /// The picture from corner to corner of the terrain, as fine as it is there; none where it lies beside it.
    fn lay(&self, photo: &Image, natural: &Image) -> Option<Image> {
        // Pixels of the photo along two sides of a cell in the middle, times the cells.
        let middle = 0.5;
        let next = middle + 1.0 / GRID_CELLS as f64;
        let length = |to: Option<[f64; 2]>| {
            let (from, to) = (self.at(middle, middle)?, to?);
            Some((to[0] - from[0]).hypot(to[1] - from[1]) * GRID_CELLS as f64)
        };
        let lengths = [length(self.at(next, middle)), length(self.at(middle, next))];
        let least = [natural.width, natural.height];
        let size: [u32; 2] =
            std::array::from_fn(|k| lengths[k].unwrap_or(0.0).max(f64::from(least[k])).min(MOST_PIXELS).ceil() as u32);
        let mut rgba = Vec::with_capacity(4 * size[0] as usize * size[1] as usize);
        let mut is_seen = false;
        for row in 0..size[1] {
            for column in 0..size[0] {
                let [x, y] = [(column, size[0]), (row, size[1])].map(|(at, of)| (f64::from(at) + 0.5) / f64::from(of));
                let own = natural.pixel((x * f64::from(natural.width)) as u32, (y * f64::from(natural.height)) as u32);
                let seen = self.at(x, y).and_then(|at| bilinear(photo, at)).filter(|seen| seen[3] > 127);
                is_seen |= seen.is_some();
                // Where the terrain has no data there is none to be seen.
                let [red, green, blue, _] = seen.unwrap_or(own);
                rgba.extend([red, green, blue, own[3]]);
            }
        }
        is_seen.then_some(Image { width: size[0], height: size[1], rgba })
    }
}

/// Where a picture lies, in the terrain's own coordinates: x = a column + b row + c, y = d column + e row + f of the middle of a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
struct World {
    a: f64,
    b: f64,
    c: f64,
    d: f64,
    e: f64,
    f: f64,
}

impl World {
    /// Of the six lines of a world file, in their order a, d, b, e, c, f.
    fn parse(text: &str) -> Option<Self> {
        let numbers: Option<Vec<f64>> = text.split_whitespace().map(|word| word.parse().ok()).collect();
        let [a, d, b, e, c, f] = <[f64; 6]>::try_from(numbers?).ok()?;
        let world = Self { a, b, c, d, e, f };
        let is_finite = [a, b, c, d, e, f].iter().all(|number| number.is_finite());
        (is_finite && world.determinant() != 0.0).then_some(world)
    }

    fn determinant(&self) -> f64 {
        self.a * self.e - self.b * self.d
    }

    /// Column and row at a position, whole at middles of pixels.
    fn pixel(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (x, y) = (x - self.c, y - self.f);
        [self.e * x - self.b * y, self.a * y - self.d * x].map(|number| number / self.determinant())
    }
}

/// The colour between the middles of four pixels; none outside.
fn bilinear(photo: &Image, [column, row]: [f64; 2]) -> Option<[u8; 4]> {
    let last = [f64::from(photo.width) - 1.0, f64::from(photo.height) - 1.0];
    let inside = |at: f64, last: f64| (-0.5..=last + 0.5).contains(&at).then(|| at.clamp(0.0, last));
    let (x, y) = (inside(column, last[0])?, inside(row, last[1])?);
    let (low, high) = ([x.floor(), y.floor()], [x.ceil(), y.ceil()]);
    let pixel = |x: f64, y: f64| photo.pixel(x as u32, y as u32).map(f64::from);
    let rows = [low[1], high[1]].map(|row| {
        let (left, right) = (pixel(low[0], row), pixel(high[0], row));
        std::array::from_fn::<f64, 4, _>(|k| left[k] + (x - low[0]) * (right[k] - left[k]))
    });
    Some(std::array::from_fn(|k| (rows[0][k] + (y - low[1]) * (rows[1][k] - rows[0][k])).round() as u8))
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_terrain::Bounds;

    /// A terrain of 10 m x 10 m with natural ground of one colour.
    fn ground() -> (Terrain, Image) {
        let terrain = Terrain::gridded(Bounds { x_min: 0.0, x_max: 10.0, y_min: 0.0, y_max: 10.0 }, 1.0, |_, _| 0.0);
        (terrain, Image { width: 20, height: 20, rgba: [9, 9, 9, 255].repeat(400) })
    }

    /// 4 x 2 pixels: red counts columns, green rows.
    fn photo() -> Image {
        let pixel = |k: u8| [50 * (k % 4), 100 * (k / 4), 0, 255];
        Image { width: 4, height: 2, rgba: (0..8).flat_map(pixel).collect() }
    }

    /// The photo on a terrain, with the lines of its world file.
    fn laid(world: &str, terrain: &Terrain, natural: &Image) -> Option<Image> {
        let world = World::parse(world).unwrap();
        PixelGrid::over(terrain, |position| Some(world.pixel(terrain.to_own(position)))).lay(&photo(), natural)
    }

    #[test]
    fn a_picture_lies_where_its_world_file_says() {
        let (terrain, natural) = ground();
        // Pixels of 2 m, the upper left one round (3, 7).
        let east_up = laid("2\n0\n0\n-2\n3\n7\n", &terrain, &natural).unwrap();
        let at = |x: f64, y: f64| east_up.pixel((x * 2.0) as u32, ((10.0 - y) * 2.0) as u32);
        assert_eq!((at(1.0, 7.0), at(9.9, 9.9)), ([9, 9, 9, 255], [9, 9, 9, 255]));
        let [red, green, ..] = at(7.01, 5.01);
        assert!(red.abs_diff(100) < 10 && green.abs_diff(100) < 15, "{red} {green}");
        // Turned by 90 degrees: columns run south.
        let turned = laid("0 -2 -2 0 7 7", &terrain, &natural).unwrap();
        let [red, green, ..] = turned.pixel(14, 14);
        assert!(red.abs_diff(100) < 15 && green < 20, "{red} {green}");
    }

    #[test]
    fn a_picture_beside_the_terrain_and_a_broken_world_file_are_refused() {
        let (terrain, natural) = ground();
        assert!(laid("2 0 0 -2 300 700", &terrain, &natural).is_none());
        for wrong in ["", "1 2 3", "0 0 0 0 1 1", "2 0 0 -2 nan 7", "2 0 0 -2 3 7 9", "a b c d e f"] {
            assert_eq!(World::parse(wrong), None, "{wrong}");
        }
    }
}

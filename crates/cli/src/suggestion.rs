//! A scene for a terrain file that was given in place of one.

use corpuscle::scene::TerrainFile;
use corpuscle::terrain::Terrain;
use std::path::Path;

/// Particles that the suggested inflow adds.
const PARTICLES: f64 = 5000.0;

/// Duration of the suggested run, s.
const UNTIL: f64 = 3600.0;

/// Cells that are compared to find a low one, about.
const CANDIDATES: f64 = 250_000.0;

/// The surroundings of a cell reach to the shorter side of the terrain over this number.
const SURROUNDINGS: usize = 15;

/// A message for a terrain file given as a scene, with the three lines of a scene for it.
pub fn suggest_scene(path: &Path) -> Result<String, corpuscle::Error> {
    let file = TerrainFile { path: path.to_owned(), crs: None, no_data: Default::default() };
    let terrain = Terrain::open(&corpuscle::scene::Terrain::File(file), 0, Path::new(""))?;
    Ok(format!(
        "{} is a terrain, not a scene: say how long to run and where water comes in. Write these three lines into a \
         file here, as in flood.toml, and run that (`corpuscle run flood.toml`):\n\n{}",
        path.display(),
        scene_lines(path, &terrain)
    ))
}

fn scene_lines(path: &Path, terrain: &Terrain) -> String {
    let cell = terrain.map_grid().cell_size();
    let spacing = one_digit(0.5 * cell[0].min(cell[1]));
    let discharge = one_digit(PARTICLES * spacing * spacing / UNTIL);
    let path = toml::Value::String(path.to_string_lossy().into_owned());
    let [x, y] = terrain.to_own(valley(terrain));
    // Degrees need more decimals than metres.
    let decimals = if x.abs() <= 360.0 && y.abs() <= 90.0 { 5 } else { 1 };
    format!(
        "terrain.file.path = {path}\n\
         run.until_s = {UNTIL}\n\
         flood = {{ spacing_m = {spacing}, inflow = [{{ name = \"source\", at = [{x:.decimals$}, {y:.decimals$}], \
         discharge_m3_per_s = {discharge} }}] }}"
    )
}

/// The position, m, that lies deepest below its surroundings: a valley.
fn valley(terrain: &Terrain) -> [f64; 2] {
    let grid = terrain.map_grid();
    let stride = ((grid.columns * grid.rows) as f64 / CANDIDATES).sqrt().ceil() as usize;
    let around = (grid.columns.min(grid.rows) / SURROUNDINGS).max(1) as isize;
    let cells = |count: usize| (0..count).step_by(stride);
    let candidates = cells(grid.rows).flat_map(|row| cells(grid.columns).map(move |column| [column, row]));
    let depths = candidates.filter_map(|cell| Some((depth_below(terrain, cell, around)?, cell)));
    match depths.max_by(|a, b| a.0.total_cmp(&b.0)) {
        Some((_, [column, row])) => grid.centre(column, row),
        None => grid.centre(grid.columns / 2, grid.rows / 2),
    }
}

/// Depth of a cell below the mean of eight others round it, m; none where one of them has no data.
fn depth_below(terrain: &Terrain, [column, row]: [usize; 2], around: isize) -> Option<f64> {
    let height = |east: isize, south: isize| {
        let (column, row) = (column.checked_add_signed(east * around)?, row.checked_add_signed(south * around)?);
        let [x, y] = terrain.map_grid().centre(column, row);
        terrain.is_valid_cell(column, row).then(|| terrain.height_once(x, y))
    };
    let mut sum = 0.0;
    for (east, south) in [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)] {
        sum += height(east, south)?;
    }
    Some(sum / 8.0 - height(0, 0)?)
}

/// Rounded to one digit: 46.3 to 50, 0.0231 to 0.02.
fn one_digit(value: f64) -> f64 {
    format!("{value:.0e}").parse().unwrap_or(value)
}

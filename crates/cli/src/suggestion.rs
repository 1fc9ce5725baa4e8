//! A scene for a terrain file that was given in place of one.

use corpuscle::terrain::Terrain;
use std::path::Path;

/// Particles that the suggested inflow brings in.
const PARTICLES: f64 = 5000.0;

/// How long the suggested run lasts, s.
const UNTIL: f64 = 3600.0;

/// At most about this many places are looked at for a low one.
const LOOKS: usize = 250_000;

/// Why a terrain is not a scene, and the three lines that make it one.
pub fn suggest_scene(path: &Path) -> Result<String, corpuscle::Error> {
    let file = corpuscle::scene::TerrainFile { path: path.to_owned(), crs: None, no_data: Default::default() };
    let terrain = Terrain::open(&corpuscle::scene::Terrain::File(file), 0, Path::new(""))?;
    let shown = path.display();
    Ok(format!(
        "{shown} is a terrain, not a scene: say how long to run and where water comes in. Write these three lines \
         into a file, as in flood.toml beside it, and run that (`corpuscle run flood.toml`):\n\n{}",
        scene_lines(path, &terrain)
    ))
}

fn scene_lines(path: &Path, terrain: &Terrain) -> String {
    let cell = terrain.map_grid().cell_size();
    let spacing = one_digit(0.5 * cell[0].min(cell[1]));
    let discharge = one_digit(PARTICLES * spacing * spacing / UNTIL);
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let name = toml::Value::String(name);
    let [x, y] = terrain.to_own(low_place(terrain));
    let decimals = if x.abs() <= 360.0 && y.abs() <= 90.0 { 5 } else { 1 };
    format!(
        "terrain.file.path = {name}\n\
         run.until_s = {UNTIL}\n\
         flood = {{ spacing_m = {spacing}, inflow = [{{ name = \"source\", at = [{x:.decimals$}, {y:.decimals$}], \
         discharge_m3_per_s = {discharge} }}] }}"
    )
}

/// The lowest place, m, that is not at the edge: water should stay on the terrain for a while.
fn low_place(terrain: &Terrain) -> [f64; 2] {
    let grid = terrain.map_grid();
    let stride = ((grid.columns * grid.rows / LOOKS) as f64).sqrt().ceil().max(1.0) as usize;
    let inner = |count: usize| (count / 10..count - count / 10).step_by(stride);
    let valid = inner(grid.rows)
        .flat_map(|row| inner(grid.columns).map(move |column| (column, row)))
        .filter(|&(column, row)| terrain.is_valid_cell(column, row));
    let places = valid.map(|(column, row)| grid.centre(column, row));
    let height = |place: &[f64; 2]| terrain.height(place[0], place[1]);
    let lowest = places.min_by(|a, b| height(a).total_cmp(&height(b)));
    lowest.unwrap_or_else(|| grid.centre(grid.columns / 2, grid.rows / 2))
}

/// Rounded to one digit: 46.3 to 50, 0.0231 to 0.02.
fn one_digit(value: f64) -> f64 {
    format!("{value:.0e}").parse().unwrap_or(value)
}

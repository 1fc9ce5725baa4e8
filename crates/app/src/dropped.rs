//! Terrain dropped on the window: the scene of a flood over it.

use crate::Source;
use corpuscle::scene::{Scene, Terrain as Written, TerrainFile};
use corpuscle::terrain::{Terrain, in_memory};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// Particles that the inflow adds by the end.
const PARTICLES: f64 = 6000.0;
/// Fraction of the terrain that the water would cover a metre deep.
const COVERED: f64 = 0.1;
/// Speed at which a flood crosses the terrain, m/s, from which the duration follows.
const SPEED: f64 = 1.5;
/// Distance of the inflow from the side, over the length of the side.
const INSET: f64 = 0.03;
/// Frames and rows of gauges in a run.
const FRAMES: f64 = 60.0;
const ROWS: f64 = 240.0;

/// A flood over the terrain in a file: water flows in at the head of its valley and leaves over its sides.
///
/// # Errors
/// A text that says what is wrong with it.
pub fn flood(path: &Path) -> Result<Source, String> {
    let path = match in_memory(path) {
        Some(_) => path.to_owned(),
        None => fs::canonicalize(path).map_err(|error| format!("{}: {error}", path.display()))?,
    };
    let file = Written::File(TerrainFile { path: path.clone(), crs: None, no_data: Default::default() });
    let terrain = Terrain::open(&file, 1, Path::new("")).map_err(|error| error.to_string())?;
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let text = text(&terrain, &path, &stem);
    // What is written must be a scene.
    Scene::parse(&text, &stem, &[]).map_err(|error| error.to_string())?;
    Ok(Source { name: format!("flood-{stem}"), text, folder: PathBuf::new(), changes: Vec::new() })
}

fn text(terrain: &Terrain, path: &Path, name: &str) -> String {
    let [width, height] = terrain.bounds().size();
    let area = width * height;
    let finest = 0.5 * terrain.map_grid().cell_size().into_iter().fold(f64::INFINITY, f64::min);
    let spacing = two_figures((COVERED * area / PARTICLES).sqrt().max(finest));
    let until = two_figures(2.0 * width.max(height) / SPEED);
    let discharge = two_figures(COVERED * area / until);
    let [x, y] = terrain.to_own(head(terrain));
    let quoted = |text: &str| toml::Value::String(text.into()).to_string();
    let mut scene = String::new();
    let _ = write!(
        scene,
        "title = {}\ndescription = {}\n\n[run]\nuntil_s = {until:?}\nframe_every_s = {:?}\ngauge_every_s = {:?}\n\n\
         [terrain.file]\npath = {}\n\n[flood]\nspacing_m = {spacing:?}\n\n\
         [[flood.inflow]]\nname = \"head\"\nat = [{x:?}, {y:?}]\ndischarge_m3_per_s = {discharge:?}\n",
        quoted(&format!("A flood over {name}")),
        quoted("Water comes in at the lowest point of the highest side, and leaves over the edges."),
        until / FRAMES,
        until / ROWS,
        quoted(&path.display().to_string()),
    );
    scene
}

/// The lowest position along the side that is highest on average, a little inside, in model coordinates: there a valley begins.
fn head(terrain: &Terrain) -> [f64; 2] {
    let bounds = terrain.bounds();
    let [width, height] = bounds.size();
    let at = |side: usize, part: f64| {
        let (along, inset) = (INSET + (1.0 - 2.0 * INSET) * part, [INSET, 1.0 - INSET][side % 2]);
        let [x, y] = if side < 2 { [inset, along] } else { [along, inset] };
        [bounds.x_min + x * width, bounds.y_min + y * height]
    };
    let grid = terrain.map_grid();
    let has_data = |[x, y]: [f64; 2]| {
        let [column, row] = grid.position(x, y).map(|at| at.round().max(0.0) as usize);
        terrain.is_valid_cell(column.min(grid.columns - 1), row.min(grid.rows - 1))
    };
    const STEPS: u32 = 400;
    let heights = |side: usize| -> Vec<(f64, [f64; 2])> {
        let positions = (0..=STEPS).map(|step| at(side, f64::from(step) / f64::from(STEPS)));
        positions
            .filter(|position| has_data(*position))
            .map(|position| (terrain.height_once(position[0], position[1]), position))
            .collect()
    };
    let sides: Vec<_> = (0..4).map(heights).filter(|heights| !heights.is_empty()).collect();
    let mean = |heights: &[(f64, [f64; 2])]| heights.iter().map(|(z, _)| z).sum::<f64>() / heights.len() as f64;
    let highest = sides.iter().max_by(|a, b| mean(a).total_cmp(&mean(b)));
    let lowest = highest.and_then(|side| side.iter().min_by(|a, b| a.0.total_cmp(&b.0)));
    // Terrain without data along all its sides is flooded from its centre.
    lowest.map_or([bounds.x_min + 0.5 * width, bounds.y_min + 0.5 * height], |(_, position)| *position)
}

/// A number rounded to two significant digits.
fn two_figures(number: f64) -> f64 {
    let text = format!("{number:.1e}");
    text.parse().unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Terrain of 60 by 40 cells of 10 m that falls to the east, with a valley along its middle row, without data in a corner.
    fn grid(folder: &Path) -> PathBuf {
        let mut text =
            String::from("ncols 60\nnrows 40\nxllcorner 1000\nyllcorner 2000\ncellsize 10\nNODATA_value -9999\n");
        for row in 0..40 {
            let height = |column: i32| match (row, column) {
                (0, 0) => -9999.0,
                _ => 50.0 - 0.5 * f64::from(column) + 0.02 * f64::from(row - 20).powi(2),
            };
            let row: Vec<String> = (0..60).map(|column| height(column).to_string()).collect();
            let _ = writeln!(text, "{}", row.join(" "));
        }
        let file = folder.join("two \"words\".asc");
        fs::write(&file, text).unwrap();
        file
    }

    #[test]
    fn terrain_is_flooded_from_the_head_of_its_valley() {
        let folder = tempfile::tempdir().unwrap();
        let source = flood(&grid(folder.path())).unwrap();
        let scene = source.scene().unwrap();
        let flood = scene.flood().unwrap();
        let [x, y] = flood.flood.inflow[0].at.unwrap();
        assert!((x - 1018.0).abs() < 1.0 && (y - 2195.0).abs() < 15.0, "{x} {y}");
        // 600 m are crossed twice in this time, a tenth of the ground is covered, by so many particles.
        assert_eq!(scene.run.until_s, 800.0);
        let water = 30.0 * 800.0;
        let corpuscle::scene::Series::Constant(discharge) = flood.flood.inflow[0].discharge_m3_per_s else { panic!() };
        assert_eq!((discharge * 800.0, flood.flood.spacing_m), (water, Some(5.0)));
        assert!(corpuscle::Simulation::open(scene, Path::new("")).is_ok());
    }
}

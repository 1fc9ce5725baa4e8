//! The spacing of particles that is taken where a scene gives none.

use crate::error::setup;
use crate::initial_water::{self, initial_water};
use crate::series::load;
use corpuscle_model::ModelError;
use corpuscle_scene::{Edge, Flood, Series};
use corpuscle_terrain::Terrain;
use std::path::Path;

/// Most particles of a first run: some minutes on a few cores.
const MOST_PARTICLES: f64 = 2e5;

/// Most samples of the ground.
const MOST_SAMPLES: usize = 1_000_000;

/// Assumed depth of inflowing water, m.
pub(crate) const DEPTH_OF_INFLOW: f64 = 1.0;

/// A spacing for a scene that gives none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DefaultSpacing {
    /// The spacing, m: the size of the terrain's cells, or more where that would make more than about 200,000 wet particles.
    pub spacing: f64,
    /// The size of the terrain's cells, m.
    pub cell: f64,
    /// Ground that is under water at the start or is to be, by an estimate, m2.
    pub wet_area: f64,
}

/// A spacing for a scene that gives none and runs until `until` s: not below the terrain's cells, which resolve nothing finer, and so that
/// not more than about 200,000 particles are wet. Wet is the ground with water at the start, all ground below the highest level that
/// is held somewhere, all ground where it rains, and the area on which what flows in stands a metre deep. `folder` is what relative paths refer to.
///
/// # Errors
/// [`ModelError::Setup`] where a file of the scene cannot be used.
pub fn default_spacing(
    settings: &Flood,
    terrain: &Terrain,
    folder: &Path,
    until: f64,
) -> Result<DefaultSpacing, ModelError> {
    let grid = terrain.map_grid();
    let cell = grid.cell_size().into_iter().fold(0.0, f64::max);
    let wet_area = wet_area(settings, terrain, folder, until)?;
    let spacing = two_figures(cell.max((wet_area / MOST_PARTICLES).sqrt()));
    Ok(DefaultSpacing { spacing, cell, wet_area })
}

/// Fills in the spacing of settings that give none, as if nothing came in, and gives the spacing, m.
pub(crate) fn resolve(settings: &mut Flood, terrain: &Terrain, folder: &Path) -> Result<f64, ModelError> {
    let spacing = match settings.spacing_m {
        Some(spacing) => spacing,
        None => default_spacing(settings, terrain, folder, 0.0)?.spacing,
    };
    settings.spacing_m = Some(spacing);
    Ok(spacing)
}

impl std::fmt::Display for DefaultSpacing {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { spacing, cell, wet_area } = self;
        let particles = (wet_area / (spacing * spacing)).round();
        let cell = (cell * 1e3).round() / 1e3;
        write!(
            f,
            "flood.spacing_m is not given: particles stand {spacing} m apart. The terrain's cells are {cell} m wide, and about {wet_area:.0} m2 are \
             or get wet: some {particles} particles."
        )
    }
}

/// Ground that is under water at the start or is to be until a time, m2, by an estimate: see [`default_spacing`].
fn wet_area(settings: &Flood, terrain: &Terrain, folder: &Path, until: f64) -> Result<f64, ModelError> {
    let [east, north] = terrain.bounds().size();
    if settings.rain.is_some() {
        return Ok(east * north);
    }
    let bodies = initial_water::of_scene(settings, terrain, folder)?;
    let highest = highest_level(settings, folder, 0.0, until)?;
    let grid = terrain.map_grid();
    let stride = ((grid.columns * grid.rows) as f64 / MOST_SAMPLES as f64).sqrt().ceil().max(1.0) as usize;
    let (mut wet, mut all) = (0_usize, 0_usize);
    for row in (stride / 2..grid.rows).step_by(stride) {
        for column in (stride / 2..grid.columns).step_by(stride) {
            all += 1;
            let [x, y] = grid.centre(column, row);
            let ground = terrain.height_once(x, y);
            let is_wet = ground < highest || bodies.iter().any(|body| body.may_be_at([x, y], ground, 0.0));
            wet += usize::from(terrain.is_valid_cell(column, row) && is_wet);
        }
    }
    let standing = east * north * wet as f64 / all.max(1) as f64;
    let blocks = settings.water.iter().filter_map(|water| water.block.as_ref()).map(|block| {
        let [from, to] = [block.from, block.to].map(|corner| terrain.to_model(corner));
        (to[0] - from[0]) * (to[1] - from[1]) * block.layers as f64
    });
    let coming = inflow_volume(settings, folder, 0.0, until)? / DEPTH_OF_INFLOW;
    Ok((standing + blocks.sum::<f64>() + coming).min(east * north))
}

/// Water as deep as this is usual where only rain brings some, m.
const DEPTH_OF_RAIN: f64 = 0.02;

/// A depth about which the water of a scene mostly is, m, for colours and classes: `spacing_depth_m` where it is given; else between the mean
/// depth at the start and that of the same water over all the terrain; where there is none at the start 1 m, or 2 cm where only rain brings some.
/// `folder` is what relative paths refer to.
///
/// # Errors
/// [`ModelError::Setup`] where a file of the scene cannot be used.
pub fn usual_depth(settings: &Flood, terrain: &Terrain, folder: &Path) -> Result<f64, ModelError> {
    if let Some(depth) = settings.spacing_depth_m {
        return Ok(depth);
    }
    let grid = terrain.map_grid();
    let bodies = initial_water(settings, terrain, folder)?;
    let stride = ((grid.columns * grid.rows) as f64 / MOST_SAMPLES as f64).sqrt().ceil().max(1.0) as usize;
    let (mut sum, mut wet, mut all) = (0.0, 0_u32, 0_u32);
    for row in (stride / 2..grid.rows).step_by(stride) {
        for column in (stride / 2..grid.columns).step_by(stride) {
            let [x, y] = grid.centre(column, row);
            let here = bodies.iter().filter(|body| (body.inside)(x, y)).map(|body| (body.depth)(x, y));
            let depth = here.filter(|depth| depth.is_finite()).fold(0.0, f64::max);
            all += 1;
            wet += u32::from(depth > 0.0);
            sum += depth;
        }
    }
    let only_rain = settings.inflow.is_empty() && settings.stage.is_empty() && settings.water.is_empty();
    Ok(match wet {
        0 if only_rain && settings.rain.is_some() => DEPTH_OF_RAIN,
        0 => DEPTH_OF_INFLOW,
        _ => sum / (f64::from(wet) * f64::from(all)).sqrt(),
    })
}

/// The highest level that is held at a side or within the ground from a time until another, m; minus infinity where none is.
pub(crate) fn highest_level(settings: &Flood, folder: &Path, from: f64, until: f64) -> Result<f64, ModelError> {
    let mut highest = f64::NEG_INFINITY;
    let mut see = |level: &Series| -> Result<(), ModelError> {
        let table = load(level, folder)?;
        let rows = table.rows().iter().filter(|row| (from..=until).contains(&row[0])).map(|row| row[1]);
        highest = rows.chain([table.at(from), table.at(until)]).fold(highest, f64::max);
        Ok(())
    };
    for edge in edges(settings) {
        match edge {
            Edge::Stage(level) => see(level)?,
            Edge::Wave(wave) => {
                see(&Series::Constant(wave.rest_level_m))?;
                wave.level_m.as_ref().map_or(Ok(()), &mut see)?;
            }
            _ => {}
        }
    }
    settings.stage.iter().try_for_each(|stage| see(&stage.level_m))?;
    Ok(highest)
}

/// Water that inflows and sides bring from a time until another, m3.
pub(crate) fn inflow_volume(settings: &Flood, folder: &Path, from: f64, until: f64) -> Result<f64, ModelError> {
    let mut volume = 0.0;
    for inflow in &settings.inflow {
        volume += inflow.load_discharge(folder).map_err(setup)?.integral(from, until);
    }
    for edge in edges(settings) {
        if let Edge::Discharge(discharge) = edge {
            volume += load(discharge, folder)?.integral(from, until);
        }
    }
    Ok(volume.max(0.0))
}

fn edges(settings: &Flood) -> impl Iterator<Item = &Edge> {
    let edges = &settings.edges;
    let parts = settings.edge_part.iter().map(|part| &part.edge);
    let lines = settings.edge_line.iter().map(|line| &line.edge);
    [&edges.west, &edges.east, &edges.south, &edges.north].into_iter().chain(parts).chain(lines)
}

/// A number rounded up to two figures.
fn two_figures(value: f64) -> f64 {
    let exponent = value.log10().floor() as i32 - 1;
    let count = (value / 10_f64.powi(exponent) - 1e-9).ceil();
    // Whole numbers over powers of ten print as they are.
    if exponent < 0 { count / 10_f64.powi(-exponent) } else { count * 10_f64.powi(exponent) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_scene::Scene;

    fn chosen(keys: &str) -> DefaultSpacing {
        let text = format!(
            "run.until_s = 100\nterrain.plane = {{ slope_east = 0.01, extent = {{ length_m = 4000, width_m = 2000, cell_m = 5 }} }}\n[flood]\n{keys}"
        );
        let scene = Scene::parse(&text, "test", &[]).unwrap();
        let scene = scene.flood().unwrap();
        let terrain = Terrain::open(&scene.terrain, 1, Path::new(".")).unwrap();
        default_spacing(&scene.flood, &terrain, Path::new("."), 100.0).unwrap()
    }

    #[test]
    fn a_little_water_is_as_fine_as_the_terrain() {
        let pond = chosen("water = [{ depth_m = 1, polygon = [[100, 100], [300, 100], [300, 300], [100, 300]] }]");
        assert!(pond.spacing == 5.0 && (pond.wet_area - 40_000.0).abs() < 2000.0, "{pond:?}");
        let text = pond.to_string();
        assert!(text.contains("5 m apart") && text.contains("1600 particles"), "{text}");
        let dry = chosen("");
        assert!(dry.spacing == 5.0 && dry.wet_area == 0.0, "{dry:?}");
    }

    #[test]
    fn much_water_is_coarser_however_it_comes() {
        // 8 km2 in 200,000 particles: 6.32 m.
        for keys in [
            "water = [{ depth_m = 1 }]",
            "rain.intensity_mm_per_h = 20",
            "inflow = [{ name = \"a\", at = [9, 9], discharge_m3_per_s = 1e6 }]",
            "edges.east = { stage = [[0, 0], [50, 99]] }",
            "scheme = \"voronoi\"\nedges.east = { wave = { rest_level_m = 0, level_m = 90 } }",
            "stage = [{ name = \"a\", line = [[9, 9], [99, 99]], level_m = 77 }]",
        ] {
            assert_eq!(chosen(keys).spacing, 6.4, "{keys}");
        }
        // A rise after the end of the run counts by the part until then: the lower half of the ground is below the level 0.
        let half = chosen("edges.east = { stage = [[0, 0], [100, 0], [101, 99]] }");
        assert!((half.wet_area / 4e6 - 1.0).abs() < 0.01, "{half:?}");
        let inflow = chosen("inflow = [{ name = \"a\", at = [9, 9], discharge_m3_per_s = [[0, 0], [100, 200]] }]");
        assert!((inflow.wet_area - 1e4).abs() < 1e-6, "{inflow:?}");
    }

    #[test]
    fn the_usual_depth_lies_between_that_at_the_start_and_that_over_all_the_ground() {
        let usual = |keys: &str| {
            let text = format!(
                "run.until_s = 1\nterrain.plane.extent = {{ length_m = 400, width_m = 200, cell_m = 5 }}\n[flood]\n{keys}"
            );
            let scene = Scene::parse(&text, "test", &[]).unwrap();
            let scene = scene.flood().unwrap();
            let terrain = Terrain::open(&scene.terrain, 1, Path::new(".")).unwrap();
            usual_depth(&scene.flood, &terrain, Path::new(".")).unwrap()
        };
        assert!((usual("water = [{ depth_m = 3 }]") - 3.0).abs() < 1e-9);
        let quarter = usual("water = [{ depth_m = 4, polygon = [[0, 0], [100, 0], [100, 200], [0, 200]] }]");
        assert!((quarter - 2.0).abs() < 1e-9, "{quarter}");
        assert_eq!(usual("inflow = [{ name = \"a\", at = [9, 9], discharge_m3_per_s = 1 }]"), 1.0);
        assert_eq!(usual("rain.intensity_mm_per_h = 20"), 0.02);
        assert_eq!(usual("spacing_depth_m = 7\nwater = [{ depth_m = 3 }]"), 7.0);
    }

    #[test]
    fn numbers_are_rounded_up_to_two_figures() {
        for (value, rounded) in [(5.0, 5.0), (0.3, 0.3), (12.31, 13.0), (123.0, 130.0), (0.0251, 0.026), (99.5, 100.0)]
        {
            assert_eq!(two_figures(value), rounded);
        }
    }
}

//! Cells that hold water by volume against level.

use super::super::rows;
use super::noise::squares;
use super::rain::hydrograph;
use super::thacker::{Exact, curved, error, omega, plane, swing_with};
use super::{all_sides, run, settings, worst};
use crate::{Case, Options, Row};
use corpuscle_flood::{Filling, StartWater};
use corpuscle_model::ModelError;
use corpuscle_scene::{Edge, Flood, Storage};
use corpuscle_terrain::{Bounds, Terrain};
use std::f64::consts::TAU;
use std::sync::Arc;

pub(in super::super) const STORAGE: Case = Case {
    name: "flood/voronoi/storage",
    about: "Storage by volume against level (flood.storage = \"level-volume\") in scheme voronoi, three seeds. Water let go at one end of a basin whose \
            ground is rough within the cells comes to rest: the volume of the basin below the level of its lake, from the terrain itself, against \
            the water that there is. Thacker's bowls at 4 cm: error over that with cells of level ground. Rain on the \
            plane of flood/voronoi/rain-plane, for which it is not made.",
    slow: true,
    reduced: 2.0,
    run: |_: &Options| rows(STORAGE.name, measure()),
};

fn measure() -> Result<Vec<Row>, ModelError> {
    let volumes = |spacing: f64, storage: Storage| worst(|seed| Ok([wrong_volume(seed, spacing, storage)?]));
    let ([fine], [wide]) = (volumes(6.0, Storage::LevelVolume)?, volumes(12.0, Storage::LevelVolume)?);
    let [level_ground] = volumes(12.0, Storage::Mean)?;
    let bowls = |exact: Exact, time: f64| worst(|seed| Ok([share(seed, exact, time)?]));
    let ([planar], [radial]) = (bowls(plane, 2.0 * TAU / omega())?, bowls(curved, TAU / omega())?);
    let [rain, _] = worst(|seed| hydrograph(4.0, seed, Storage::LevelVolume))?;
    let row = |measure: &str, value: f64, bound: f64| Row::at_most(STORAGE.name, measure, value, "", bound);
    Ok(vec![
        row("volume_error_6m", fine, 0.01),
        row("volume_error_12m", wide, 0.02),
        Row::beside(STORAGE.name, "volume_error_12m_level_ground", level_ground, "", 0.02, "without: to compare"),
        Row::beside(
            STORAGE.name,
            "rain_plane_hydrograph_error_4m",
            rain,
            "",
            0.04,
            "not for thin sheets on slopes: they gather in the lowest part of a cell",
        ),
        row("share_of_error_thacker_planar", planar, 0.9),
        row("share_of_error_thacker_radial", radial, 0.9),
    ])
}

/// The error in a bowl over that with cells of level ground.
fn share(seed: u64, exact: Exact, time: f64) -> Result<f64, ModelError> {
    let of = |storage: Storage| {
        let settings = Flood { storage, ..settings(0.04, 0.0, all_sides(&Edge::Wall)) };
        Ok::<f64, ModelError>(error(&swing_with(&settings, exact, time, seed)?, exact, time))
    };
    Ok(of(Storage::LevelVolume)? / of(Storage::Mean)?)
}

/// Side of the basin, m.
const SIDE: f64 = 120.0;

/// Width of the terrain's cells, m.
const CELL: f64 = 1.5;

/// Volume of the basin below the level at which its lake comes to rest, from the terrain's own heights, over the volume of its water: how far off.
fn wrong_volume(seed: u64, spacing: f64, storage: Storage) -> Result<f64, ModelError> {
    let bounds = Bounds { x_min: 0.0, x_max: SIDE, y_min: 0.0, y_max: SIDE };
    let rough = squares(CELL, 40 + seed);
    let height = move |x: f64, y: f64| {
        let [east, north] = [x, y].map(|at| 2.0 * at / SIDE - 1.0);
        3.0 * (east * east + north * north) + 0.8 * rough(x, y)
    };
    let terrain = Arc::new(Terrain::gridded(bounds, CELL, height));
    let water = StartWater {
        filling: Filling::Level(Box::new(|_, _| 2.5)),
        polygon: Some(vec![[0.0, 0.0], [0.45 * SIDE, 0.0], [0.45 * SIDE, SIDE], [0.0, SIDE]]),
        velocity: Box::new(|_, _| [0.0; 2]),
    };
    let settings = Flood { storage, ..settings(spacing, 0.1, all_sides(&Edge::Wall)) };
    let flood = run(&settings, seed, &terrain, &[water], 1200.0)?;
    let volume: f64 = flood.wet_cells().map(|cell| cell.area * cell.depth).sum();
    // The level of the lake: that of its deepest cells.
    let mut lake: Vec<_> = flood.wet_cells().collect();
    lake.sort_unstable_by(|a, b| b.depth.total_cmp(&a.depth));
    let level = lake.iter().take(10).map(|cell| cell.level).sum::<f64>() / 10.0;
    let samples = 4 * (SIDE / CELL) as usize;
    let at = |k: usize| (k as f64 + 0.5) * SIDE / samples as f64;
    let depths = (0..samples * samples).map(|k| (level - terrain.height(at(k % samples), at(k / samples))).max(0.0));
    let below = depths.sum::<f64>() * (SIDE / samples as f64).powi(2);
    Ok((below / volume - 1.0).abs())
}

//! The flood.

mod parameters;

use super::{ModelKind, Opened, Opening, Recorded};
use crate::Error;
use crate::ground::ground;
use crate::memory::refuse_what_does_not_fit;
use crate::parameters::Builder;
#[cfg(feature = "pictures")]
use crate::pictures::{
    DrawContext, PictureSettings, Scenery, Sketcher, Subject, flood::FloodPicture, flood_sketch::FloodSketch,
};
use corpuscle_flood::default_spacing;
use corpuscle_model::ModelError;
use corpuscle_output::{Report, Summary, compare_extent};
use corpuscle_scene::{Flood, FloodScene, Scene, SceneKind, Scheme};
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;

/// Memory for each particle of scheme sph-swe, bytes, measured: state, sorted copies, neighbours and work space.
const BYTES_PER_PARTICLE: f64 = 1000.0;

/// Memory for each wet particle of scheme voronoi, bytes, 533 measured by the bench `flood/voronoi-60k`: column, slopes, faces and work space.
const BYTES_PER_CELL_OF_WATER: f64 = 560.0;

/// The model kind of floods.
pub(super) struct Kind;

fn no_flood() -> ModelError {
    ModelError::Setup("it is not the scene of a flood".into())
}

impl ModelKind for Kind {
    fn scene(&self) -> SceneKind {
        SceneKind::FLOOD
    }

    fn open(&self, opening: Opening<'_>) -> Result<Opened, Error> {
        let Opening { scene, folder, processes, is_restored } = opening;
        let (seed, until) = (scene.seed, scene.run.until_s);
        let FloodScene { terrain, flood } = scene.model.get_mut().ok_or_else(no_flood)?;
        let mut notes = Vec::new();
        let prepared = prepare(terrain, flood, (seed, until, folder), &mut notes);
        // A file may be missing for one of several processes only.
        let terrain = processes.agree(prepared, |error| ModelError::Setup(error).into())?;
        let new = if is_restored { corpuscle_flood::open_to_restore } else { corpuscle_flood::open };
        let model = new(processes, flood, seed, folder, terrain.clone())?;
        *flood = model.settings().clone();
        let checked = check_inflow(flood, until, &terrain, folder);
        processes.agree(checked, |error| ModelError::Setup(error).into())?;
        Ok(Opened { model, terrain: Some(terrain), notes })
    }

    fn is_shared(&self) -> bool {
        true
    }

    fn bytes_per_particle(&self, scene: &Scene) -> f64 {
        let is_voronoi = scene.flood().is_some_and(|scene| scene.flood.scheme == Scheme::Voronoi);
        if is_voronoi { BYTES_PER_CELL_OF_WATER } else { BYTES_PER_PARTICLE }
    }

    fn parameters(&self, builder: &mut Builder, scene: &Scene, now: &Scene) {
        if let (Some(scene), Some(now)) = (scene.flood(), now.flood()) {
            parameters::parameters(builder, &scene.flood, &now.flood);
        }
    }

    fn complete(&self, run: &Recorded<'_>, summary: &mut Summary) -> Result<(), Error> {
        let observed = run.scene.flood().and_then(|scene| scene.flood.observed_extent.as_ref());
        let (Some(observed), Some(terrain)) = (observed, run.terrain) else { return Ok(()) };
        let mut compared = Ok(());
        run.model.each_map(&|name| name == "max_depth", &mut |map| {
            compared = compare_extent(observed, terrain, &map.values).map(|extent| summary.extent = Some(extent));
        });
        Ok(compared?)
    }

    fn write_report(&self, run: &Recorded<'_>) -> Result<(), Error> {
        let terrain = run.terrain.ok_or_else(no_flood)?;
        Ok(Report::read(run.folder, run.scene, terrain)?.write()?)
    }

    #[cfg(feature = "pictures")]
    fn terrain(&self, scene: &Scene, folder: &Path) -> Result<Option<Arc<Terrain>>, Error> {
        let FloodScene { terrain, .. } = scene.flood().ok_or_else(no_flood)?;
        Ok(Some(Arc::new(ground(terrain, scene.seed, folder)?)))
    }

    #[cfg(feature = "pictures")]
    fn sketcher(&self, scenery: &Scenery) -> Result<Box<dyn Sketcher>, Error> {
        let FloodScene { flood, .. } = scenery.scene().flood().ok_or_else(no_flood)?;
        let terrain = scenery.terrain().ok_or_else(no_flood)?;
        Ok(Box::new(FloodSketch::new(flood, terrain)?))
    }

    #[cfg(feature = "pictures")]
    fn pictures(
        &self,
        context: &DrawContext,
        scenery: &Scenery,
        settings: &PictureSettings,
    ) -> Result<Box<dyn Subject>, Error> {
        let FloodScene { flood, .. } = scenery.scene().flood().ok_or_else(no_flood)?;
        let terrain = scenery.terrain().ok_or_else(no_flood)?;
        let drawn = scenery.drawn_heights().ok_or_else(no_flood)?;
        Ok(Box::new(FloodPicture::new(context, flood, terrain, drawn, settings)?))
    }
}

/// Opens the terrain, checks what memory the flood takes, and chooses its spacing where it has none.
fn prepare(
    terrain: &corpuscle_scene::Terrain,
    flood: &mut Flood,
    (seed, until, folder): (u64, f64, &Path),
    notes: &mut Vec<String>,
) -> Result<Arc<Terrain>, Error> {
    let terrain = Arc::new(ground(terrain, seed, folder)?);
    check_observed_extent(flood, &terrain)?;
    if flood.spacing_m.is_none() {
        let chosen = default_spacing(flood, &terrain, folder, until)?;
        flood.spacing_m = Some(chosen.spacing);
        notes.push(chosen.to_string());
    }
    refuse_more_than_memory(flood, &terrain, folder, until)?;
    Ok(terrain)
}

/// Refuses water that would take more memory than there can be.
fn refuse_more_than_memory(flood: &Flood, terrain: &Terrain, folder: &Path, until: f64) -> Result<(), Error> {
    let fits = |area: f64| {
        let particles = area / flood.spacing_m.unwrap_or(f64::INFINITY).powi(2);
        refuse_what_does_not_fit(particles * BYTES_PER_PARTICLE, "give a larger flood.spacing_m")
    };
    let [length, width] = terrain.bounds().size();
    // Where it does even if all the ground is wet, nobody has to find out how much of it is.
    if fits(length * width).is_err() {
        fits(default_spacing(flood, terrain, folder, until)?.wet_area)?;
    }
    Ok(())
}

/// Largest number of particles over a run without a warning: more take days.
const MOST_TO_COME: f64 = 2e8;

/// Largest accepted volume of inflow over the area of the terrain, m: no flood brings more.
const MOST_LAYER: f64 = 1e5;

/// Volume that the inflows of a flood add until a time, s, in m3; relative paths are taken from `folder`.
fn volume_of_inflows(flood: &Flood, until: f64, folder: &Path) -> Result<f64, Error> {
    let mut volume = 0.0;
    for inflow in &flood.inflow {
        volume += inflow.load_discharge(folder)?.integral(0.0, until);
    }
    Ok(volume)
}

/// Refuses discharges too large to be computed, most likely a wrong unit.
fn check_inflow(flood: &Flood, until: f64, terrain: &Terrain, folder: &Path) -> Result<(), Error> {
    let volume = volume_of_inflows(flood, until, folder)?;
    if flood.scheme == Scheme::Voronoi {
        let [east, north] = terrain.bounds().size();
        let layer = volume / (east * north);
        if layer <= MOST_LAYER {
            return Ok(());
        }
        let what = format!(
            "the inflows ([[flood.inflow]]) would bring a layer of {layer:.1e} m over all the terrain, and at most {MOST_LAYER:.0e} m are \
             possible; check their discharges, which are in m3/s"
        );
        return Err(ModelError::Setup(what).into());
    }
    let (Some(spacing), Some(depth)) = (flood.spacing_m, flood.spacing_depth_m) else { return Ok(()) };
    let count = (volume / (spacing * spacing * depth)).floor();
    if count <= MOST_TO_COME {
        return Ok(());
    }
    let what = format!(
        "the inflows ([[flood.inflow]]) would bring in {count:.1e} particles over the run, and at most {MOST_TO_COME:.0e} \
         are possible; check their discharges, which are in m3/s, or take a larger flood.spacing_m"
    );
    Err(ModelError::Setup(what).into())
}

/// Checks before the run, not at its end, that the observed extent can be used.
fn check_observed_extent(flood: &Flood, terrain: &Terrain) -> Result<(), Error> {
    if let Some(observed) = &flood.observed_extent {
        let grid = terrain.map_grid();
        compare_extent(observed, terrain, &vec![f32::NAN; grid.columns * grid.rows])?;
    }
    Ok(())
}

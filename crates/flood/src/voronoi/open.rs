//! How a flood is set up.

use super::adaptive::Adaptive;
use super::bed::Bed;
use super::boundaries::Boundaries;
use super::change::Overrides;
use super::domain::Domain;
use super::friction::Slowing;
use super::local::{HIGHEST, Local};
use super::maps::{DRY, Record};
use super::mesh::{Blocks, Grading, LINE, Layout, Mesh, NONE};
use super::patch::Patch;
use super::rain::{RainFunction, Soaked, Weather};
use super::solver::Solver;
use super::start;
use super::step::drops;
use super::structures::Patches;
use super::structures::{Structures, warn_of_links};
use super::{Inflow, State, VoronoiFlood, domain, finer, walls};
use crate::error::setup;
use crate::friction::Roughness;
use crate::initial_water::{self, StartWater};
use crate::setup;
use crate::zone::Zone;
use crate::{limits, obstacles, spacing};
use corpuscle_model::{Account, ExactSum, ModelError};
use corpuscle_processes::Processes;
use corpuscle_scene::{Flood, TimeSteps};
use corpuscle_terrain::Terrain;
use rayon::prelude::*;
use std::path::Path;
use std::sync::Arc;

/// More cells than this do not fit in the memory of usual machines.
const MOST_CELLS: f64 = 1e8;

/// Most heights of the terrain that are looked at to tell whether a tile is dry: about as many as it has positions.
const HEIGHTS_A_TILE: usize = 2048;

/// The depth whose wave speed sets the time step where there is no water yet, m.
const DRY_DEPTH: f64 = 0.05;

/// The first step over the longest stable one: water at rest on a slope has another speed after it.
const FIRST_STEP: f64 = 0.1;

impl VoronoiFlood {
    /// Sets a flood up as the `[flood]` of a scene says, its defaults resolved, with the scene's seed. `folder` is what
    /// relative paths refer to.
    ///
    /// # Errors
    /// [`ModelError::Setup`] where something cannot be opened or lies outside the terrain.
    pub fn new(settings: &Flood, seed: u64, folder: &Path, terrain: Arc<Terrain>) -> Result<Self, ModelError> {
        Self::new_on(&Processes::alone(), settings, seed, folder, terrain)
    }

    /// As [`VoronoiFlood::new`], with the cells distributed over processes: all of them call it. The first then has the flood; the others
    /// [follow](Processes::follow) it.
    ///
    /// # Errors
    /// As [`VoronoiFlood::new`], of any process.
    pub fn new_on(
        processes: &Processes,
        settings: &Flood,
        seed: u64,
        folder: &Path,
        terrain: Arc<Terrain>,
    ) -> Result<Self, ModelError> {
        start::check_polygons(settings, &terrain)?;
        let ground = Arc::clone(&terrain);
        let bodies = processes.agree(initial_water::of_scene(settings, &ground, folder), ModelError::Setup)?;
        Self::with_water_on(processes, settings, seed, folder, terrain, &bodies)
    }

    /// As [`VoronoiFlood::new`], but without the water at the start: for a state that is restored.
    ///
    /// # Errors
    /// As [`VoronoiFlood::new`].
    pub fn to_restore(settings: &Flood, seed: u64, folder: &Path, terrain: Arc<Terrain>) -> Result<Self, ModelError> {
        Self::to_restore_on(&Processes::alone(), settings, seed, folder, terrain)
    }

    /// As [`VoronoiFlood::to_restore`], with the cells distributed over processes.
    ///
    /// # Errors
    /// As [`VoronoiFlood::new_on`].
    pub fn to_restore_on(
        processes: &Processes,
        settings: &Flood,
        seed: u64,
        folder: &Path,
        terrain: Arc<Terrain>,
    ) -> Result<Self, ModelError> {
        let mut model = Self::empty(processes, settings, seed, folder, terrain)?;
        model.solver.domain.iter_mut().for_each(Domain::open);
        Ok(model)
    }

    /// As [`VoronoiFlood::new`], with the water at the start given as functions instead of by the scene.
    ///
    /// # Errors
    /// As [`VoronoiFlood::new`].
    pub fn with_water(
        settings: &Flood,
        seed: u64,
        folder: &Path,
        terrain: Arc<Terrain>,
        bodies: &[StartWater],
    ) -> Result<Self, ModelError> {
        Self::with_water_on(&Processes::alone(), settings, seed, folder, terrain, bodies)
    }

    /// As [`VoronoiFlood::with_water`], with the cells distributed over processes.
    ///
    /// # Errors
    /// As [`VoronoiFlood::new_on`].
    pub fn with_water_on(
        processes: &Processes,
        settings: &Flood,
        seed: u64,
        folder: &Path,
        terrain: Arc<Terrain>,
        bodies: &[StartWater],
    ) -> Result<Self, ModelError> {
        Self::empty(processes, settings, seed, folder, terrain)?.started(seed, bodies)
    }

    /// The model with its water at the start.
    fn started(mut self, seed: u64, bodies: &[StartWater]) -> Result<Self, ModelError> {
        self.make_first_tiles(bodies)?;
        self.fill(bodies)?;
        for _ in 0..self.checks_at_start() {
            if !self.adapt_to_start()? {
                break;
            }
            self.fill(bodies)?;
        }
        self.warn_of_empty(bodies);
        self.begin(seed);
        self.balance_load(0.0)?;
        self.solver.domain.iter_mut().for_each(Domain::open);
        Ok(self)
    }

    /// Has it rain as a function says, from the start on.
    ///
    /// # Errors
    /// [`ModelError::Setup`] where the cells would not fit in memory, or a GPU takes the steps: nothing has changed then.
    pub fn rain(&mut self, rain: RainFunction) -> Result<(), ModelError> {
        if self.solver.domain.is_some() {
            return Err(setup("rain by a function falls on one process only"));
        }
        #[cfg(feature = "gpu")]
        if self.on_gpu.is_some() {
            return Err(setup("rain by a function falls on the CPU only: take no GPU"));
        }
        self.weather = Some(Weather::under(rain));
        self.make_all_tiles()
    }

    /// All but the water.
    fn empty(
        processes: &Processes,
        settings: &Flood,
        seed: u64,
        folder: &Path,
        terrain: Arc<Terrain>,
    ) -> Result<Self, ModelError> {
        // A file may be missing for one process only.
        let opened = Self::without_cells(processes, settings, seed, folder, terrain);
        let mut model = processes.agree(opened, ModelError::Setup)?;
        model.open_zones(folder)?;
        Ok(model)
    }

    /// All but cells and water.
    fn without_cells(
        processes: &Processes,
        settings: &Flood,
        seed: u64,
        folder: &Path,
        terrain: Arc<Terrain>,
    ) -> Result<Self, ModelError> {
        let mut settings = settings.clone();
        let spacing = spacing::resolve(&mut settings, &terrain, folder)?;
        let gravity = settings.gravity_m_per_s2;
        limits::check_blocks(&settings, &terrain)?;
        let boundaries = Boundaries::open(&settings, &terrain, folder)?;
        let (periodic, mirrors, brings) = (boundaries.periodic(), boundaries.mirrors(), boundaries.brings());
        let obstacles = Arc::new(obstacles::open(&settings, &terrain, folder, 4.0 * spacing)?);
        let points = setup::point_gauges(&settings, &terrain)?;
        let mut warnings = setup::warn_of_gauges(&points, &settings, &obstacles.all, &terrain);
        warnings.extend(warn_of_links(&settings, &terrain));
        let mut layout = Layout::new(terrain.bounds(), periodic, spacing, seed);
        let roughness = Roughness::open(&settings, &terrain, folder)?;
        let slowing = Slowing::of(&roughness, gravity);
        let structures = Structures::open(&settings, &terrain, folder, spacing)?;
        let weather = Weather::open(&settings, &terrain, folder)?;
        let state = State {
            time: 0.0,
            before: 0.0,
            steps: 0,
            particle_steps: 0,
            time_step: 0.0,
            tiles: Vec::new(),
            counts: Vec::new(),
            columns: [Vec::new(), Vec::new()],
            records: Vec::new(),
            beyond: Vec::new(),
            falling: Vec::new(),
            soaked: Soaked::default(),
            booked_before: Default::default(),
            flows: structures.at_rest(),
            impulses: vec![[0.0; 2]; settings.obstacle.len()],
            forces: vec![[0.0; 2]; settings.obstacle.len()],
            water: Account::default(),
            momentum: Account::default(),
            energy: Account::default(),
            warnings,
            overrides: Overrides::default(),
            blocks: Vec::new(),
            remakes: 0,
        };
        let mut lines = walls::of_lines(&settings, &terrain, spacing)?;
        let grading = finer::grading(&settings, &terrain, folder, (layout.spacing(), &obstacles.all, &lines))?;
        let adaptive = refine(&mut layout, grading, settings.adaptive)?;
        if settings.time_steps == TimeSteps::Local {
            // Many short steps are taken before tiles are made.
            layout.rim *= f64::from(1_u32 << HIGHEST);
        }
        let longest = longest_step(&layout, gravity);
        let finest = layout.finest_spacing();
        lines.extend(walls::of_sides(&settings, &terrain)?);
        let bed = Bed::new(Arc::clone(&terrain), obstacles, mirrors, periodic, lines, spacing, settings.storage);
        let mut roofs = walls::areas(&bed.obstacles.all, settings.obstacle.len(), terrain.bounds());
        let flat = settings.obstacle.iter().map(|obstacle| obstacle.height_m.is_none());
        roofs.iter_mut().zip(flat).filter(|(_, flat)| *flat).for_each(|(area, _)| *area = 0.0);
        let mut mesh = Mesh::new(layout);
        mesh.cut(&bed);
        let mut solver = Solver::new(mesh, gravity, slowing, longest, brings);
        solver.local = (settings.time_steps == TimeSteps::Local).then(Local::default);
        solver.domain = Domain::new(processes, &solver.mesh.layout, solver.local.is_some());
        Ok(Self {
            points,
            lines: setup::line_gauges(&settings, &terrain, finest)?,
            solver,
            adaptive,
            zone_tiles: 0,
            inflows: Vec::new(),
            patches: Patches::default(),
            obstacle_of: Vec::new(),
            pushes: vec![[ExactSum::default(); 2]; settings.obstacle.len()],
            roofs,
            written: Vec::new(),
            shown: 0.0,
            #[cfg(feature = "gpu")]
            on_gpu: None,
            settings,
            folder: folder.to_path_buf(),
            terrain,
            bed,
            roughness,
            boundaries,
            weather,
            structures,
            state,
        })
    }

    /// Makes the tiles of inflows, structures and held sides, and finds their cells.
    fn open_zones(&mut self, folder: &Path) -> Result<(), ModelError> {
        let sources = setup::sources(&self.settings, &self.terrain, folder, self.solver.mesh.layout.spacing());
        let sources = domain::agreed(self.solver.domain.as_ref(), sources)?;
        let mesh = &self.solver.mesh;
        let mut tiles = Patches::tiles(&self.structures, mesh);
        tiles.extend(sources.iter().flat_map(|source| Patch::tiles(&source.zone, mesh)));
        tiles.extend(self.boundaries.brings()[usize::from(LINE)].then(|| self.tiles_of_lines()).into_iter().flatten());
        let [columns, rows] = mesh.layout.tiles;
        for (side, brings) in self.boundaries.brings().into_iter().take(4).enumerate() {
            if brings {
                tiles.extend((0..columns * rows).filter(|tile| match side {
                    0 => tile % columns == 0,
                    1 => tile % columns == columns - 1,
                    2 => tile / columns == 0,
                    _ => tile / columns == rows - 1,
                }));
            }
        }
        self.make_tiles(tiles)?;
        let mesh = &self.solver.mesh;
        for (number, line) in self.settings.edge_line.iter().enumerate() {
            let has_face = mesh.line_faces.iter().any(|(_, of_face)| *of_face as usize == number);
            let has_face = domain::any(self.solver.domain.as_ref(), has_face);
            if !has_face && self.boundaries.brings()[usize::from(LINE)] {
                return Err(setup(format!(
                    "flood.edge_line.{number} from {:?} cuts no cell: it is shorter than the cells are wide, or lies where there is no ground",
                    line.line[0]
                )));
            }
        }
        self.check_sides()?;
        let mesh = &self.solver.mesh;
        let domain = self.solver.domain.as_ref();
        self.zone_tiles = self.tiles().len();
        self.patches = Patches::of(&self.structures, mesh, domain);
        for (source, written) in sources.into_iter().zip(&self.settings.inflow) {
            let patch = Patch::of(&source.zone, mesh, domain);
            if patch.is_empty() {
                let name = &written.name;
                return Err(setup(format!(
                    "the inflow '{name}' lies where there is no ground: in an obstacle or where the terrain has no data"
                )));
            }
            let (zone, discharge, velocity) = (source.zone, source.discharge, source.velocity);
            self.inflows.push(Inflow { zone, patch, discharge, velocity });
        }
        if self.weather.as_ref().is_some_and(Weather::rains) {
            self.make_all_tiles()?;
        }
        Ok(())
    }

    /// Refuses sides and parts of them over which water is to come in and that have no cell: their water would be lost in silence.
    fn check_sides(&self) -> Result<(), ModelError> {
        let has_face = self.boundaries.have_faces();
        let sides = ["west", "east", "south", "north"].map(|side| format!("flood.edges.{side}"));
        let parts = (0..self.settings.edge_part.len()).map(|part| format!("flood.edge_part.{part}"));
        let divided = self.boundaries.divided();
        for (rule, key) in sides.into_iter().chain(parts).enumerate() {
            // Parts may take the whole of a side.
            if divided.get(rule) == Some(&true) {
                continue;
            }
            let has_face = domain::any(self.solver.domain.as_ref(), has_face[rule]);
            if self.boundaries.brings_by(rule) && !has_face {
                return Err(setup(format!(
                    "{key}: no water can come in there: no cell has the middle of its side there; make the part longer than the cells are \
                     wide, or look whether the terrain has data there"
                )));
            }
        }
        Ok(())
    }

    /// The tiles beside the lines inside at which water comes or goes.
    fn tiles_of_lines(&self) -> Vec<usize> {
        let half_width = 2.0 * self.solver.mesh.layout.spacing();
        let lines = self.settings.edge_line.iter().flat_map(|line| line.line.windows(2));
        let band = |ends: &[[f64; 2]]| Zone::Band {
            line: ends.iter().map(|position| self.terrain.to_model(*position)).collect(),
            half_width,
        };
        lines.flat_map(|ends| Patch::tiles(&band(ends), &self.solver.mesh)).collect()
    }

    pub(super) fn make_all_tiles(&mut self) -> Result<(), ModelError> {
        let [columns, rows] = self.solver.mesh.layout.tiles;
        self.make_tiles((0..columns * rows).collect())
    }

    /// Makes tiles that are not made yet.
    pub(super) fn make_tiles(&mut self, mut tiles: Vec<usize>) -> Result<(), ModelError> {
        tiles.sort_unstable();
        tiles.dedup();
        tiles.retain(|tile| match &self.solver.domain {
            None => !self.solver.mesh.has(*tile),
            Some(domain) => !domain.is_made(*tile),
        });
        self.make_in_order(&tiles)
    }

    /// Makes tiles that are not made yet, each after the one before it.
    pub(super) fn make_in_order(&mut self, tiles: &[usize]) -> Result<(), ModelError> {
        let layout = &self.solver.mesh.layout;
        let processes = self.solver.domain.as_ref().map_or(1, Domain::count) as f64;
        let made: f64 = match &self.solver.domain {
            None => self.solver.mesh.len() as f64,
            Some(domain) => domain.made.iter().map(|tile| layout.about(*tile as usize)).sum(),
        };
        let cells = made + tiles.iter().map(|tile| layout.about(*tile)).sum::<f64>();
        if cells > MOST_CELLS * processes {
            return Err(setup(format!(
                "the water would need about {cells:.1e} particles, more than the {MOST_CELLS:.0e} that fit in memory; \
                 take a larger flood.spacing_m"
            )));
        }
        let kept = self.solver.domain.as_mut().map(|domain| domain.add_tiles(tiles));
        self.solver.mesh.make(kept.as_deref().unwrap_or(tiles), &self.bed);
        if let Some(domain) = &mut self.solver.domain {
            domain.add_cells(&self.solver.mesh);
        }
        self.solver.grow();
        if self.solver.end_local_steps() {
            let step = self.solver.time_step();
            self.state.time_step = self.limit_time_step(step);
        }
        let mesh = &self.solver.mesh;
        self.solver.slowing.extend(&self.roughness, self.solver.gravity, &mesh.centroid);
        self.state.records.resize(mesh.len(), DRY);
        let borders = &self.solver.borders[self.obstacle_of.len()..];
        let at = |border: &u32| mesh.obstacle_faces.binary_search_by_key(border, |(face, _)| *face).ok();
        let obstacles = borders.iter().map(|border| at(border).map(|index| mesh.obstacle_faces[index].1));
        self.obstacle_of.extend(obstacles.map(|obstacle| obstacle.unwrap_or(NONE)));
        self.solver.crests = walls::crests(mesh);
        self.boundaries.extend(&self.solver, &self.terrain);
        // Water has not come to tiles that are made while the model runs.
        for border in self.state.beyond.len()..self.solver.borders.len() {
            self.state.beyond.push(self.boundaries.beyond_at_start(&self.solver, border));
        }
        if let Some(weather) = &mut self.weather {
            let extended = weather.extend(&self.solver.mesh, &self.terrain, &mut self.state.soaked);
            domain::agreed(self.solver.domain.as_ref(), extended)?;
            weather.roofs = walls::collect(&self.solver.mesh, &self.roofs, self.solver.domain.as_ref());
        }
        if !tiles.is_empty() {
            self.connect();
        }
        Ok(())
    }

    /// Makes the tiles in which there is water at the start.
    fn make_first_tiles(&mut self, bodies: &[StartWater]) -> Result<(), ModelError> {
        let layout = &self.solver.mesh.layout;
        let may_be_at =
            |at: [f64; 2], ground: f64| bodies.iter().any(|body| body.may_be_at(at, ground, layout.spacing()));
        let wet = |tile: &usize| {
            // Most tiles of a large terrain are dry by its heights alone.
            let lowest = self.terrain.lowest_within(layout.rectangle(*tile), HEIGHTS_A_TILE);
            layout.positions(*tile).any(|at| may_be_at(at, lowest))
                && layout.positions(*tile).any(|at| may_be_at(at, self.terrain.height(at[0], at[1])))
        };
        let all = (0..layout.tiles[0] * layout.tiles[1]).into_par_iter();
        // Each process looks at its own ground.
        let own = all.filter(|tile| self.solver.domain.as_ref().is_none_or(|domain| domain.owns_tile(*tile)));
        let tiles: Vec<usize> = if bodies.is_empty() { Vec::new() } else { own.filter(wet).collect() };
        let tiles = match &self.solver.domain {
            Some(domain) => domain.union(tiles),
            None => tiles,
        };
        self.make_tiles(tiles)
    }

    /// Fills in the water at the start, and makes the tiles beside it.
    fn fill(&mut self, bodies: &[StartWater]) -> Result<(), ModelError> {
        if self.tiles().is_empty() && bodies.is_empty() {
            return Ok(());
        }
        loop {
            self.solver.columns.copy_from_slice(&start::columns(&self.solver.mesh, bodies));
            self.solver.update_water();
            let missing = self.solver.missing_tiles();
            if missing.is_empty() {
                break;
            }
            self.make_tiles(missing)?;
        }
        Ok(())
    }

    /// Says of which bodies of water there is none.
    fn warn_of_empty(&mut self, bodies: &[StartWater]) {
        if self.tiles().is_empty() && bodies.is_empty() {
            return;
        }
        for (number, body) in bodies.iter().enumerate() {
            let some = start::columns(&self.solver.mesh, std::slice::from_ref(body)).iter().any(|c| c.volume > 0.0);
            if !domain::any(self.solver.domain.as_ref(), some) {
                self.state.warnings.push(format!(
                    "Body {number} of the water at the start (from 0, without blocks) holds no water: its level lies below \
                     the ground, its depth is 0, or it lies where there is no ground."
                ));
            }
        }
    }

    fn begin(&mut self, seed: u64) {
        // As far apart as written, not as the cells are: so blocks hold the water that they say.
        let spacing = self.settings.spacing_m.unwrap_or_else(|| self.solver.mesh.layout.spacing());
        self.state.falling = drops(&self.settings, spacing, &self.terrain, seed);
        let none = self.solver.columns.iter().all(|column| column.volume <= 0.0) && self.state.falling.is_empty();
        let none = !domain::any(self.solver.domain.as_ref(), !none);
        if none
            && self.weather.is_none()
            && self.structures.held.is_empty()
            && self.inflows.is_empty()
            && !self.boundaries.bring()
        {
            let what = "There is no water: give [[flood.water]], [[flood.inflow]], [flood.rain], [[flood.stage]], or an edge with a stage.";
            self.state.warnings.push(what.into());
        }
        let step = self.solver.update_water();
        self.state.time_step = FIRST_STEP * self.limit_time_step(step);
        let columns = self.solver.columns.clone();
        *self.solver.before_mut() = columns;
        for (border, beyond) in self.state.beyond.iter_mut().enumerate() {
            *beyond = self.boundaries.beyond_at_start(&self.solver, border);
        }
        self.state.water.initial = self.stored();
        self.state.momentum.initial = self.momentum();
        self.state.energy.initial = self.energy(0.0).iter().sum();
        self.solver.shrink();
        let wet_depth = self.settings.wet_depth_m;
        let starts = self.solver.water.iter().map(|water| Record::start(water, wet_depth));
        self.state.records = starts.collect();
    }
}

/// The longest time step, s: where there is no water yet, or hardly any.
pub(super) fn longest_step(layout: &Layout, gravity: f64) -> f64 {
    0.5 * layout.finest_spacing() / (gravity * DRY_DEPTH).sqrt()
}

/// Adds finer cells to a layout where a scene has them; returns the adaptive refinement, if any.
///
/// # Errors
/// [`ModelError::Setup`] where the finest cells would not be finer than others.
fn refine(
    layout: &mut Layout,
    grading: Grading,
    settings: Option<corpuscle_scene::Adaptive>,
) -> Result<Option<Adaptive>, ModelError> {
    let has_parts = !grading.is_even();
    let Some(settings) = settings else {
        if has_parts {
            layout.refine(grading, 0);
        }
        return Ok(None);
    };
    let spacing = layout.spacing();
    if settings.finest_m >= spacing {
        return Err(setup(format!(
            "flood.adaptive.finest_m is {}: must be smaller than {spacing:.4}, the spacing elsewhere",
            settings.finest_m
        )));
    }
    let deepest = grading.level_of(settings.finest_m);
    let grading = grading.with(Blocks::new(layout));
    layout.refine(grading, deepest);
    Ok(Some(Adaptive::new(settings, layout, has_parts)))
}

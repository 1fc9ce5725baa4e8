//! How a flood is set up.

use super::boundaries::{EdgeRule, EdgeRules};
use super::change::Overrides;
use super::density::h_of_density;
use super::falling::Falling;
use super::maps::Maps;
use super::obstacles::Obstacles;
use super::particle::Particle;
use super::seeding::Body;
use super::solver::SphSweSolver;
use super::surroundings::Surroundings;
use super::{SphSweFlood, State};
use crate::friction::Roughness;
use crate::initial_water::{self, InitialWater};
use crate::{error, fields, limits, obstacles, setup, spacing};
use corpuscle_model::{Account, CompensatedSum, ModelError};
use corpuscle_scene::{Block, Edge, Flood, Scheme, SmoothingForm, SphSwe};
use corpuscle_sph::kernel::{Kernel, SmoothingKernel};
use corpuscle_terrain::Terrain;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::path::Path;
use std::sync::Arc;

/// Smoothing length in Table 1 of the paper, over the root of the volume of its particles, m^(-1/2).
const TABLE_1_SMOOTHING: f64 = 2.66;

impl SphSweFlood {
    /// Sets a flood up as the `[flood]` of a scene says, its defaults resolved, with the scene's seed. `folder` is what
    /// relative paths refer to.
    ///
    /// # Errors
    /// [`ModelError::Setup`] where something cannot be opened or lies outside the terrain.
    pub fn new(settings: &Flood, seed: u64, folder: &Path, terrain: Arc<Terrain>) -> Result<Self, ModelError> {
        let ground = Arc::clone(&terrain);
        let bodies = initial_water::initial_water(settings, &ground, folder)?;
        Self::with_water(settings, seed, folder, terrain, &bodies)
    }

    /// As [`SphSweFlood::new`], but without the water at the start, which takes a while to arrange: for a state that is restored.
    ///
    /// # Errors
    /// As [`SphSweFlood::new`].
    pub fn to_restore(settings: &Flood, seed: u64, folder: &Path, terrain: Arc<Terrain>) -> Result<Self, ModelError> {
        let ground = Arc::clone(&terrain);
        let bodies = initial_water::initial_water(settings, &ground, folder)?;
        Self::empty(settings, seed, folder, terrain, &bodies)
    }

    /// As [`SphSweFlood::new`], with the water at the start given as functions instead of by the scene.
    ///
    /// # Errors
    /// As [`SphSweFlood::new`].
    pub fn with_water(
        settings: &Flood,
        seed: u64,
        folder: &Path,
        terrain: Arc<Terrain>,
        bodies: &[InitialWater],
    ) -> Result<Self, ModelError> {
        let mut model = Self::empty(settings, seed, folder, terrain, bodies)?;
        model.fill(bodies);
        model.begin()?;
        Ok(model)
    }

    /// All but the particles.
    fn empty(
        settings: &Flood,
        seed: u64,
        folder: &Path,
        terrain: Arc<Terrain>,
        bodies: &[InitialWater],
    ) -> Result<Self, ModelError> {
        if settings.scheme != Scheme::SphSwe {
            return Err(error::setup(
                "this is the model of scheme sph-swe: corpuscle_flood::open chooses by the scene",
            ));
        }
        let mut settings = settings.clone();
        let flood = &mut settings;
        let map_period = flood
            .map_every_s
            .ok_or_else(|| ModelError::Setup("flood.map_every_s is open; resolve the scene's defaults first".into()))?;
        let spacing = spacing::resolve(flood, &terrain, folder)?;
        let depth =
            *flood.spacing_depth_m.get_or_insert_with(|| initial_water::mean_depth(bodies, &terrain).unwrap_or(1.0));
        let volume = spacing * spacing * depth;
        // Neighbours in the reach: pi h0^2 rho0 / m, whatever the depth. Table 1 has particles of 1 m3.
        let h = *flood.sph_swe.smoothing_length_m.get_or_insert(TABLE_1_SMOOTHING * volume.sqrt());
        check_smoothing(&flood.sph_swe, h, volume)?;
        flood.sph_swe.radius_m.get_or_insert(0.5 * spacing);
        limits::check_blocks(flood, &terrain)?;
        limits::check_count(flood, bodies, &terrain, spacing, volume)?;
        let edges = edge_rules(flood, &terrain)?;
        let reach = flood.sph_swe.largest_smoothing * h;
        let closest = initial_water::closest(bodies, &terrain, spacing, volume);
        let outlines = obstacles::open(flood, &terrain, folder, reach)?;
        let points = setup::point_gauges(flood, &terrain)?;
        let warnings = setup::warn_of_gauges(&points, flood, &outlines.all, &terrain);
        let obstacles =
            Obstacles::new(flood, &terrain, outlines, closest, reach, &Kernel::new(flood.sph_swe.kernel, h));
        let sources = setup::sources(flood, &terrain, folder, spacing)?;
        let state = State {
            time: 0.0,
            steps: 0,
            particle_steps: 0,
            particles: Vec::new(),
            falling: Vec::new(),
            residual_volume: vec![CompensatedSum::default(); sources.len()],
            next_id: 0,
            water: Account::default(),
            momentum: Account::default(),
            maps: Maps::new(&terrain, flood.wet_depth_m),
            next_sample: 0,
            time_step: 0.0,
            cell: h,
            external: [0.0; 2],
            on_obstacles: vec![[0.0; 2]; obstacles.names.len()],
            impulses: vec![[0.0; 2]; obstacles.names.len()],
            put_back: 0,
            overtopped: vec![None; obstacles.names.len()],
            warnings,
            overrides: Overrides::default(),
        };
        let model = Self {
            roughness: Roughness::open(flood, &terrain, folder)?,
            points,
            lines: setup::line_gauges(flood, &terrain, spacing)?,
            map_period,
            surroundings: Surroundings { terrain, edges, obstacles },
            solver: SphSweSolver::new(settings.sph_swe.clone(), h, settings.gravity_m_per_s2),
            settings,
            seed,
            sources,
            spacing,
            volume,
            h,
            state,
            written: Vec::new(),
            of_blocks: Vec::new(),
            block_updates: Vec::new(),
            shown: 0.0,
            #[cfg(feature = "gpu")]
            on_gpu: None,
        };
        Ok(model)
    }

    /// The smoothing length with which the density is found for the first time in water of a depth, m.
    fn first_h(&self, depth: f64) -> f64 {
        let sph_swe = &self.settings.sph_swe;
        match sph_swe.smoothing {
            SmoothingForm::Density => self.h,
            // Form (8) counts neighbours by their distances there.
            SmoothingForm::Rate => h_of_density(sph_swe, self.h, sph_swe.density_kg_per_m3 * depth),
        }
    }

    /// Fills in the water at the start.
    fn fill(&mut self, bodies: &[InitialWater]) {
        let flood = &self.settings;
        for (number, body) in bodies.iter().enumerate() {
            let seed = self.seed.wrapping_add(number as u64);
            let mut particles = Body {
                depth: &*body.depth,
                inside: &*body.inside,
                within: body.within,
                volume: self.volume,
                spacing: self.spacing,
                shallowest: flood.wet_depth_m,
            }
            .fill(&self.surroundings.edges, &self.surroundings.obstacles, seed);
            if particles.is_empty() {
                self.state.warnings.push(format!(
                    "Body {number} of the water at the start (from 0, without blocks) holds no water: its level lies below \
                     the ground, or its depth below wet_depth_m."
                ));
            }
            for particle in &mut particles {
                [particle.u, particle.v] = (body.velocity)(particle.x, particle.y);
                particle.h = self.first_h(particle.depth);
                particle.next_h = particle.h;
            }
            self.state.particles.append(&mut particles);
        }
        let mut random = setup::random(self.seed, u64::MAX);
        for water in &flood.water {
            if let Some(block) = &water.block {
                let velocity = fields::block_velocity(&water.velocity_m_per_s, &self.surroundings.terrain);
                let falling = self.block(block, &velocity, &mut random);
                self.state.falling.extend(falling);
            }
        }
        let State { particles, falling, .. } = &mut self.state;
        let all = particles.iter_mut().chain(falling.iter_mut().map(|drop| &mut drop.particle));
        self.state.next_id = all.enumerate().map(|(number, particle)| particle.id = number as u64).count() as u64;
        if self.state.next_id == 0 && self.sources.is_empty() {
            self.state.warnings.push("There is no water: give [[flood.water]] or [[flood.inflow]].".into());
        }
    }

    /// The particles of a block in the air: layers of a lattice, each shifted a little at random so that no two stand one above the other.
    fn block(&self, block: &Block, velocity: &dyn Fn(f64, f64) -> [f64; 2], random: &mut ChaCha8Rng) -> Vec<Falling> {
        let (terrain, spacing) = (&*self.surroundings.terrain, self.spacing);
        let [from, to] = [block.from, block.to].map(|corner| terrain.to_model(corner));
        let centre = [0, 1].map(|axis| 0.5 * (from[axis] + to[axis]));
        let bottom = terrain.height(centre[0], centre[1]) + block.height_m;
        let count = setup::lattice(block, terrain, spacing).map(|count| count as usize);
        let mut falling = Vec::with_capacity(count[0] * count[1] * block.layers);
        for layer in 0..block.layers {
            for row in 0..count[1] {
                for column in 0..count[0] {
                    let mut at =
                        |from: f64, k: usize| from + (k as f64 + 0.5 + random.random_range(-0.2..0.2)) * spacing;
                    let (x, y) = (at(from[0], column), at(from[1], row));
                    let mut particle = Particle::new(0, x, y, self.volume, self.h);
                    [particle.u, particle.v] = velocity(x, y);
                    falling.push(Falling { particle, z: bottom + (layer as f64 + 0.5) * spacing, w: 0.0 });
                }
            }
        }
        falling
    }

    fn begin(&mut self) -> Result<(), ModelError> {
        self.state.water.initial = self.stored();
        self.state.momentum.initial = self.momentum();
        self.update_smoothing_lengths();
        self.arrange();
        self.state.external = self.solver.evaluate(&mut self.state.particles, &self.surroundings, 0.0);
        self.state.time_step = self.limit_time_step(self.settings.sph_swe.time_step_s);
        self.state.on_obstacles.copy_from_slice(self.solver.on_obstacles());
        if let Some(error) = self.defect_among(&self.state.particles, 0.0, 0) {
            return Err(error);
        }
        self.sample_maps();
        Ok(())
    }
}

/// The rules of the sides.
fn edge_rules(scene: &Flood, terrain: &Terrain) -> Result<EdgeRules, ModelError> {
    let rule = |edge: &Edge| match edge {
        Edge::Open => Ok(EdgeRule::Open),
        Edge::Wall => Ok(EdgeRule::Wall),
        Edge::Periodic => Ok(EdgeRule::Periodic),
        _ => Err(error::setup("sides of this kind are for scheme voronoi: see [flood.edges]")),
    };
    let edges = &scene.edges;
    let rules = [rule(&edges.west)?, rule(&edges.east)?, rule(&edges.south)?, rule(&edges.north)?];
    Ok(EdgeRules { bounds: terrain.bounds(), rules })
}

/// Refuses an initial smoothing length, m, with which a particle's weight of itself, m W(0, h), is more than its density: with
/// `smoothing = "density"` h would be shorter in the next step, that weight larger, and so on without end.
fn check_smoothing(parameters: &SphSwe, h: f64, volume: f64) -> Result<(), ModelError> {
    // The depth that a particle alone has where its smoothing length is h, which goes with a depth of 1 m.
    let own_depth = volume * Kernel::<2>::new(parameters.kernel, h).value(0.0);
    if own_depth < 1.0 || parameters.smoothing != SmoothingForm::Density {
        return Ok(());
    }
    Err(error::setup(format!(
        "flood.sph_swe.smoothing_length_m = {h} is so short for particles of {volume:.4} m3 that one alone would get deeper with each step; \
         give more than {:.4} ({:.4} gives as many neighbours as the paper has)",
        h * own_depth.sqrt(),
        TABLE_1_SMOOTHING * volume.sqrt(),
    )))
}

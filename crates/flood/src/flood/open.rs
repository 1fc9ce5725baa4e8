//! How a flood is set up.

use super::by_hand::Hand;
use super::{Flood, State, weather};
use crate::balanced::{self, Balanced};
use crate::edges::BeforeWalls;
use crate::fields;
use crate::friction::Roughness;
use crate::limits;
use crate::maps::Maps;
use crate::obstacles;
use crate::rain::Ground;
use crate::refinement::Refinement;
use crate::scheme::{Scheme, Sizes, Surroundings};
use crate::seeding::Body;
use crate::setup::{self, InitialWater};
use crate::spacing;
use crate::sph_swe::{SphSwe, h_of_density};
use crate::structures::Structures;
use corpuscle_model::{Account, ExactSum, ModelError};
use corpuscle_scene::{Flood as Settings, Scheme as SchemeName, SmoothingForm};
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::Arc;

/// The depth over `spacing_depth_m` whose wave speed sets the time step where there is no water.
const DRY_DEPTH: f64 = 0.05;

/// Smoothing length in Table 1 of scheme sph-swe, over the root of the volume of its particles, m^(-1/2).
const TABLE_1_SMOOTHING: f64 = 2.66;

/// The numbers of scheme balanced in water of `depth` m, whose particles have smoothing length `h`, m.
pub(super) fn balanced_parameters(flood: &Settings, depth: f64, h: f64) -> balanced::Parameters {
    let shallow = (flood.gravity_m_per_s2 * DRY_DEPTH * depth).sqrt();
    balanced::Parameters {
        gravity: flood.gravity_m_per_s2,
        eta: flood.balanced.smoothing,
        largest_h: flood.balanced.largest_smoothing * h,
        viscosity: flood.balanced.viscosity,
        cfl: flood.balanced.cfl,
        longest_step: flood.balanced.cfl * h / shallow,
    }
}

impl Flood {
    /// Sets a flood up as the `[flood]` of a scene says, its defaults resolved, with the scene's seed. `folder` is what
    /// relative paths refer to.
    ///
    /// # Errors
    /// [`ModelError::Setup`] where something cannot be opened or lies outside the terrain.
    pub fn new(settings: &Settings, seed: u64, folder: &Path, terrain: Arc<Terrain>) -> Result<Self, ModelError> {
        let ground = Arc::clone(&terrain);
        let bodies = setup::initial_water(settings, &ground, folder)?;
        Self::with_water(settings, seed, folder, terrain, &bodies)
    }

    /// As [`Flood::new`], but without the water at the start, which takes a while to arrange: for a state that is restored.
    ///
    /// # Errors
    /// As [`Flood::new`].
    pub fn to_restore(
        settings: &Settings,
        seed: u64,
        folder: &Path,
        terrain: Arc<Terrain>,
    ) -> Result<Self, ModelError> {
        let ground = Arc::clone(&terrain);
        let bodies = setup::initial_water(settings, &ground, folder)?;
        Self::empty(settings, seed, folder, terrain, &bodies)
    }

    /// As [`Flood::new`], with the water at the start given as functions instead of by the scene.
    ///
    /// # Errors
    /// As [`Flood::new`].
    pub fn with_water(
        settings: &Settings,
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
        settings: &Settings,
        seed: u64,
        folder: &Path,
        terrain: Arc<Terrain>,
        bodies: &[InitialWater],
    ) -> Result<Self, ModelError> {
        if settings.scheme == SchemeName::Voronoi {
            return Err(setup::setup("scheme voronoi is a model of its own: corpuscle_flood::open chooses"));
        }
        let mut settings = settings.clone();
        let flood = &mut settings;
        let map_period = flood
            .map_every_s
            .ok_or_else(|| ModelError::Setup("flood.map_every_s is open; resolve the scene's defaults first".into()))?;
        let spacing = spacing::resolve(flood, &terrain, folder)?;
        let depth = *flood.spacing_depth_m.get_or_insert_with(|| setup::mean_depth(bodies, &terrain).unwrap_or(1.0));
        let volume = spacing * spacing * depth;
        let (scheme, h): (Box<dyn Scheme>, f64) = match flood.scheme {
            SchemeName::Balanced | SchemeName::Voronoi => {
                let h = flood.balanced.smoothing * spacing;
                let parameters = balanced_parameters(flood, depth, h);
                (Box::new(Balanced::new(parameters)), h)
            }
            SchemeName::SphSwe => {
                // Neighbours in the reach: pi h0^2 rho0 / m, whatever the depth. Table 1 has particles of 1 m3.
                let h = *flood.sph_swe.smoothing_length_m.get_or_insert(TABLE_1_SMOOTHING * volume.sqrt());
                flood.sph_swe.radius_m.get_or_insert(0.5 * spacing);
                (Box::new(SphSwe::new(flood.sph_swe.clone(), h, flood.gravity_m_per_s2)), h)
            }
        };
        limits::check_blocks(flood, &terrain)?;
        limits::check_count(flood, bodies, &terrain, spacing, volume)?;
        let edges = setup::edge_rules(flood, &terrain, folder)?;
        let reach = match flood.scheme {
            SchemeName::Balanced | SchemeName::Voronoi => 2.0 * flood.balanced.largest_smoothing * h,
            SchemeName::SphSwe => flood.sph_swe.largest_smoothing * h,
        };
        let obstacles =
            obstacles::open(flood, &terrain, folder, setup::closest(bodies, &terrain, spacing, volume), reach, h)?;
        let sources = setup::sources(flood, &terrain, folder, spacing)?;
        let refinement = flood.refinement.as_ref().map(|refinement| Refinement::new(refinement, volume, spacing));
        let widest = weather::widest(flood, spacing, refinement.as_ref());
        let ground = Ground::open(flood, &terrain, folder, volume, widest)?;
        let structures = Structures::open(flood, &terrain, folder, spacing)?;
        let state = State {
            time: 0.0,
            steps: 0,
            particle_steps: 0,
            particles: Vec::new(),
            falling: Vec::new(),
            owed: vec![ExactSum::default(); sources.len()],
            next_id: 0,
            flows: structures.at_rest(),
            wetness: ground.as_ref().map(Ground::dry).unwrap_or_default(),
            water: Account::default(),
            momentum: Account::default(),
            maps: Maps::new(&terrain, flood.wet_depth_m),
            next_look: 0,
            time_step: 0.0,
            sizes: Sizes { cell: h, even: true },
            external: [0.0; 2],
            on_obstacles: vec![[0.0; 2]; obstacles.names.len()],
            impulses: vec![[0.0; 2]; obstacles.names.len()],
            put_back: 0,
            overtopped: vec![None; obstacles.names.len()],
            warnings: Vec::new(),
            hand: Hand::default(),
        };
        let model = Self {
            roughness: Roughness::open(flood, &terrain, folder)?,
            ground,
            structures,
            refinement,
            points: setup::point_gauges(flood, &terrain)?,
            lines: setup::line_gauges(flood, &terrain, spacing)?,
            map_period,
            surroundings: Surroundings { terrain, edges, obstacles, time: 0.0 },
            settings,
            seed,
            scheme,
            sources,
            spacing,
            volume,
            h,
            state,
            before_hand: Vec::new(),
            of_blocks: Vec::new(),
            renewals: Vec::new(),
            shown: 0.0,
            #[cfg(feature = "gpu")]
            card: None,
        };
        Ok(model)
    }

    pub(super) fn before_walls(&self) -> BeforeWalls {
        let spacing = if self.settings.scheme == SchemeName::Balanced { self.spacing } else { 0.0 };
        BeforeWalls { eta: self.settings.balanced.smoothing, spacing }
    }

    /// The smoothing length of scheme sph-swe with which the density is found for the first time in water of a depth, m.
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
        let eta = flood.balanced.smoothing;
        for (number, body) in bodies.iter().enumerate() {
            let seed = self.seed.wrapping_add(number as u64);
            let mut particles = Body {
                depth: &*body.depth,
                inside: &*body.inside,
                within: body.within,
                volume: self.volume,
                spacing: self.spacing,
                before_walls: self.before_walls(),
                fine_shores: flood.scheme == SchemeName::Balanced && flood.balanced.fine_shores,
                eta,
                largest_h: flood.balanced.largest_smoothing * eta * self.spacing,
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
                if flood.scheme == SchemeName::SphSwe {
                    particle.h = self.first_h(particle.depth);
                    particle.next_h = particle.h;
                }
            }
            self.state.particles.append(&mut particles);
        }
        let mut random = setup::random(self.seed, u64::MAX);
        for water in &flood.water {
            if let Some(block) = &water.block {
                let terrain = &self.surroundings.terrain;
                let velocity = fields::block_velocity(&water.velocity_m_per_s, terrain);
                let falling = setup::block(block, &velocity, terrain, self.spacing, self.volume, self.h, &mut random);
                self.state.falling.extend(falling);
            }
        }
        let State { particles, falling, .. } = &mut self.state;
        let all = particles.iter_mut().chain(falling.iter_mut().map(|drop| &mut drop.particle));
        self.state.next_id = all.enumerate().map(|(number, particle)| particle.id = number as u64).count() as u64;
        if self.state.next_id == 0
            && self.ground.is_none()
            && self.structures.held.is_empty()
            && self.sources.is_empty()
            && !self.surroundings.edges.holds_level()
        {
            let what = "There is no water: give [[flood.water]], [[flood.inflow]], [flood.rain], [[flood.stage]], or an edge with a stage.";
            self.state.warnings.push(what.into());
        }
    }

    fn begin(&mut self) -> Result<(), ModelError> {
        self.state.water.initial = self.stored();
        self.state.momentum.initial = self.momentum();
        self.renew();
        self.arrange();
        if self.surroundings.edges.holds_level() {
            self.gain(0.0);
            self.renew();
            self.arrange();
        }
        let evaluation = self.scheme.evaluate(&mut self.state.particles, &self.surroundings, 0.0);
        self.state.time_step = self.limited(evaluation.time_step);
        self.state.external = evaluation.external;
        self.state.on_obstacles.copy_from_slice(self.scheme.on_obstacles());
        if let Some(error) = self.defect_among(&self.state.particles, 0.0, 0) {
            return Err(error);
        }
        self.look();
        Ok(())
    }
}

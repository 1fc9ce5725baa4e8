//! What the shaders must know of a run.

use super::layout::{self, Origin, Parameters};
use super::walls::Walls;
use super::works::Works;
use crate::balanced;
use crate::edges::EdgeRule;
use crate::friction::Roughness;
use crate::inflow::Source;
use crate::rain::Ground;
use crate::refinement::Refinement;
use crate::scheme::Surroundings;
use crate::structures::Structures;
use corpuscle_scene::SphSwe;
use corpuscle_terrain::GroundPatches;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// What the water moves in, and how.
#[derive(Clone, Copy)]
pub(crate) struct Setting<'a> {
    pub surroundings: &'a Surroundings,
    pub scheme: &'a balanced::Parameters,
    /// Scheme sph-swe in its place, and its smoothing length at the start is `h`.
    pub sph_swe: Option<&'a SphSwe>,
    /// Particles in the air.
    pub falling: usize,
    /// The longest step while any are, s.
    pub fall_step: f64,
    pub roughness: &'a Roughness,
    pub sources: &'a [Source],
    pub structures: &'a Structures,
    pub ground: Option<&'a Ground>,
    pub refinement: Option<&'a Refinement>,
    pub seed: u64,
    pub shortest_step: f64,
    /// Volume, m3, smoothing length, m, and distance, m, of new particles.
    pub volume: f64,
    pub h: f64,
    pub spacing: f64,
}

impl Setting<'_> {
    /// Numbers of the run: all but the cells, which change, roughness, and the ground that rain falls on.
    pub(super) fn parameters(
        &self,
        origin: Origin,
        patches: &GroundPatches,
        walls: &Walls,
        works: &Works,
    ) -> Parameters {
        let &Setting { surroundings, scheme, .. } = self;
        let bounds = surroundings.edges.bounds;
        let [west, south] = origin.relative([bounds.x_min, bounds.y_min]);
        let [east, north] = origin.relative([bounds.x_max, bounds.y_max]);
        let mut parameters = Parameters {
            bounds: [west, east, south, north],
            rules: surroundings.edges.rules.each_ref().map(rule),
            key: bytemuck::cast(ChaCha8Rng::seed_from_u64(self.seed).get_seed()),
            walls: walls.grid,
            outlines: walls.outlines_grid,
            obstacles: walls.count as u32,
            ground_corner: origin.relative(patches.corner),
            ground_per_metre: patches.per_metre.map(|value| value as f32),
            ground_patches: patches.size.map(|nodes| nodes as u32 - 1),
            gravity: scheme.gravity as f32,
            eta: scheme.eta as f32,
            largest_h: scheme.largest_h as f32,
            viscosity: scheme.viscosity as f32,
            cfl: scheme.cfl as f32,
            longest_step: scheme.longest_step as f32,
            shortest_step: self.shortest_step as f32,
            new_volume: self.volume as f32,
            new_h: self.h as f32,
            spacing: self.spacing as f32,
            smoothing: 1.0,
            before: 0.5,
            reach_over_h: 2.0,
            in_air: self.falling as u32,
            fall_step: self.fall_step as f32,
            rain: works.rain,
            ..Parameters::default()
        };
        if let Some(refinement) = self.refinement {
            [parameters.widest, parameters.smallest, parameters.largest] =
                refinement.numbers().map(|value| value as f32);
        }
        if let Some(sph_swe) = self.sph_swe {
            tell_of_sph_swe(&mut parameters, sph_swe, self.h);
        }
        parameters
    }
}

fn rule(rule: &EdgeRule) -> u32 {
    match rule {
        EdgeRule::Wall => layout::WALL,
        EdgeRule::Periodic => layout::PERIODIC,
        EdgeRule::Open => layout::OPEN,
        EdgeRule::Stage(_) => layout::STAGE,
    }
}

/// What the shaders of scheme sph-swe must know; `h` is the smoothing length at the start, m.
fn tell_of_sph_swe(parameters: &mut Parameters, sph_swe: &SphSwe, h: f64) {
    let widest = sph_swe.largest_smoothing * h;
    *parameters = Parameters {
        scheme: layout::SPH_SWE,
        before: 0.0,
        reach_over_h: 1.0,
        smoothing: 0.5,
        // A kernel reaches twice that far.
        largest_h: (0.5 * widest) as f32,
        longest_step: sph_swe.time_step_s as f32,
        rest_density: sph_swe.density_kg_per_m3 as f32,
        gas_constant: sph_swe.gas_constant as f32,
        sph_swe_viscosity: sph_swe.viscosity as f32,
        clips_pressure: u32::from(sph_swe.clip_negative_pressure),
        control: u32::from(sph_swe.control_force),
        control_strength: sph_swe.control_strength as f32,
        control_square: sph_swe.control_square as f32,
        first_h: h as f32,
        widest_h: widest as f32,
        ..*parameters
    };
}

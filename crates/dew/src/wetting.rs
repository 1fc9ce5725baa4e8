//! The water on the solids as drops.
//!
//! The air gives water to boundary particles and takes it from them; every few steps the drops take that over: what came
//! condenses into them, what went evaporates from them, they move, and each boundary particle has what then lies on it.

use crate::drops::{DropState, Drops, Patch, Portion, Share, Unseen};
use crate::fogging::{Cover, Fogging, Story, SurfaceFace, open_area};
use crate::solids::{SolidParticle, bodies};
use corpuscle_model::{Column, CompensatedSum, ParticleSet, Surface, Values};
use corpuscle_solids::Solid;
use serde::{Deserialize, Serialize};

/// Steps between two transfers of condensed water to drops: they hardly grow in one, and finding them costs.
const DROP_UPDATE_STEPS: u64 = 10;

/// Extra multiples of [`DROP_UPDATE_STEPS`] for each drop per air particle: drops must not cost more than the air.
const STEPS_PER_DROP_RATIO: usize = 2;

/// Patches of which unseen drops cover less than this part are not shown.
const LEAST_SHOWN: f64 = 1e-4;

/// Drops, and where the boundary particles have their water from.
pub(crate) struct Wetting {
    drops: Drops,
    /// The boundary particle of each patch.
    particles: Vec<u32>,
    /// What each patch had of the drops when they last moved.
    shares: Vec<Share>,
    portions: Vec<Portion>,
    /// When they last moved, s, and in which step.
    since: f64,
    step: u64,
    /// Records so far.
    fogging: Fogging,
    /// Area of each solid on which water can condense, m2.
    open_areas: Vec<f64>,
    /// Parts of surfaces that are measured by themselves, in the order of their solids.
    faces: Vec<SurfaceFace>,
}

/// What of it changes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct WettingState {
    drops: DropState,
    since: f64,
    step: u64,
    fogging: Fogging,
}

impl WettingState {
    /// The drops.
    pub fn drops(&self) -> &DropState {
        &self.drops
    }
}

impl Wetting {
    /// Drops, and the boundary particle of each of their patches.
    pub fn new(drops: Drops, particles: Vec<u32>) -> Self {
        let solids = drops.solids().len();
        let mut wetting = Self {
            fogging: Fogging::new(particles.len(), solids),
            open_areas: (0..solids).map(|solid| open_area(drops.patches(), solid)).collect(),
            faces: Vec::new(),
            drops,
            particles,
            shares: Vec::new(),
            portions: Vec::new(),
            since: 0.0,
            step: 0,
        };
        wetting.share();
        wetting
    }

    fn share(&mut self) {
        self.portions = self.drops.portions();
        self.shares = self.drops.shares_of(&self.portions);
    }

    /// Gravity on drops, m/s2, to be changed.
    pub fn gravity_mut(&mut self) -> &mut [f64; 3] {
        self.drops.gravity_mut()
    }

    pub fn drops(&self) -> &Drops {
        &self.drops
    }

    /// Least number of steps between two transfers.
    #[cfg(feature = "gpu")]
    pub fn steps(&self) -> u64 {
        DROP_UPDATE_STEPS
    }

    /// Steps since they last moved, in a step.
    #[cfg(feature = "gpu")]
    pub fn steps_since(&self, step: u64) -> u64 {
        step - self.step
    }

    /// Notes the step in which drops move.
    pub fn set_step(&mut self, step: u64) {
        self.step = step;
    }

    /// Whether a transfer is due in a step, with `air` particles of air.
    pub fn is_due(&self, step: u64, air: usize) -> bool {
        let many = STEPS_PER_DROP_RATIO * self.drops.drops().len() / air.max(1);
        step - self.step >= DROP_UPDATE_STEPS * (1 + many as u64)
    }

    /// Records of each solid.
    pub fn stories(&self) -> &[Story] {
        &self.fogging.stories
    }

    /// Area of a solid on which water can condense, m2.
    pub fn open_area(&self, solid: usize) -> f64 {
        self.open_areas[solid]
    }

    /// Measures a part of a solid's surface by itself from here on: where it faces along an axis of the solid's own more than along any other. False where
    /// no air is before such a part.
    pub fn measure_face(&mut self, solid: usize, name: &str, axis_and_end: [usize; 2]) -> bool {
        let form = &self.drops.solids()[solid];
        let is_of_it = |patch: &Patch| patch.solid as usize == solid && form.axis_and_end(patch.normal) == axis_and_end;
        let all = self.drops.patches().iter().enumerate().filter(|(_, patch)| is_of_it(patch));
        let patches: Vec<u32> = all.clone().map(|(number, _)| number as u32).collect();
        let area: f64 = all.map(|(_, patch)| patch.area()).sum();
        let is_any = area > 0.0;
        if is_any {
            self.faces.push(SurfaceFace { solid, name: name.into(), patches, area });
            self.fogging.faces.push(Cover::default());
        }
        is_any
    }

    /// Faces of a solid, and the record of each.
    pub fn faces_of(&self, solid: usize) -> impl Iterator<Item = (&SurfaceFace, &Cover)> {
        self.faces.iter().zip(&self.fogging.faces).filter(move |(face, _)| face.solid == solid)
    }

    /// Water per area of a face, kg/m2, and its mean temperature, K, of particles of the solids with these temperatures.
    pub fn water_and_temperature(&self, face: &SurfaceFace, temperatures: &[f64]) -> [f64; 2] {
        let [water, heat] = face.patches.iter().fold([0.0; 2], |[water, heat], &patch| {
            let temperature = temperatures[self.particles[patch as usize] as usize];
            let area = self.drops.patches()[patch as usize].area();
            [water + self.shares[patch as usize].water, heat + area * temperature]
        });
        [water / face.area, heat / face.area]
    }

    /// Transfers what condensed on and evaporated from the boundary particles to the drops, which move up to `time`. Returns the water
    /// that left the solids as drops, kg.
    pub fn transfer_to_drops(&mut self, water_on: &mut [f64], time: f64) -> f64 {
        let patches = || self.particles.iter().zip(&self.shares);
        let gained: Vec<f64> = patches().map(|(&particle, share)| water_on[particle as usize] - share.water).collect();
        self.drops.evaporate(&self.portions, &self.shares, &gained);
        let begun = self.drops.condense(&gained);
        let step = time - self.since;
        self.fogging.see_begun(&self.drops, &begun, time, step);
        let before = self.drops.dripped();
        self.drops.advance(step);
        self.since = time;
        self.share();
        self.fogging.see(&self.drops, &self.shares, &self.faces, &self.open_areas, time, step);
        for (&particle, share) in self.particles.iter().zip(&self.shares) {
            water_on[particle as usize] = share.water;
        }
        self.drops.dripped() - before
    }

    /// Sets each boundary particle's part of the evaporation of a wet surface: the drops' resistance is in series with that of air half a `spacing` thick, m.
    pub fn set_evaporation(&self, spacing: f64, evaporation: &mut [f64]) {
        let of_air = 2.0 / spacing;
        for (patch, (&particle, share)) in self.particles.iter().zip(&self.shares).enumerate() {
            let of_drops = self.drops.evaporation_on(patch, share);
            evaporation[particle as usize] = if of_drops.is_finite() { of_drops / (of_drops + of_air) } else { 1.0 };
        }
    }

    /// Water on the solids, kg: the drops, and what is not transferred to them yet.
    pub fn water(&self, water_on: &[f64]) -> f64 {
        let new = self.particles.iter().zip(&self.shares).map(|(&at, share)| water_on[at as usize] - share.water);
        new.chain([self.drops.water()]).collect::<CompensatedSum>().value()
    }

    pub fn state(&self) -> WettingState {
        WettingState { drops: self.drops.state(), since: self.since, step: self.step, fogging: self.fogging.clone() }
    }

    /// Takes back a state; false where it belongs to other solids.
    pub fn restore(&mut self, state: WettingState) -> bool {
        let fits = state.drops.unseen.len() == self.drops.sites().len()
            && state.fogging.spots.len() == self.particles.len()
            && state.fogging.stories.len() == self.open_areas.len()
            && state.fogging.faces.len() == self.faces.len();
        if !fits {
            return false;
        }
        self.drops.restore(state.drops);
        (self.since, self.step, self.fogging) = (state.since, state.step, state.fogging);
        self.share();
        true
    }

    /// The surface of a solid: where and since when it is wet. `temperatures` are those of the solids' particles, K.
    pub fn surface(&self, solid: usize, name: &str, temperatures: &[f64]) -> Surface {
        let patches = self.drops.patches();
        let of_solid: Vec<usize> = (0..patches.len()).filter(|&patch| patches[patch].solid as usize == solid).collect();
        let column = |name, unit, of: &dyn Fn(usize) -> f64| Column {
            name,
            unit,
            values: Values::Scalar(of_solid.iter().map(|&patch| of(patch)).collect()),
        };
        let area = |patch: usize| patches[patch].area();
        let spot = |patch: usize| self.fogging.spots[patch];
        let unseen = |patch: usize| self.drops.unseen_on(patch, &self.shares[patch]);
        let covered = |patch: usize| self.shares[patch].covered / area(patch) + unseen(patch).covered;
        let or_none = |time: Option<f64>| time.unwrap_or(f64::NAN);
        Surface {
            name: name.into(),
            position: of_solid.iter().map(|&patch| patches[patch].position).collect(),
            normal: of_solid.iter().map(|&patch| patches[patch].normal).collect(),
            half_width: of_solid.iter().map(|&patch| patches[patch].half_width).collect(),
            columns: vec![
                column("water_kg_per_m2", "kg/m2", &|patch| self.shares[patch].water / area(patch)),
                // Where a drop ends within a patch the patch may seem more than covered.
                column("covered_part", "", &|patch| covered(patch).min(1.0)),
                column("unseen_kg_per_m2", "kg/m2", &|patch| self.shares[patch].unseen / area(patch)),
                column("unseen_covered_part", "", &|patch| unseen(patch).covered),
                column("unseen_radius_m", "m", &|patch| unseen(patch).radius),
                column("most_water_kg_per_m2", "kg/m2", &|patch| spot(patch).most_water / area(patch)),
                column("first_drop_at_s", "s", &|patch| or_none(spot(patch).first)),
                column("fogged_at_s", "s", &|patch| or_none(spot(patch).cover.fogged)),
                column("clear_at_s", "s", &|patch| or_none(spot(patch).cover.clear)),
                column("wet_for_s", "s", &|patch| spot(patch).wet_for),
                column("temperature_k", "K", &|patch| temperatures[self.particles[patch] as usize]),
            ],
            shape: bodies::shape(self.drops.solids()[solid].clone()),
        }
    }

    /// All that is shown of it: the drops, and the patches with unseen ones.
    pub fn sets(&self) -> [ParticleSet; 2] {
        [self.set(), self.unseen_set()]
    }

    /// The patches with drops too small to be followed one by one, as particles: middle and half width of each, and their water.
    fn unseen_set(&self) -> ParticleSet {
        let (patches, unseen) = (self.drops.patches(), |patch: usize| self.drops.unseen_on(patch, &self.shares[patch]));
        let wet: Vec<(usize, Unseen)> = (0..patches.len())
            .map(|patch| (patch, unseen(patch)))
            .filter(|(_, unseen)| unseen.covered >= LEAST_SHOWN)
            .collect();
        let column = |name, unit, of: &dyn Fn(&Unseen) -> f64| Column {
            name,
            unit,
            values: Values::Scalar(wet.iter().map(|(_, unseen)| of(unseen)).collect()),
        };
        let normals = wet.iter().map(|&(patch, _)| patches[patch].normal).collect();
        ParticleSet {
            name: "unseen".into(),
            id: wet.iter().map(|&(patch, _)| patch as u64).collect(),
            position: wet.iter().map(|&(patch, _)| patches[patch].position).collect(),
            velocity: vec![[0.0; 3]; wet.len()],
            radius: wet.iter().map(|&(patch, _)| patches[patch].half_width).collect(),
            mass: wet.iter().map(|&(patch, _)| self.shares[patch].unseen).collect(),
            columns: vec![
                column("covered_part", "", &|unseen| unseen.covered),
                column("mean_radius", "m", &|unseen| unseen.radius),
                Column { name: "normal", unit: "", values: Values::Vector(normals) },
            ],
        }
    }

    /// The drops as particles: middle and radius of the disk that each covers.
    fn set(&self) -> ParticleSet {
        let drops = self.drops.drops();
        ParticleSet {
            name: "drops".into(),
            id: drops.iter().map(|drop| drop.id).collect(),
            position: drops.iter().map(|drop| drop.position).collect(),
            velocity: drops.iter().map(|drop| drop.velocity).collect(),
            radius: drops.iter().map(|drop| drop.radius).collect(),
            mass: drops.iter().map(|drop| drop.mass).collect(),
            columns: vec![
                Column {
                    name: "height",
                    unit: "m",
                    values: Values::Scalar(drops.iter().map(|drop| self.drops.height(drop)).collect()),
                },
                Column {
                    name: "solid",
                    unit: "",
                    values: Values::Scalar(drops.iter().map(|drop| f64::from(drop.solid)).collect()),
                },
                Column {
                    name: "normal",
                    unit: "",
                    values: Values::Vector(drops.iter().map(|drop| drop.normal).collect()),
                },
            ],
        }
    }
}

/// Area of a plane for each particle of the layer below it, m2; its normal is in the solid's own axes, along which the particles stand. The samples' own areas ignore where the room cuts a solid.
fn area_in_cell(normal: [f64; 3], spacing: f64) -> f64 {
    spacing * spacing / normal.iter().fold(0.0_f64, |most, along| most.max(along.abs()))
}

/// The surface of a solid at one of its boundary particles, a `spacing` apart, m, with an outward normal.
pub(crate) fn patch_of(particle: &SolidParticle, normal: [f64; 3], solid: &Solid, spacing: f64) -> Patch {
    // The surface is searched from outside: next to a side of the box where the solid goes on, the nearest is the cut.
    let outside = [0, 1, 2].map(|axis| particle.position[axis] + spacing * normal[axis]);
    let nearest = solid.nearest(outside);
    let foot = |axis: usize| outside[axis] - nearest.distance * nearest.normal[axis];
    Patch {
        solid: particle.body,
        position: [0, 1, 2].map(foot),
        normal: nearest.normal,
        half_width: 0.5 * area_in_cell(solid.own_direction(nearest.normal), spacing).sqrt(),
    }
}

//! Ghost samples: random, evenly spread, throughout a solid (Schechter & Bridson, Ghost SPH, 2012).

use super::contact::Contact;
use super::{Body, Searched, Site, Solids, distance_squared};
use crate::air::Scale;
use crate::room::Room;
use crate::settings::WallTreatment;
use corpuscle_model::ModelError;
use corpuscle_sph::kernel::SmoothingKernel;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use std::collections::HashMap;

/// Random positions tried for a sample (their section 4).
const SAMPLE_TRIES: u32 = 30;

/// Least distance of samples over the spacing of the air: denser than the air.
const MIN_SAMPLE_DISTANCE: f64 = 0.5;

/// Times that a better position of every sample is searched.
const IMPROVEMENT_SWEEPS: u32 = 5;

/// Times that the volumes of samples are corrected.
const CORRECTIONS: u32 = 8;

/// Ghost samples of the bodies that keep air out by them, to be in contact with air.
///
/// # Errors
/// Where such a body has no surface.
pub(crate) fn ghost_contact(
    bodies: &[Body],
    walls: &[WallTreatment],
    solids: &Solids,
    room: &Room,
    scale: &Scale,
    seed: u64,
) -> Result<Contact, ModelError> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let (mut positions, mut of_body) = (Vec::new(), Vec::new());
    let ghostly = |number: &usize| walls[*number] == WallTreatment::Ghosts;
    for (number, body) in bodies.iter().enumerate().filter(|(number, _)| ghostly(number)) {
        let Some(surface) = &body.surface else {
            return Err(ModelError::Setup(format!(
                "ghost samples need the surface of solid {number}, which is not known"
            )));
        };
        let inside = |position| surface(position) < 0.0 && room.contains(position);
        let apart = MIN_SAMPLE_DISTANCE * scale.spacing;
        let mut samples = Samples { apart, inside, taken: HashMap::new(), positions: Vec::new() };
        samples.fill(body, scale.spacing, &mut random);
        samples.relax(&mut random);
        positions.append(&mut samples.positions);
        of_body.resize(positions.len(), number);
    }
    let mut sites = Vec::new();
    for (number, &position) in positions.iter().enumerate() {
        let site = Site::itself(number as u32, position);
        sites.push(site);
        room.ghost_particles_beyond(position, &solids.mirrors[of_body[number]], scale.h(), |ghost| {
            sites.push(site.ghost_particle(ghost));
        });
    }
    let particles = solids.sites(room, scale.h(), |particle| ghostly(&(particle.body as usize)));
    let volumes = volumes(&positions, &sites, solids, &particles, scale);
    let volume = |site: &Site| volumes[site.particle as usize];
    // They join the air's density as they are.
    Ok(Contact::new(&sites, volume, |_| WallTreatment::DensityCorrection, scale.h()))
}

/// Volumes of samples with which they fill the room as the solids' own particles do.
fn volumes(positions: &[[f64; 3]], sites: &[Site], solids: &Solids, particles: &[Site], scale: &Scale) -> Vec<f64> {
    let h = scale.h();
    let samples = Searched::new(sites, h);
    let of_bodies = particles.iter().filter(|site| !site.is_ghost_particle);
    let total: f64 = of_bodies.map(|site| solids.particles[site.particle as usize].volume).sum();
    let particles = Searched::new(particles, h);
    let filling = |of: &Searched, position: [f64; 3], volume: &(dyn Fn(&Site) -> f64 + Sync)| {
        of.near(position, h).map(|(site, r_squared)| volume(site) * scale.kernel.value(r_squared)).sum::<f64>()
    };
    let of_particle = |site: &Site| solids.particles[site.particle as usize].volume;
    let wanted: Vec<f64> = positions.par_iter().map(|&position| filling(&particles, position, &of_particle)).collect();
    let mut volumes = vec![total / positions.len() as f64; positions.len()];
    for _ in 0..CORRECTIONS {
        let before = &volumes;
        let of_sample = |site: &Site| before[site.particle as usize];
        let corrected = positions.par_iter().zip(&wanted).zip(before);
        volumes =
            corrected.map(|((&position, wanted), v)| v * wanted / filling(&samples, position, &of_sample)).collect();
    }
    volumes
}

struct Samples<F> {
    apart: f64,
    inside: F,
    /// Samples in each cell of side `apart`.
    taken: HashMap<[i64; 3], Vec<usize>>,
    positions: Vec<[f64; 3]>,
}

impl<F: Fn([f64; 3]) -> bool> Samples<F> {
    fn cell(&self, position: [f64; 3]) -> [i64; 3] {
        position.map(|at| (at / self.apart).floor() as i64)
    }

    /// Throws samples into cells so small that each holds one at most; every cell is tried [`SAMPLE_TRIES`] times.
    fn fill(&mut self, body: &Body, spacing: f64, random: &mut ChaCha8Rng) {
        let side = self.apart / 3.0_f64.sqrt();
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for position in &body.positions {
            for axis in 0..3 {
                low[axis] = low[axis].min(position[axis] - spacing);
                high[axis] = high[axis].max(position[axis] + spacing);
            }
        }
        let counts = [0, 1, 2].map(|axis| ((high[axis] - low[axis]) / side).ceil() as u64);
        for number in 0..counts.iter().product() {
            let cell = [number % counts[0], number / counts[0] % counts[1], number / counts[0] / counts[1]];
            for _ in 0..SAMPLE_TRIES {
                let position = [0, 1, 2].map(|axis| low[axis] + side * (cell[axis] as f64 + random.random::<f64>()));
                if (self.inside)(position) && self.room(position, None) >= self.apart * self.apart {
                    self.taken.entry(self.cell(position)).or_default().push(self.positions.len());
                    self.positions.push(position);
                    break;
                }
            }
        }
    }

    /// Square of the distance to the nearest sample but `except`; more than the square of `apart` where none is near.
    fn room(&self, position: [f64; 3], except: Option<usize>) -> f64 {
        let middle = self.cell(position);
        let mut nearest = 4.0 * self.apart * self.apart;
        for which in 0..27_i64 {
            let cell = [which % 3, which / 3 % 3, which / 9];
            let cell = [0, 1, 2].map(|axis| middle[axis] + cell[axis] - 1);
            for &other in self.taken.get(&cell).into_iter().flatten().filter(|&&other| Some(other) != except) {
                nearest = nearest.min(distance_squared(position, self.positions[other]));
            }
        }
        nearest
    }

    /// Moves each sample to the roomiest of some random positions near it (their algorithm 2).
    fn relax(&mut self, random: &mut ChaCha8Rng) {
        for sweep in 0..IMPROVEMENT_SWEEPS {
            let reach = self.apart / f64::from(1 << sweep);
            for number in 0..self.positions.len() {
                let from = self.positions[number];
                let mut best = (self.room(from, Some(number)), from);
                for _ in 0..SAMPLE_TRIES {
                    let position = from.map(|at| at + reach * (2.0 * random.random::<f64>() - 1.0));
                    let room = self.room(position, Some(number));
                    if room > best.0 && (self.inside)(position) {
                        best = (room, position);
                    }
                }
                let (old, new) = (self.cell(from), self.cell(best.1));
                if let Some(cell) = self.taken.get_mut(&old) {
                    cell.retain(|&other| other != number);
                }
                self.taken.entry(new).or_default().push(number);
                self.positions[number] = best.1;
            }
        }
    }
}

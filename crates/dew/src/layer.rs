//! Distance of the air from a solid, and the energy that keeping it out costs: to compare wall models.

use crate::room::Room;
use crate::solids::contact::Contact;
use crate::solids::{Body, Surface};
use corpuscle_processes::Processes;

/// Width of the sampled layer of air before a surface, in spacings; that behind it is as wide.
const LAYER_WIDTH: f64 = 2.0;

/// Samples per spacing by which the volume of the layer is found.
const SAMPLES_PER_SPACING: f64 = 5.0;

/// The air before the surface of a solid.
pub(crate) struct Layer {
    surface: Surface,
    width: f64,
    low: [f64; 3],
    high: [f64; 3],
    /// Volumes of the layer and of that behind it, m3.
    volumes: [f64; 2],
    /// Sites in the solid: its own particles, and ghosts.
    sites: [Vec<usize>; 2],
}

/// What is found there.
pub(crate) struct Found {
    /// Signed distance of the nearest particle, m; negative where air is inside.
    pub nearest: f64,
    /// Width of the vacuum before the surface if the air began at once beyond it, m.
    pub gap: f64,
    /// Pairs of air and samples of the wall in a step.
    pub pairs: f64,
}

impl Layer {
    /// Of a body whose surface is known, in a room with air particles a `spacing` apart, m. `contacts` are those with the particles of the solids and with
    /// ghost samples.
    pub fn new(body: &Body, room: &Room, spacing: f64, contacts: [&Contact; 2]) -> Option<Self> {
        let surface = body.surface.clone()?;
        let width = LAYER_WIDTH * spacing;
        let along = |axis: usize| body.positions.iter().map(move |position| position[axis]);
        let reach = 2.0 * width + spacing;
        let low = [0, 1, 2].map(|axis| (along(axis).fold(f64::INFINITY, f64::min) - reach).max(room.low[axis]));
        let high = [0, 1, 2].map(|axis| (along(axis).fold(f64::NEG_INFINITY, f64::max) + reach).min(room.high[axis]));
        let mut layer = Self { surface, width, low, high, volumes: [0.0; 2], sites: [Vec::new(), Vec::new()] };
        layer.sites = contacts.map(|contact| {
            let sites = contact.sites.iter().enumerate();
            let inside = sites.filter(|(_, site)| layer.is_near(site.position) && (layer.surface)(site.position) < 0.0);
            inside.map(|(number, _)| number).collect()
        });
        let counts = [0, 1, 2].map(|axis| ((high[axis] - low[axis]) * SAMPLES_PER_SPACING / spacing).ceil().max(1.0));
        let apart = [0, 1, 2].map(|axis| (high[axis] - low[axis]) / counts[axis]);
        let positions = (0..counts.iter().product::<f64>() as u64).map(|number| {
            let [x, y] = [counts[0] as u64, counts[1] as u64];
            let index = [number % x, number / x % y, number / (x * y)];
            [0, 1, 2].map(|axis| low[axis] + (index[axis] as f64 + 0.5) * apart[axis])
        });
        let volume: f64 = apart.iter().product();
        layer.volumes = layer.count(positions).1.map(|count| volume * f64::from(count));
        Some(layer)
    }

    /// Signed distance of the nearest position, and how many are in the layer and in that behind it.
    fn count(&self, positions: impl Iterator<Item = [f64; 3]>) -> (f64, [u32; 2]) {
        let (mut nearest, mut counts) = (f64::INFINITY, [0; 2]);
        for position in positions {
            let distance = (self.surface)(position);
            nearest = nearest.min(distance);
            match distance / self.width {
                part if !(0.0..2.0).contains(&part) => {}
                part => counts[usize::from(part >= 1.0)] += 1,
            }
        }
        (nearest, counts)
    }

    fn is_near(&self, position: [f64; 3]) -> bool {
        (0..3).all(|axis| (self.low[axis]..self.high[axis]).contains(&position[axis]))
    }

    /// What is found in the air as it stands, at these positions. Of the sites of both `contacts` this process counts those that it owns.
    pub fn find(
        &self,
        air: impl Iterator<Item = [f64; 3]>,
        contacts: [&Contact; 2],
        owns: impl Fn([f64; 3]) -> bool,
        processes: &Processes,
    ) -> Found {
        let positions = air.filter(|&position| self.is_near(position));
        let (nearest, own) = self.count(positions);
        let pairs_of = |(sites, contact): (&Vec<usize>, &Contact)| {
            let own = sites.iter().filter(|&&site| owns(contact.sites[site].position));
            own.map(|&site| contact.of_site(site).len()).sum::<usize>()
        };
        let pairs: usize = self.sites.iter().zip(contacts).map(pairs_of).sum();
        let mut counts = [i64::from(own[0]), i64::from(own[1]), pairs as i64];
        processes.total(&mut counts, &mut []);
        let nearest = processes.least(nearest);
        let [before, behind] = [0, 1].map(|layer| counts[layer] as f64 / self.volumes[layer]);
        Found { nearest, gap: self.width * (1.0 - before / behind), pairs: counts[2] as f64 }
    }
}

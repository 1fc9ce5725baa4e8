//! What a gas adds to a scene.

use super::{Gas, Motion, Region, Wall};
use crate::check::{Check, Checked};
use crate::{ModelScene, Run, Series};
use std::path::PathBuf;

/// The colour of a kind of balls that the scene gives none, by its number.
pub fn colour_of_kind(number: usize) -> &'static str {
    COLOURS[number % COLOURS.len()]
}

/// Colours that go well together and that colour-blind eyes distinguish too (Okabe & Ito 2008).
const COLOURS: [&str; 8] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7a5195", "#4d4d4d"];

impl ModelScene for Gas {
    const NAME: &'static str = "gas";

    fn check(&self, check: &Check) -> Checked {
        check.gas(self)
    }

    fn resolve_defaults(&mut self, run: &Run) {
        self.fill_in(run);
    }

    fn paths(&mut self) -> Vec<&mut PathBuf> {
        let walls = &mut self.walls;
        let always = [&mut walls.x_min, &mut walls.x_max, &mut walls.y_min, &mut walls.y_max];
        let all = always.into_iter().chain(walls.z_min.as_mut()).chain(walls.z_max.as_mut());
        let of_walls = all.filter_map(|wall| match wall {
            Wall::Motion(Motion::Displacement(Series::File { csv, .. })) => Some(csv),
            _ => None,
        });
        of_walls.chain(self.start_file.as_mut()).collect()
    }
}

impl Gas {
    fn fill_in(&mut self, run: &Run) {
        let dimensions = self.dimensions();
        self.gravity.get_or_insert_with(|| vec![0.0; dimensions]);
        let contact_time = self.default_contact_time();
        self.contact_time_s.get_or_insert(contact_time);
        if dimensions == 3 {
            self.walls.z_min.get_or_insert(Wall::Fixed);
            self.walls.z_max.get_or_insert(Wall::Fixed);
        }
        self.measure.from_s.get_or_insert(0.1 * run.until_s);
        let pair_distance = self.default_pair_distance();
        self.measure.pair_distance.get_or_insert(pair_distance);
        for ball in &mut self.ball {
            ball.velocity.get_or_insert_with(|| vec![0.0; dimensions]);
        }
        for species in &mut self.species {
            species.velocity.get_or_insert_with(|| vec![0.0; dimensions]);
            let whole = || Region { from: vec![0.0; dimensions], to: self.size.clone() };
            species.region.get_or_insert_with(whole);
        }
        self.resolve_colours();
    }

    fn default_contact_time(&self) -> f64 {
        if self.restitution == 1.0 {
            return 0.0;
        }
        let boltzmann = self.units.boltzmann();
        // Root mean square speed along one direction.
        let flight = |radius: f64, temperature: f64, mass: f64| radius / (boltzmann * temperature / mass).sqrt();
        let flights = self.species.iter().map(|s| flight(s.radius, s.temperature, s.mass));
        let shortest = flights.fold(f64::INFINITY, f64::min);
        if shortest.is_finite() { 1e-4 * shortest } else { 0.0 }
    }

    fn default_pair_distance(&self) -> f64 {
        let radii = self.species.iter().map(|species| species.radius).chain(self.ball.iter().map(|ball| ball.radius));
        let largest = radii.fold(0.0, f64::max);
        let shortest = self.size.iter().copied().fold(f64::INFINITY, f64::min);
        (10.0 * largest).min(0.5 * shortest)
    }

    /// Each species, and each name of balls that is none, takes the next colour.
    fn resolve_colours(&mut self) {
        let mut named: Vec<(String, String)> = Vec::new();
        let balls = self.ball.iter_mut().map(|ball| (&ball.name, &mut ball.colour));
        let species = self.species.iter_mut().map(|species| (&species.name, &mut species.colour));
        for (name, colour) in species.chain(balls) {
            let known = named.iter().find(|(known, _)| known == name).map(|(_, colour)| colour.clone());
            let default = known.unwrap_or_else(|| colour_of_kind(named.len()).to_owned());
            let colour = colour.get_or_insert(default);
            if named.iter().all(|(known, _)| known != name) {
                named.push((name.clone(), colour.clone()));
            }
        }
    }
}

//! Where balls are at the start: never overlapping.

use super::lattice::lattice;
use super::random::{self, Placed};
use super::{Amount, Setup, Side, Species, Start, ball_volume};
use crate::SetupError;
use rand_chacha::ChaCha8Rng;

/// Close packing: the densest that exists, and its reference.
const CLOSEST: [(f64, &str, &str); 2] = [
    (0.906_899_682_117_089_3, "disks", "pi / sqrt(12), Thue 1910"),
    (0.740_480_489_693_061_1, "balls", "pi / sqrt(18), Hales 2005"),
];

/// Where random arrangements of equal disks and balls jam, about.
pub(super) const JAMMED: [f64; 2] = [0.85, 0.64];

/// Largest part of a plane or of space that equal disks or balls can fill.
pub(super) fn closest<const D: usize>() -> f64 {
    CLOSEST[D - 2].0
}

impl<const D: usize> Setup<D> {
    /// Number of balls of a species.
    pub(crate) fn count_of(&self, species: &Species<D>) -> usize {
        match species.amount {
            Amount::Count(count) => count,
            Amount::Packing(packing) => {
                let [from, to] = self.region_of(species);
                let space: f64 = (0..D).map(|axis| to[axis] - from[axis]).product();
                (packing * space / ball_volume::<D>(species.radius)).round() as usize
            }
        }
    }

    pub(super) fn region_of(&self, species: &Species<D>) -> [[f64; D]; 2] {
        species.region.unwrap_or([[0.0; D], self.size])
    }

    /// True along axes where a region goes on beyond its end at its beginning.
    pub(super) fn repeats(&self, region: &[[f64; D]; 2]) -> [bool; D] {
        std::array::from_fn(|axis| {
            self.sides[axis][0] == Side::Periodic
                && region[1][axis] - region[0][axis] >= self.size[axis] * (1.0 - 1e-12)
        })
    }

    /// Positions of all balls: those given one by one, then each species'.
    pub(crate) fn placed(&self, random: &mut ChaCha8Rng) -> Result<Vec<Placed<D>>, SetupError> {
        let mut all: Vec<Placed<D>> =
            self.balls.iter().map(|ball| Placed { position: ball.position, radius: ball.radius }).collect();
        let mut of_species: Vec<Vec<Placed<D>>> = vec![Vec::new(); self.species.len()];
        for (number, species) in self.species.iter().enumerate() {
            self.check_packing(species)?;
            if species.start == Start::Lattice {
                of_species[number] = self.on_lattice(species)?;
                all.extend(&of_species[number]);
            }
        }
        for group in self.random_groups() {
            let placed = random::place(self, &group, &all, random)?;
            for (number, balls) in group.into_iter().zip(placed) {
                all.extend(&balls);
                of_species[number] = balls;
            }
        }
        all.truncate(self.balls.len());
        all.extend(of_species.into_iter().flatten());
        Ok(all)
    }

    /// Species to be placed at random, those of one region together.
    fn random_groups(&self) -> Vec<Vec<usize>> {
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for (number, species) in self.species.iter().enumerate().filter(|(_, species)| species.start == Start::Random) {
            let region = self.region_of(species);
            match groups.iter_mut().find(|group| self.region_of(&self.species[group[0]]) == region) {
                Some(group) => group.push(number),
                None => groups.push(vec![number]),
            }
        }
        groups
    }

    /// Part of its region that a species fills.
    pub(super) fn packing_of(&self, species: &Species<D>) -> f64 {
        let [from, to] = self.region_of(species);
        let space: f64 = (0..D).map(|axis| to[axis] - from[axis]).product();
        self.count_of(species) as f64 * ball_volume::<D>(species.radius) / space
    }

    fn check_packing(&self, species: &Species<D>) -> Result<(), SetupError> {
        if self.packing_of(species) > closest::<D>() {
            return Err(self.too_dense(species, closest::<D>()));
        }
        Ok(())
    }

    fn too_dense(&self, species: &Species<D>, fits: f64) -> SetupError {
        let (limit, shape, shown_by) = CLOSEST[D - 2];
        let (what, count) = (format!("species {:?}", species.name), self.count_of(species));
        SetupError::TooDense { what, packing: self.packing_of(species), shape, limit, shown_by, count, fits }
    }

    fn on_lattice(&self, species: &Species<D>) -> Result<Vec<Placed<D>>, SetupError> {
        let region = self.region_of(species);
        let repeats = self.repeats(&region);
        let radius = species.radius;
        let margin: [f64; D] = std::array::from_fn(|axis| if repeats[axis] { 0.0 } else { radius });
        let length = std::array::from_fn(|axis| region[1][axis] - region[0][axis] - 2.0 * margin[axis]);
        let count = self.count_of(species);
        let (points, apart) = lattice(count, length, repeats);
        // Along its way the lattice is counted in steps, whose rounding errors add up.
        if count > 1 && apart < 2.0 * radius * (1.0 - 1e-12) {
            let fits = self.packing_of(species) * (apart / (2.0 * radius)).powi(D as i32);
            return Err(self.too_dense(species, fits));
        }
        // Half a step in from periodic sides, so that no ball lies on them.
        let place = |point: [f64; D]| Placed {
            position: std::array::from_fn(|axis| {
                let inward = if repeats[axis] { 0.25 * apart.min(length[axis]) } else { 0.0 };
                region[0][axis] + margin[axis] + inward + point[axis]
            }),
            radius,
        };
        Ok(points.into_iter().map(place).map(|placed| self.inside(placed)).collect())
    }

    /// The same position in the box itself.
    pub(super) fn inside(&self, mut placed: Placed<D>) -> Placed<D> {
        for axis in (0..D).filter(|&axis| self.sides[axis][0] == Side::Periodic) {
            placed.position[axis] = placed.position[axis].rem_euclid(self.size[axis]);
        }
        placed
    }
}

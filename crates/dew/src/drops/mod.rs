//! Drops on solids: how they grow, merge, stay, slide and leave.
//!
//! A drop is a cap of a sphere on the surface of a solid. Water that condenses at a [`Site`] joins the drop that covers a place
//! of it at random; where none does, it gathers as a film until it makes a drop of the smallest size. Drops that touch become one,
//! of their mass and momentum. Friction holds a drop up to the force friction x pressure x covered area (patent CN106650064B);
//! beyond that it slides and sweeps up what it rolls over. One thread does all of it, in a fixed order.

mod cap;
mod grid;
mod map;
mod merge;
mod motion;

pub use cap::Cap;
pub use map::{Portion, Share};

use corpuscle_model::ExactSum;
use corpuscle_solids::Solid;
use grid::Grid;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// What holds for all drops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DropLaws {
    /// Angle between drop and solid, measured inside the drop, between 0 and pi.
    pub contact_angle: f64,
    /// Friction over the force with which the air presses the drop on the solid (mu_f).
    pub friction: f64,
    /// Pressure of the air, Pa.
    pub pressure: f64,
    /// Surface tension, N/m.
    pub surface_tension: f64,
    /// Acceleration of gravity, m/s2.
    pub gravity: [f64; 3],
    /// Radius of solid that the smallest drop covers, m.
    pub smallest_radius: f64,
    /// Density of water, kg/m3.
    pub density: f64,
}

/// How often a place of a site is looked for, how far, in its half widths, so that the sites together leave nothing out, and how far
/// from the surface it can be, where that is curved.
const TRIES: u32 = 30;
const WIDER: f64 = 1.7;
const FARTHEST_OFF: f64 = 0.35;

/// Density of water at 20 °C, kg/m3 (IAPWS-95 at 1 atm).
pub const WATER_DENSITY: f64 = 998.2;

/// A patch of a solid's surface on which water condenses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Site {
    /// Which solid.
    pub solid: u32,
    /// Middle of the patch, on the surface, m.
    pub position: [f64; 3],
    /// The way out of the solid.
    pub normal: [f64; 3],
    /// Half the side of the patch, m.
    pub half_width: f64,
}

impl Site {
    /// How far its corners are, m.
    fn reach(&self) -> f64 {
        self.half_width * 2_f64.sqrt()
    }
}

/// A drop.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Drop {
    /// Its number; what merges keeps that of the largest.
    pub id: u64,
    /// The solid that it is on.
    pub solid: u32,
    /// Middle of the covered disk, on the surface, m.
    pub position: [f64; 3],
    /// The way out of the solid there.
    pub normal: [f64; 3],
    /// Velocity, m/s, along the surface.
    pub velocity: [f64; 3],
    /// Mass, kg.
    pub mass: f64,
}

/// What of the drops changes: saved and restored as it is.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct DropState {
    /// The drops.
    pub drops: Vec<Drop>,
    /// Mass of the film at each site, kg.
    pub film: Vec<f64>,
    /// Mass that left the solids as drops, kg.
    pub dripped: ExactSum,
    /// Number of drops that left.
    pub dripped_count: u64,
    /// Number of drops that became part of others.
    pub merged: u64,
    /// Drops that there ever were.
    next_id: u64,
    /// Random numbers used.
    drawn: u64,
}

/// Drops on the solids of a scene.
#[derive(Debug, Clone)]
pub struct Drops {
    laws: DropLaws,
    cap: Cap,
    solids: Arc<[Solid]>,
    sites: Vec<Site>,
    /// The sites by place.
    site_grid: Grid,
    /// Smallest and largest coordinates that a drop can have; beyond it has left.
    room: [[f64; 3]; 2],
    random: ChaCha8Rng,
    state: DropState,
    grid: Grid,
    /// Reach of each drop when the grid was made, m.
    reach: Vec<f64>,
}

impl Drops {
    /// No drops yet. `room` is the box of the scene, from its smallest to its largest coordinates.
    pub fn new(laws: DropLaws, solids: Arc<[Solid]>, sites: Vec<Site>, room: [[f64; 3]; 2], seed: u64) -> Self {
        let state = DropState { film: vec![0.0; sites.len()], ..DropState::default() };
        let (cap, random) = (Cap::new(laws.contact_angle), ChaCha8Rng::seed_from_u64(seed));
        let reach: Vec<f64> = sites.iter().map(Site::reach).collect();
        let site_grid = Grid::new(sites.iter().map(|site| site.position), &reach);
        Self { laws, cap, solids, sites, site_grid, room, random, state, grid: Grid::default(), reach: Vec::new() }
    }

    /// The drops.
    pub fn drops(&self) -> &[Drop] {
        &self.state.drops
    }

    /// The solids that they are on.
    pub fn solids(&self) -> &[Solid] {
        &self.solids
    }

    /// The patches on which water condenses.
    pub fn sites(&self) -> &[Site] {
        &self.sites
    }

    /// Water of each patch that is in no drop yet, kg: a film of drops too small to be told apart.
    pub fn films(&self) -> &[f64] {
        &self.state.film
    }

    /// Adds a drop of this mass (kg) on a solid, with its middle at the point of the surface nearest to `position`.
    pub fn add(&mut self, solid: u32, position: [f64; 3], velocity: [f64; 3], mass: f64) {
        let (position, normal) = self.foot(solid, position);
        let id = self.state.next_id;
        self.state.next_id += 1;
        self.state.drops.push(Drop { id, solid, position, normal, velocity, mass });
    }

    /// The point of a solid's surface nearest to a place, and the way out there.
    fn foot(&self, solid: u32, place: [f64; 3]) -> ([f64; 3], [f64; 3]) {
        let nearest = self.solids[solid as usize].nearest(place);
        let foot = std::array::from_fn(|axis| place[axis] - nearest.distance * nearest.normal[axis]);
        (foot, nearest.normal)
    }

    /// Acceleration of gravity, m/s2, to be changed.
    pub fn gravity_mut(&mut self) -> &mut [f64; 3] {
        &mut self.laws.gravity
    }

    /// What holds for them.
    pub fn laws(&self) -> &DropLaws {
        &self.laws
    }

    /// Shape of a drop.
    pub fn cap(&self) -> Cap {
        self.cap
    }

    /// Radius of solid that a drop covers, m.
    pub fn covered_radius(&self, drop: &Drop) -> f64 {
        self.cap.covered_radius(drop.mass / self.laws.density)
    }

    /// Area that drops cover, m2.
    pub fn covered_area(&self) -> f64 {
        self.state.drops.iter().map(|drop| std::f64::consts::PI * self.covered_radius(drop).powi(2)).sum()
    }

    /// Water on the solids now, drops and films, kg.
    pub fn water(&self) -> f64 {
        let drops = self.state.drops.iter().map(|drop| drop.mass);
        drops.chain(self.state.film.iter().copied()).collect::<ExactSum>().value()
    }

    /// Water that left the solids as drops, kg.
    pub fn dripped(&self) -> f64 {
        self.state.dripped.value()
    }

    /// Number of drops that became part of others.
    pub fn merged(&self) -> u64 {
        self.state.merged
    }

    /// What changes, between two calls of [`Drops::advance`] and before anything condenses or evaporates.
    pub fn state(&self) -> DropState {
        DropState { drawn: self.random.get_word_pos() as u64, ..self.state.clone() }
    }

    /// Takes back what [`Drops::state`] gave.
    pub fn restore(&mut self, state: DropState) {
        self.random.set_word_pos(u128::from(state.drawn));
        self.state = state;
        self.file();
    }

    /// Water (kg) condenses at a site: it joins the drop that covers a place of it, or gathers as a film there.
    pub fn condense(&mut self, site: usize, mass: f64) {
        let place = self.place_in(site);
        if let Some(drop) = self.drop_over(site, place) {
            self.state.drops[drop].mass += mass + std::mem::take(&mut self.state.film[site]);
            return;
        }
        self.state.film[site] += mass;
        if self.state.film[site] >= self.smallest_mass() {
            let mass = std::mem::take(&mut self.state.film[site]);
            // From outside: within an edge another face may be nearer.
            let Site { solid, normal, half_width, .. } = self.sites[site];
            self.add(solid, std::array::from_fn(|axis| place[axis] + half_width * normal[axis]), [0.0; 3], mass);
        }
    }

    /// Water evaporates at a site, from the drop that covers a place of it or from the film there. Gives how much there was to
    /// take of `mass`, kg. A drop that is used up is gone after [`Drops::advance`].
    pub fn evaporate(&mut self, site: usize, mass: f64) -> f64 {
        let place = self.place_in(site);
        let from = match self.drop_over(site, place) {
            Some(drop) => &mut self.state.drops[drop].mass,
            None => &mut self.state.film[site],
        };
        let taken = mass.min(*from);
        *from -= taken;
        taken
    }

    fn smallest_mass(&self) -> f64 {
        self.laws.density * self.cap.volume(self.laws.smallest_radius)
    }

    /// Any place of a site: nearer to it than to others, on the surface, and in the room.
    fn place_in(&mut self, site: usize) -> [f64; 3] {
        let Site { solid, position, normal, half_width } = self.sites[site];
        let [one, other] = across(normal);
        for _ in 0..TRIES {
            let steps = [(); 2].map(|()| WIDER * half_width * self.random.random_range(-1.0..1.0));
            let place = std::array::from_fn(|axis| position[axis] + steps[0] * one[axis] + steps[1] * other[axis]);
            let is_near_surface =
                || self.solids[solid as usize].signed_distance(place).abs() < FARTHEST_OFF * half_width;
            if self.is_in_room(place) && self.is_nearest(site, place) && is_near_surface() {
                return place;
            }
        }
        position
    }

    fn is_in_room(&self, place: [f64; 3]) -> bool {
        (0..3).all(|axis| (self.room[0][axis]..=self.room[1][axis]).contains(&place[axis]))
    }

    /// Whether no other site that faces alike is nearer to a place: where patches overlap, no more begins than elsewhere.
    fn is_nearest(&self, site: usize, place: [f64; 3]) -> bool {
        let Site { solid, normal, position, .. } = self.sites[site];
        let away = distance2(position, place);
        let mut nearest = true;
        self.site_grid.near(place, 0.0, 0.0, |at| {
            let other = &self.sites[at];
            nearest &=
                other.solid != solid || dot(other.normal, normal) < 0.5 || distance2(other.position, place) >= away;
        });
        nearest
    }

    /// The largest of the drops that cover a place of a site.
    fn drop_over(&self, site: usize, place: [f64; 3]) -> Option<usize> {
        let Site { solid, normal, .. } = self.sites[site];
        let mut largest: Option<usize> = None;
        self.grid.near(place, 0.0, 0.0, |at| {
            let (drop, reach) = (&self.state.drops[at], self.reach[at]);
            // What is cheap to find out first.
            let covers = distance2(drop.position, place) < reach * reach
                && drop.solid == solid
                && drop.mass > 0.0
                && dot(drop.normal, normal) > 0.0
                && distance2(drop.position, place) < self.covered_radius(drop).powi(2);
            if covers && largest.is_none_or(|known| self.reach[at] > self.reach[known]) {
                largest = Some(at);
            }
        });
        largest
    }

    /// Moves the drops on by a time, s: those that touch merge, those that are too heavy slide, sweep up what they meet, and
    /// leave at edges, from overhangs and out of the room.
    pub fn advance(&mut self, time: f64) {
        self.state.drops.retain(|drop| drop.mass > 0.0);
        self.merge();
        self.slide(time);
    }

    /// Files the drops by place and reach.
    fn file(&mut self) {
        let reach = |drop: &Drop| self.cap.reach(drop.mass / self.laws.density);
        self.reach = self.state.drops.iter().map(reach).collect();
        self.grid = Grid::new(self.state.drops.iter().map(|drop| drop.position), &self.reach);
    }
}

/// Two directions across a direction and each other (Duff et al., Journal of Computer Graphics Techniques 6, 2017, 1).
fn across([x, y, z]: [f64; 3]) -> [[f64; 3]; 2] {
    let sign = 1_f64.copysign(z);
    let (a, b) = (-1.0 / (sign + z), -x * y / (sign + z));
    [[1.0 + sign * x * x * a, sign * b, -sign * x], [b, sign + y * y * a, -y]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn distance2(a: [f64; 3], b: [f64; 3]) -> f64 {
    let away: [f64; 3] = std::array::from_fn(|axis| a[axis] - b[axis]);
    dot(away, away)
}

/// A vector without its part along a direction.
fn without(vector: [f64; 3], direction: [f64; 3]) -> [f64; 3] {
    let along = dot(vector, direction);
    std::array::from_fn(|axis| vector[axis] - along * direction[axis])
}

//! Drops on solids: how they grow, merge, stay, slide and leave.
//!
//! A drop is a cap of a sphere on the surface of a solid. Water that condenses on a [`Patch`] goes to the nucleation [`Site`]s whose areas
//! are there: to the drop that covers a site, or else to a drop at the site that is resolved once it is of the smallest size. Drops that touch
//! become one, of their mass and momentum. A drop is held up to a bound, by the hysteresis of its contact angle or by friction; beyond that it slides,
//! braked by viscosity, and sweeps up what it rolls over. One thread does all of it, in a fixed order.

mod cap;
mod contact_line;
mod film;
mod grid;
mod map;
mod merge;
mod motion;
mod sites;
mod unseen;

pub use cap::Cap;
pub use contact_line::Retention;
pub use map::{Portion, Share};
pub use sites::{MOST_SITES, Site, most_per_area};
pub use unseen::Unseen;

use cap::{angle, height, reach};
use contact_line::ContactLine;
use corpuscle_model::CompensatedSum;
use corpuscle_solids::Solid;
use film::Films;
use grid::Grid;
use serde::{Deserialize, Serialize};
use sites::Sites;
use std::sync::Arc;

/// What holds for all drops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DropLaws {
    /// Angle between drop and solid, measured inside the drop, between 0 and pi.
    pub contact_angle: f64,
    /// What holds a drop on an inclined solid.
    pub retention: Retention,
    /// Viscosity of water, Pa s, by which a sliding drop is braked.
    pub viscosity: f64,
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
    /// Water comes and goes so many times faster than in reality; films flow as much faster.
    pub time_factor: f64,
}

/// How water lies on a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SurfaceWater {
    /// As drops.
    Drops {
        /// Density of nucleation sites, 1/m2.
        sites_per_area: f64,
    },
    /// As a film, on a surface that water wets.
    Film,
}

impl SurfaceWater {
    /// Whether it is a film.
    pub fn is_film(self) -> bool {
        self == Self::Film
    }

    /// Density of nucleation sites, 1/m2; a film needs none.
    pub fn sites_per_area(self) -> f64 {
        match self {
            Self::Drops { sites_per_area } => sites_per_area,
            Self::Film => 0.0,
        }
    }
}

/// Density of water at 20 °C, kg/m3 (IAPWS-95 at 1 atm).
pub const WATER_DENSITY: f64 = 998.2;

/// A patch of a solid's surface on which water condenses, that of a boundary particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patch {
    /// Which solid.
    pub solid: u32,
    /// Middle of the patch, on the surface, m.
    pub position: [f64; 3],
    /// Outward normal of the solid.
    pub normal: [f64; 3],
    /// Half the side of the patch, m.
    pub half_width: f64,
}

impl Patch {
    /// Its area, m2.
    pub fn area(&self) -> f64 {
        (2.0 * self.half_width).powi(2)
    }

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
    /// Outward normal of the solid there.
    pub normal: [f64; 3],
    /// Velocity, m/s, along the surface.
    pub velocity: [f64; 3],
    /// Mass, kg.
    pub mass: f64,
    /// Radius of the disk that it covers, m.
    pub radius: f64,
}

/// What of the drops changes: saved and restored as it is.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct DropState {
    /// The drops.
    pub drops: Vec<Drop>,
    /// Mass of the drop at each site that is not resolved yet, or of the film there, kg.
    pub unseen: Vec<f64>,
    /// Mass that left the solids as drops, kg.
    pub dripped: CompensatedSum,
    /// Number of drops that left.
    pub dripped_count: u64,
    /// Number of drops that became part of others.
    pub merged: u64,
    /// Drops that there ever were.
    next_id: u64,
}

/// A drop that became resolved when water condensed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Begun {
    /// Its site.
    pub site: u32,
    /// When, as a part of the time in which the water came.
    pub after: f64,
}

/// Covered by no drop.
const NONE: u32 = u32::MAX;

/// Drops on the solids of a scene.
#[derive(Debug, Clone)]
pub struct Drops {
    laws: DropLaws,
    cap: Cap,
    line: ContactLine,
    solids: Arc<[Solid]>,
    /// How water lies on each solid.
    water: Vec<SurfaceWater>,
    films: Films,
    patches: Vec<Patch>,
    /// The patches by position.
    patch_grid: Grid,
    sites: Sites,
    /// The drop that covers each site, or [`NONE`].
    cover: Vec<u32>,
    /// Water that each site gains, kg; kept from call to call.
    gains: Vec<f64>,
    /// Smallest and largest coordinates that a drop can have; beyond it has left.
    room: [[f64; 3]; 2],
    state: DropState,
    grid: Grid,
    /// Reach of each drop when the grid was made, m.
    reach: Vec<f64>,
}

/// What drops are made for.
#[derive(Debug, Clone)]
pub struct Surfaces {
    /// The solids.
    pub solids: Arc<[Solid]>,
    /// How water lies on each of them.
    pub water: Vec<SurfaceWater>,
    /// The patches on which water condenses.
    pub patches: Vec<Patch>,
    /// Smallest and largest coordinates of the scene, m.
    pub room: [[f64; 3]; 2],
}

impl Drops {
    /// No drops yet. `seed` is that of the positions of nucleation sites.
    pub fn new(laws: DropLaws, surfaces: Surfaces, seed: u64) -> Self {
        let Surfaces { solids, water, patches, room } = surfaces;
        let cap = Cap::new(laws.contact_angle);
        let widths: Vec<f64> = patches.iter().map(Patch::reach).collect();
        let patch_grid = Grid::new(patches.iter().map(|patch| patch.position), &widths);
        let sites = Sites::scatter(&solids, &patches, &water, smallest_reach(&laws), room, seed);
        let count = sites.all.len();
        Self {
            laws,
            line: ContactLine::new(laws.retention, laws.contact_angle),
            cap,
            solids,
            films: Films::new(&patches, &water, &sites),
            water,
            patches,
            patch_grid,
            cover: vec![NONE; count],
            gains: vec![0.0; count],
            state: DropState { unseen: vec![0.0; count], ..DropState::default() },
            sites,
            room,
            grid: Grid::default(),
            reach: Vec::new(),
        }
    }

    /// The drops.
    pub fn drops(&self) -> &[Drop] {
        &self.state.drops
    }

    /// Mass of the drop at each site that is not resolved yet, or of the film there, kg.
    pub fn unseen_masses(&self) -> &[f64] {
        &self.state.unseen
    }

    /// The solids that they are on.
    pub fn solids(&self) -> &[Solid] {
        &self.solids
    }

    /// The patches on which water condenses.
    pub fn patches(&self) -> &[Patch] {
        &self.patches
    }

    /// The nucleation sites.
    pub fn sites(&self) -> &[Site] {
        &self.sites.all
    }

    /// Adds a drop of this mass (kg) on a solid, with its middle at the point of the surface nearest to `position`.
    pub fn add(&mut self, solid: u32, position: [f64; 3], velocity: [f64; 3], mass: f64) {
        let (position, normal) = self.foot(solid, position);
        let id = self.state.next_id;
        self.state.next_id += 1;
        let radius = self.cap.covered_radius(mass / self.laws.density);
        self.state.drops.push(Drop { id, solid, position, normal, velocity, mass, radius });
    }

    /// The point of a solid's surface nearest to a position, and the outward normal there.
    fn foot(&self, solid: u32, position: [f64; 3]) -> ([f64; 3], [f64; 3]) {
        let nearest = self.solids[solid as usize].nearest(position);
        let foot = std::array::from_fn(|axis| position[axis] - nearest.distance * nearest.normal[axis]);
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

    /// Height of a drop above the solid, m.
    pub fn height(&self, drop: &Drop) -> f64 {
        height(drop.radius, drop.mass / self.laws.density)
    }

    /// Contact angle of a drop.
    fn angle(&self, drop: &Drop) -> f64 {
        angle(drop.radius, drop.mass / self.laws.density)
    }

    /// Lets the contact lines follow what came and went: each stays until its angle leaves the range of hysteresis.
    fn fit(&mut self) {
        for drop in &mut self.state.drops {
            drop.radius = self.line.radius(drop.radius, drop.mass / self.laws.density);
        }
    }

    /// Area that drops cover, m2.
    pub fn covered_area(&self) -> f64 {
        self.state.drops.iter().map(|drop| std::f64::consts::PI * drop.radius.powi(2)).sum()
    }

    /// Water on the solids now, in drops that are resolved or not, kg.
    pub fn water(&self) -> f64 {
        let drops = self.state.drops.iter().map(|drop| drop.mass);
        drops.chain(self.state.unseen.iter().copied()).collect::<CompensatedSum>().value()
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
        self.state.clone()
    }

    /// Takes back what [`Drops::state`] gave.
    pub fn restore(&mut self, state: DropState) {
        self.state = state;
        self.file();
        self.find_covered();
    }

    /// Water condenses where `gained` (kg, one for each patch) is above 0: each site gathers that of its area, for the drop that covers it or
    /// for one of its own. Returns the drops that are resolved from now on.
    pub fn condense(&mut self, gained: &[f64]) -> Vec<Begun> {
        self.gains.fill(0.0);
        for piece in &self.sites.pieces {
            self.gains[piece.site as usize] += piece.of_patch * gained[piece.patch as usize].max(0.0);
        }
        let smallest = smallest_mass(&self.laws);
        let mut begun = Vec::new();
        for site in 0..self.gains.len() {
            let (gain, before) = (self.gains[site], self.state.unseen[site]);
            let mass = before + gain;
            let covering = self.state.drops.get_mut(self.cover[site] as usize).filter(|drop| drop.mass > 0.0);
            if let Some(drop) = covering {
                drop.mass += mass;
                self.state.unseen[site] = 0.0;
            } else if mass >= smallest && !self.has_film(self.sites.all[site].solid) {
                let Site { solid, position, .. } = self.sites.all[site];
                self.state.unseen[site] = 0.0;
                self.cover[site] = self.state.drops.len() as u32;
                self.add(solid, position, [0.0; 3], mass);
                let after = if gain > 0.0 { ((smallest - before) / gain).clamp(0.0, 1.0) } else { 1.0 };
                begun.push(Begun { site: site as u32, after });
            } else {
                self.state.unseen[site] = mass;
            }
        }
        begun
    }

    /// Moves the drops on by a time, s: those that touch merge, those that are too heavy slide, sweep up what they meet, and
    /// leave at edges, from overhangs and out of the room. Films flow, and take up drops that come to their solids.
    pub fn advance(&mut self, time: f64) {
        self.state.drops.retain(|drop| drop.mass > 0.0);
        self.fit();
        self.merge();
        self.slide(time);
        self.join_films();
        self.flow(time);
        self.find_covered();
    }

    /// Whether water lies on a solid as a film.
    fn has_film(&self, solid: u32) -> bool {
        self.water[solid as usize].is_film()
    }

    fn is_in_room(&self, position: [f64; 3]) -> bool {
        (0..3).all(|axis| (self.room[0][axis]..=self.room[1][axis]).contains(&position[axis]))
    }

    /// Finds which drop covers each site: of several the largest.
    fn find_covered(&mut self) {
        let mut cover = std::mem::take(&mut self.cover);
        cover.fill(NONE);
        for (number, drop) in self.state.drops.iter().enumerate() {
            self.sites_under(drop, |site| {
                let known = self.state.drops.get(cover[site] as usize);
                if known.is_none_or(|known| known.mass < drop.mass) {
                    cover[site] = number as u32;
                }
            });
        }
        self.cover = cover;
    }

    /// The sites that a drop covers; some come twice.
    fn sites_under(&self, drop: &Drop, mut found: impl FnMut(usize)) {
        let covered = drop.radius;
        self.sites.grid.near(drop.position, covered, 0.0, |at| {
            let site = &self.sites.all[at];
            let is_under = distance2(site.position, drop.position) < covered * covered
                && site.solid == drop.solid
                && dot(site.normal, drop.normal) > 0.0;
            if is_under {
                found(at);
            }
        });
    }

    /// Files the drops by position and reach.
    fn file(&mut self) {
        let reach = |drop: &Drop| reach(drop.radius, drop.mass / self.laws.density);
        self.reach = self.state.drops.iter().map(reach).collect();
        self.grid = Grid::new(self.state.drops.iter().map(|drop| drop.position), &self.reach);
    }
}

/// Mass of the smallest resolved drop, kg.
fn smallest_mass(laws: &DropLaws) -> f64 {
    laws.density * Cap::new(laws.contact_angle).volume(laws.smallest_radius)
}

/// Radius of the base of the smallest resolved drop, m.
pub fn smallest_reach(laws: &DropLaws) -> f64 {
    let cap = Cap::new(laws.contact_angle);
    reach(laws.smallest_radius, cap.volume(laws.smallest_radius))
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

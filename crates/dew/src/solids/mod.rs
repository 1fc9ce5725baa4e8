//! Solids as particles that stay where they are: what they are made of, where their surface is, how they conduct heat.

pub mod bodies;
mod boundary;
mod conduction;
pub(crate) mod contact;
mod ghosts;
pub(crate) mod sources;
#[cfg(feature = "gpu")]
pub(crate) mod upload;
pub(crate) mod wall;

pub use conduction::Conduction;
pub(crate) use ghosts::ghost_contact;

use crate::air::Scale;
use crate::constants::BEYOND;
use crate::room::{Face, GhostParticle, Mirrors, Room};
use crate::settings::{Conductor, WallTreatment};
use corpuscle_model::ModelError;
use corpuscle_solids::{Depth, Samples, Solid};
use corpuscle_sph::Cells;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use wall::WallCell;

/// What a solid is made of.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Conductivity of heat, W/(m K).
    pub conductivity: f64,
    /// Heat capacity, J/(kg K).
    pub heat_capacity: f64,
    /// Density, kg/m3.
    pub density: f64,
}

impl Material {
    /// What matters for conduction.
    pub fn conductor(&self) -> Conductor {
        Conductor { conductivity: self.conductivity, capacity: self.heat_capacity * self.density }
    }
}

impl From<corpuscle_solids::Material> for Material {
    fn from(material: corpuscle_solids::Material) -> Self {
        let corpuscle_solids::Material { conductivity, heat_capacity, density, .. } = material;
        Self { conductivity, heat_capacity, density }
    }
}

/// Signed distance of a position to a surface, m, negative inside.
pub type Surface = Arc<dyn Fn([f64; 3]) -> f64 + Send + Sync>;

/// A solid as given: particles, and what they have in common.
#[derive(Clone)]
pub struct Body {
    /// Positions of its particles, m, half a spacing below the surface and deeper.
    pub positions: Vec<[f64; 3]>,
    /// Their volumes, m3.
    pub volumes: Vec<f64>,
    /// The surface that each stands for, m2, 0 for those inside.
    pub areas: Vec<f64>,
    /// What it is made of.
    pub material: Material,
    /// Temperature at the start, K.
    pub temperature: f64,
    /// Whether it is held at that temperature, or free to warm.
    pub held: bool,
    /// Where its surface is, if known: ghost samples need it, and air starts outside it.
    pub surface: Option<Surface>,
    /// How it keeps air out, where not as all do.
    pub walls: Option<WallTreatment>,
}

/// A particle of a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolidParticle {
    /// Position, m.
    pub position: [f64; 3],
    /// Volume, m3.
    pub volume: f64,
    /// The surface that it stands for, m2.
    pub area: f64,
    /// Which body it is of.
    pub body: u32,
    /// Outward unit normal, where it is a boundary particle.
    pub normal: Option<[f64; 3]>,
    /// Whether air can come within reach of it.
    pub near_surface: bool,
}

/// All solids of a scene.
#[derive(Debug, Clone, Default)]
pub struct Solids {
    /// The particles.
    pub particles: Vec<SolidParticle>,
    /// What each body is made of and whether its temperature is held.
    pub bodies: Vec<(Material, bool)>,
    /// Sides that air passes beyond which each body goes on as its mirror image.
    pub mirrors: Vec<Mirrors>,
    /// Cells of the walls behind solids. Heat goes through them as through particles, whose numbers theirs follow.
    pub(crate) cells: Vec<WallCell>,
    /// The body in front of each wall.
    pub(crate) walls: Vec<u32>,
}

/// Where a particle of a solid or its ghost particle stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Site {
    /// Position, m.
    pub position: [f64; 3],
    /// The particle's number.
    pub particle: u32,
    /// Whether it is a ghost particle beyond a face.
    pub is_ghost_particle: bool,
    /// The axes along which the ghost particle is mirrored.
    pub mirrored: [bool; 3],
    /// Whether it is a ghost particle beyond a side that air passes: what air gives it has left the room.
    pub beyond: bool,
}

impl Site {
    /// Where a particle itself stands.
    pub fn itself(particle: u32, position: [f64; 3]) -> Self {
        Self { position, particle, is_ghost_particle: false, mirrored: [false; 3], beyond: false }
    }

    /// A ghost particle of it.
    pub fn ghost_particle(self, ghost: GhostParticle) -> Self {
        let GhostParticle { position, mirrored, beyond } = ghost;
        Self { position, is_ghost_particle: true, mirrored, beyond, ..self }
    }
}

impl Body {
    /// A solid sampled so that its particles are about a `spacing` apart, at a temperature, K.
    ///
    /// # Errors
    /// Where it cannot be sampled.
    pub fn sampled(
        solid: Solid,
        spacing: f64,
        material: Material,
        temperature: f64,
        held: bool,
    ) -> Result<Self, ModelError> {
        let samples = solid.sample(spacing, Depth::Full).map_err(|error| ModelError::Setup(error.to_string()))?;
        let Samples { positions, volumes, areas } = samples;
        let surface: Surface = Arc::new(move |position| solid.signed_distance(position));
        Ok(Self { positions, volumes, areas, material, temperature, held, surface: Some(surface), walls: None })
    }
}

impl Solids {
    /// The solids' particles. Those whose colour gradient is above `threshold` over the spacing are boundary particles.
    pub fn new(bodies: &[Body], room: &Room, scale: &Scale, threshold: f64) -> Self {
        let mut particles = Vec::new();
        for (number, body) in bodies.iter().enumerate() {
            for ((&position, &volume), &area) in body.positions.iter().zip(&body.volumes).zip(&body.areas) {
                let body = number as u32;
                particles.push(SolidParticle { position, volume, area, body, normal: None, near_surface: false });
            }
        }
        let mirrors = bodies.iter().map(|body| mirrors(body, room, scale)).collect();
        let of_bodies = bodies.iter().map(|body| (body.material, body.held)).collect();
        let mut solids = Self { particles, bodies: of_bodies, mirrors, cells: Vec::new(), walls: Vec::new() };
        solids.find_boundary(room, scale, threshold);
        solids
    }

    /// Material of a particle.
    pub fn material(&self, particle: usize) -> &Material {
        &self.bodies[self.particles[particle].body as usize].0
    }

    /// Particles and cells of walls.
    pub(crate) fn nodes(&self) -> usize {
        self.particles.len() + self.cells.len()
    }

    /// Bodies and walls.
    pub(crate) fn groups(&self) -> usize {
        self.bodies.len() + self.walls.len()
    }

    /// The body of a particle, or the wall of a cell, which are numbered after the bodies.
    pub(crate) fn group(&self, node: usize) -> usize {
        self.particles.get(node).map_or_else(
            || self.bodies.len() + self.cells[node - self.particles.len()].wall as usize,
            |particle| particle.body as usize,
        )
    }

    /// The wall behind a body, as a group, where there is one.
    pub(crate) fn wall_behind(&self, body: usize) -> Option<usize> {
        let wall = self.walls.iter().position(|&front| front as usize == body)?;
        Some(self.bodies.len() + wall)
    }

    /// Whether the temperature of a particle is held; that of a wall's cell never is.
    pub fn is_held(&self, node: usize) -> bool {
        self.particles.get(node).is_some_and(|particle| self.bodies[particle.body as usize].1)
    }

    /// Heat capacity of a particle or of a wall's cell, J/K.
    pub fn heat_capacity(&self, node: usize) -> f64 {
        let Some(particle) = self.particles.get(node) else { return self.cells[node - self.particles.len()].capacity };
        let Material { heat_capacity, density, .. } = *self.material(node);
        heat_capacity * density * particle.volume
    }

    /// Boundary particles.
    pub fn boundary(&self) -> impl Iterator<Item = &SolidParticle> {
        self.particles.iter().filter(|particle| particle.normal.is_some())
    }

    /// The particles that pass `wanted`, and their ghost particles within `reach` of the room.
    pub fn sites(&self, room: &Room, reach: f64, wanted: impl Fn(&SolidParticle) -> bool) -> Vec<Site> {
        let mut sites = Vec::new();
        for (number, particle) in self.particles.iter().enumerate().filter(|(_, particle)| wanted(particle)) {
            let site = Site::itself(number as u32, particle.position);
            sites.push(site);
            room.ghost_particles_beyond(particle.position, &self.mirrors[particle.body as usize], reach, |ghost| {
                sites.push(site.ghost_particle(ghost));
            });
        }
        sites
    }
}

/// A body's outermost particles are this near to a side of the room that it reaches, over the spacing: wherever a layer is beyond, one is as near as that.
const AT_SIDE: f64 = 1.001;

/// A body that reaches a side of the room that air passes, and of which there is nothing beyond, goes on there as its mirror image as far as there is air.
fn mirrors(body: &Body, room: &Room, scale: &Scale) -> Mirrors {
    let depth = |axis: usize, side: usize| {
        let depths = body.positions.iter().map(|&position| room.depth_beyond(position, axis, side));
        depths.fold(f64::NEG_INFINITY, f64::max)
    };
    [0, 1, 2].map(|axis| {
        [0, 1].map(|side| {
            let goes_on = matches!(room.faces[axis][side], Face::Outlet | Face::Open)
                && (-AT_SIDE * scale.spacing..0.0).contains(&depth(axis, side));
            goes_on.then_some(BEYOND * scale.h())
        })
    })
}

/// Sites in the order of their cells, to be searched.
#[derive(Debug, Default)]
pub(crate) struct Searched {
    pub sites: Vec<Site>,
    cells: Cells<3>,
}

impl Searched {
    pub fn new(sites: &[Site], reach: f64) -> Self {
        let [x, y, z] = [0, 1, 2].map(|axis| sites.iter().map(|site| site.position[axis]).collect::<Vec<f64>>());
        let mut cells = Cells::default();
        let sites =
            cells.sort([&x, &y, &z], Cells::<3>::sizes_for(reach)).iter().map(|&from| sites[from as usize]).collect();
        Self { sites, cells }
    }

    /// The sites within `reach` of a position, and the squares of their distances.
    pub fn near(&self, position: [f64; 3], reach: f64) -> impl Iterator<Item = (&Site, f64)> {
        let mut near = Vec::new();
        if !self.sites.is_empty() {
            for range in self.cells.ranges_within(position, reach) {
                let sites = self.sites[range].iter().map(|site| (site, distance_squared(site.position, position)));
                near.extend(sites.filter(|(_, r_squared)| *r_squared < reach * reach));
            }
        }
        near.into_iter()
    }
}

/// Square of the distance of two positions, m2.
pub(crate) fn distance_squared(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [x, y, z] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    x * x + y * y + z * z
}

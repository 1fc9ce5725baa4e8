//! Films of water on solids that water wets: filmwise condensation.
//!
//! A film of thickness h flows down a surface by its weight, against its viscosity, with the volume q = rho g h^3 / (3 mu) for each width and time, g
//! being gravity along the surface (Nusselt, Zeitschrift des Vereines Deutscher Ingenieure 60, 1916, 541). Each patch of such a solid has a film of
//! one thickness, and passes what flows to the patches below it; at an edge it leaves the solid.

use super::motion::SHARPEST_BEND;
use super::sites::Sites;
use super::{Drop, DropLaws, Drops, Patch, SurfaceWater, dot, without};

/// Where the water of a patch flows to.
#[derive(Debug, Clone, PartialEq)]
struct Stream {
    /// Its site.
    site: u32,
    /// Area of the patch, m2.
    area: f64,
    /// Gravity along the surface, m/s2.
    gravity: f64,
    /// Gravity away from the surface, m/s2: above 0 where the film hangs.
    hang: f64,
    /// Mean distance down the surface to where the water goes, m.
    distance: f64,
    /// The sites that get it, as a range of [`Films::targets`]; what they do not get leaves.
    targets: std::ops::Range<usize>,
}

/// The films of all solids that have some.
#[derive(Debug, Clone, Default)]
pub(super) struct Films {
    /// Whether a patch has a film.
    is_any: bool,
    /// The gravity for which the streams were found.
    gravity: [f64; 3],
    streams: Vec<Stream>,
    /// Sites that get water, and the part of it that each gets.
    targets: Vec<(u32, f64)>,
    /// What flows out of each stream's patch in a step, kg; kept from step to step.
    outflow: Vec<f64>,
    /// The site of each patch with a film, by patch.
    site_of: Vec<Option<u32>>,
}

/// Largest part of a patch that a change of thickness passes in a step.
const COURANT: f64 = 0.5;

/// Least mean distance to where water goes, over the width of a patch.
const SHORTEST: f64 = 0.5;

/// Parts of a patch below this are rounding.
const LEAST_PART: f64 = 1e-9;

/// Most steps for one call: films so thick that they need more flow too slowly.
const MOST_STEPS: f64 = 1000.0;

impl Films {
    pub(super) fn new(patches: &[Patch], water: &[SurfaceWater], sites: &Sites) -> Self {
        let mut site_of = vec![None; patches.len()];
        for piece in &sites.pieces {
            if water[patches[piece.patch as usize].solid as usize].is_film() {
                site_of[piece.patch as usize] = Some(piece.site);
            }
        }
        let is_any = site_of.iter().any(Option::is_some);
        Self { gravity: [f64::NAN; 3], is_any, site_of, ..Self::default() }
    }
}

impl Drops {
    /// Lets the films flow for a time, s.
    pub(super) fn flow(&mut self, time: f64) {
        if !self.films.is_any {
            return;
        }
        if self.films.gravity != self.laws.gravity {
            self.find_streams();
        }
        let mut films = std::mem::take(&mut self.films);
        let time = time * self.laws.time_factor;
        let mut left = time;
        while left > 0.0 {
            let step = films.longest_step(&self.laws, &self.state.unseen).max(time / MOST_STEPS).min(left);
            self.state.dripped.add(films.step(&self.laws, &mut self.state.unseen, step));
            left -= step;
        }
        self.films = films;
    }

    /// Drops on solids with a film become part of it.
    pub(super) fn join_films(&mut self) {
        if !self.films.is_any {
            return;
        }
        let (joining, staying): (Vec<Drop>, _) =
            self.state.drops.iter().partition(|drop: &&Drop| self.has_film(drop.solid));
        self.state.drops = staying;
        for drop in &joining {
            let under = self.patches_under(drop);
            let area: f64 = under.iter().map(|&patch| self.patches[patch].area()).sum();
            let sites = under.iter().filter_map(|&patch| Some((patch, self.films.site_of[patch]?)));
            for (patch, site) in sites {
                self.state.unseen[site as usize] += drop.mass * self.patches[patch].area() / area;
            }
            if under.is_empty() {
                self.state.dripped.add(drop.mass);
                self.state.dripped_count += 1;
            }
        }
    }

    /// Finds where the water of each patch flows to.
    fn find_streams(&mut self) {
        let (mut streams, mut targets) = (Vec::new(), Vec::new());
        for (at, patch) in self.patches.iter().enumerate() {
            let Some(site) = self.films.site_of[at] else { continue };
            let along = without(self.laws.gravity, patch.normal);
            let gravity = dot(along, along).sqrt();
            let first = targets.len();
            let width = 2.0 * patch.half_width;
            let mut distance = width;
            if gravity > 0.0 {
                let down = along.map(|part| part / gravity);
                for (other, part) in self.below(at, down) {
                    distance += part * (distance_along(patch, &self.patches[other], down) - width);
                    targets.extend(self.films.site_of[other].map(|site| (site, part)));
                }
            }
            streams.push(Stream {
                site,
                area: patch.area(),
                // Where patches lie unevenly, the water goes as far as it should on average.
                distance: distance.max(SHORTEST * width),
                gravity,
                hang: dot(self.laws.gravity, patch.normal),
                targets: first..targets.len(),
            });
        }
        self.films.outflow = vec![0.0; streams.len()];
        (self.films.gravity, self.films.streams, self.films.targets) = (self.laws.gravity, streams, targets);
    }

    /// The patches to which the water of one flows in the direction `down`, each with its part. They are those on which the patch, a square along the
    /// solid's own axes, lies once it is moved down by its own width, in proportion to the areas in common: on a flat side water so flows in just that direction.
    /// A part may stay on the patch itself. What then lies beyond an edge leaves; elsewhere the parts make one.
    fn below(&self, at: usize, down: [f64; 3]) -> Vec<(usize, f64)> {
        let patch = &self.patches[at];
        let width = 2.0 * patch.half_width;
        let axes = self.axes_of(patch);
        let ahead: [f64; 3] = std::array::from_fn(|axis| patch.position[axis] + width * down[axis]);
        let mut near = Vec::new();
        self.patch_grid.near(ahead, 2.0 * width, 0.0, |other| near.push(other));
        near.sort_unstable();
        near.dedup();
        let mut below: Vec<(usize, f64)> = near
            .into_iter()
            .filter_map(|other| {
                let Patch { solid, position, normal, .. } = self.patches[other];
                let from: [f64; 3] = std::array::from_fn(|axis| position[axis] - ahead[axis]);
                let in_common = |axis: [f64; 3]| (1.0 - dot(from, axis).abs() / width).max(0.0);
                let part = in_common(axes[0]) * in_common(axes[1]);
                let is_of_it = solid == patch.solid && dot(normal, patch.normal) > SHARPEST_BEND;
                (is_of_it && part > LEAST_PART).then_some((other, part))
            })
            .collect();
        if self.is_at_edge(patch, ahead, axes) {
            let all: f64 = below.iter().map(|&(_, part)| part).sum();
            below.iter_mut().for_each(|(_, part)| *part /= all.max(1.0));
            return below;
        }
        // What stays is as computed, and the others get the rest. Where there is none, as where the surface leaves the air, it leaves.
        let sum = |is_own: bool| -> f64 {
            below.iter().filter(|&&(other, _)| (other == at) == is_own).map(|&(_, part)| part).sum()
        };
        let [stays, goes] = [sum(true), sum(false)];
        if goes < LEAST_PART {
            return Vec::new();
        }
        below.iter_mut().filter(|(other, _)| *other != at).for_each(|(_, part)| *part *= (1.0 - stays) / goes);
        below
    }

    /// Two directions along a patch, those of its solid's own axes where it is one of their sides.
    fn axes_of(&self, patch: &Patch) -> [[f64; 3]; 2] {
        let solid = &self.solids[patch.solid as usize];
        let [across, _] = solid.axis_and_end(patch.normal);
        let mut own = [0.0; 3];
        own[(across + 1) % 3] = 1.0;
        let along = without(solid.direction_of(own), patch.normal);
        let length = dot(along, along).sqrt();
        let first = along.map(|part| part / length);
        let [a, b] = [patch.normal, first];
        [first, [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]]
    }

    /// Whether a corner of a patch that is moved to `ahead` lies beyond an edge or out of the room.
    fn is_at_edge(&self, patch: &Patch, ahead: [f64; 3], axes: [[f64; 3]; 2]) -> bool {
        // Just within the corner: that of a patch at an edge may lie on it.
        let reach = 0.98 * patch.half_width;
        [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]].into_iter().any(|signs| {
            let corner =
                std::array::from_fn(|axis| ahead[axis] + reach * (signs[0] * axes[0][axis] + signs[1] * axes[1][axis]));
            let (foot, normal) = self.foot(patch.solid, corner);
            dot(normal, patch.normal) < SHARPEST_BEND || !self.is_in_room(foot)
        })
    }
}

/// How far another patch is down the surface, m.
fn distance_along(patch: &Patch, other: &Patch, down: [f64; 3]) -> f64 {
    dot(std::array::from_fn(|axis| other.position[axis] - patch.position[axis]), down)
}

impl Stream {
    /// Part of the water that flows away in a second, 1/s, at `mass` kg.
    fn rate(&self, laws: &DropLaws, mass: f64) -> f64 {
        let thickness = mass / (laws.density * self.area);
        laws.density * self.gravity * thickness * thickness / (3.0 * laws.viscosity * self.distance)
    }

    /// The most that hangs from a surface, kg: a film as thick as the capillary length, beyond which surface tension does not hold it.
    fn most(&self, laws: &DropLaws) -> f64 {
        if self.hang <= 0.0 {
            return f64::INFINITY;
        }
        laws.density * self.area * (laws.surface_tension / (laws.density * self.hang)).sqrt()
    }
}

impl Films {
    /// A time in which no change of thickness passes more than a part of a patch, s: it goes three times as fast as the water.
    fn longest_step(&self, laws: &DropLaws, water: &[f64]) -> f64 {
        let rates = self.streams.iter().map(|stream| stream.rate(laws, water[stream.site as usize]));
        COURANT / (3.0 * rates.fold(0.0, f64::max))
    }

    /// A step of the water at all sites, kg; what leaves, kg.
    fn step(&mut self, laws: &DropLaws, water: &mut [f64], step: f64) -> f64 {
        let mut leaves = 0.0;
        for (stream, outflow) in self.streams.iter().zip(&mut self.outflow) {
            let mass = water[stream.site as usize];
            *outflow = mass * (stream.rate(laws, mass) * step).min(1.0);
        }
        for (stream, &outflow) in self.streams.iter().zip(&self.outflow) {
            water[stream.site as usize] -= outflow;
            let mut goes_on = 0.0;
            for &(site, part) in &self.targets[stream.targets.clone()] {
                water[site as usize] += part * outflow;
                goes_on += part * outflow;
            }
            leaves += outflow - goes_on;
        }
        for stream in &self.streams {
            let (held, most) = (&mut water[stream.site as usize], stream.most(laws));
            if *held > most {
                leaves += *held - most;
                *held = most;
            }
        }
        leaves
    }
}

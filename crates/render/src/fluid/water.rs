//! The particles of shallow water, as they are drawn.

use super::Droplet;
use corpuscle_model::{ParticleSet, Values};
use corpuscle_sph::Cells;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::collections::HashMap;

/// Radius of the discs that the surface is drawn with, in distances between particles: they overlap.
pub(super) const DISC: f64 = 1.4;
/// Their thickness over their width.
pub(super) const FLATNESS: f64 = 0.12;
/// Radius of the neighbour search, and of the spread of a particle's water, in spacings.
pub(super) const REACH: f64 = 2.0;
/// Where particles are sparse each is as wide as the water that it stands for, volume over depth; but at most so many times its spacing.
pub(super) const WIDEST: f64 = 2.5;
/// Steepest slope of a water surface.
pub(super) const STEEPEST: f64 = 1.0;
/// Passes of the limitation of slopes, each over the neighbours of each particle.
const SETTLINGS: usize = 12;
/// Least second moment of neighbours for a fitted plane, in squares of their distance: 0.4 where they are even.
pub(super) const LEVEL: f64 = 0.02;
/// Convergence of the water within a disc's reach at which air begins to be trapped, and from which it is to the full, m/s.
pub(super) const TRAPPED: [f64; 2] = [1.2, 5.0];
/// Sum of poly6 weights (3.1 in closed water) from which on there is foam, and from which on all of it: drops that run alone have none.
pub(super) const CLOSED: [f64; 2] = [1.6, 2.8];
/// Kinetic energy of a mass of 1 between which the same happens, m2/s2.
pub(super) const ENERGY: [f64; 2] = [0.5, 6.0];
/// Time in which foam falls to a third, s.
pub(super) const LIFE: f64 = 4.0;

/// Makes discs in the water's surface from the particles of shallow water, and balls from those in the air. Stores the
/// foam on them from picture to picture, so that it goes with the water and fades.
#[derive(Debug, Clone, Default)]
pub struct Water {
    time: Option<f64>,
    foam: HashMap<u64, f64>,
}

/// A particle on the ground.
#[derive(Clone, Copy)]
struct Column {
    index: usize,
    /// Distance to its neighbours, m.
    spacing: f64,
    /// Where it is, m.
    at: DVec2,
    /// Height of the surface, m, and velocity eastwards and northwards, m/s.
    state: DVec3,
    /// Slope of the ground `[eastwards, northwards]`, m per m.
    ground: DVec2,
}

impl Water {
    /// Particles as they are drawn at a time, s, not before that of the last call. Those that have a column `depth` of more than 0 lie
    /// on the ground; the others are in the air. `slope` is the ground's at a position `[eastwards, northwards]`, m per m: water without
    /// neighbours lies along it.
    pub fn droplets(
        &mut self,
        time: f64,
        set: &ParticleSet,
        slope: impl Fn([f64; 2]) -> [f64; 2] + Sync,
    ) -> Vec<Droplet> {
        let depths = set.columns.iter().find(|column| column.name == "depth").map(|column| &column.values);
        let depth = |index: usize| match depths {
            Some(Values::Scalar(depths)) => depths[index],
            _ => 0.0,
        };
        let (ground, air): (Vec<usize>, Vec<usize>) = (0..set.len()).partition(|&index| depth(index) > 0.0);
        let mut droplets = on_ground(set, &ground, depth, slope);
        self.keep_foam(time, &mut droplets);
        droplets.extend(air.into_iter().map(|index| in_air(set, index)));
        droplets
    }

    /// Foam is what comes now, or what is left of what was.
    fn keep_foam(&mut self, time: f64, droplets: &mut [Droplet]) {
        let left = self.time.map_or(0.0, |before| (-(time - before).max(0.0) / LIFE).exp());
        for droplet in droplets.iter_mut() {
            let before = self.foam.get(&droplet.id).copied().unwrap_or(0.0);
            droplet.foam = droplet.foam.max(left * before);
        }
        self.time = Some(time);
        self.foam = droplets
            .iter()
            .filter(|droplet| droplet.foam > LEAST_FOAM)
            .map(|droplet| (droplet.id, droplet.foam))
            .collect();
    }
}

fn in_air(set: &ParticleSet, index: usize) -> Droplet {
    let volume = set.mass[index] / DENSITY;
    let radius = (volume * 0.75 / std::f64::consts::PI).cbrt();
    Droplet { id: set.id[index], foam: SPRAY_FOAM, ..Droplet::ball(set.position[index], radius) }
}

/// Foam on particles in the air.
pub(super) const SPRAY_FOAM: f64 = 0.15;

/// Less foam is not kept from picture to picture.
pub(super) const LEAST_FOAM: f64 = 0.01;

/// Of water, kg/m3.
const DENSITY: f64 = 1000.0;

fn on_ground(
    set: &ParticleSet,
    ground: &[usize],
    depth: impl Fn(usize) -> f64,
    slope: impl Fn([f64; 2]) -> [f64; 2] + Sync,
) -> Vec<Droplet> {
    if ground.is_empty() {
        return Vec::new();
    }
    let column = |index: usize| {
        let ([x, y, z], [east, north, _]) = (set.position[index], set.velocity[index]);
        let at = DVec2::new(x, y);
        let ground = slope([x, y]).into();
        let (spacing, width) = (2.0 * set.radius[index], (set.mass[index] / DENSITY / depth(index)).sqrt());
        let spacing = width.max(spacing).min(WIDEST * spacing);
        Column { index, spacing, at, state: DVec3::new(z, east, north), ground }
    };
    let mut columns: Vec<Column> = ground.iter().map(|&index| column(index)).collect();
    let along = |axis: usize| -> Vec<f64> { columns.iter().map(|column| column.at[axis]).collect() };
    let mean = columns.iter().map(|column| column.spacing).sum::<f64>() / columns.len() as f64;
    let mut cells = Cells::default();
    let order = cells.sort([&along(0), &along(1)], [REACH * mean; 2]).to_vec();
    columns = order.iter().map(|&at| column(ground[at as usize])).collect();
    settle(&cells, &mut columns);
    // Particles tremble, more so in scheme sph-swe; what is seen is what they do together.
    let calm = |own: &Column| Column { state: Planes::around(own, &cells, &columns).fit(own).here, ..*own };
    columns = columns.par_iter().map(calm).collect();
    let mut droplets: Vec<Droplet> = columns.par_iter().map(|own| disc(set, &cells, &columns, own)).collect();
    let foam: Vec<f64> = columns.par_iter().map(|own| foam_around(own, &cells, &columns, &droplets)).collect();
    droplets.iter_mut().zip(foam).for_each(|(droplet, foam)| droplet.foam = foam);
    // The order of the frame, which does not depend on the cells.
    droplets.sort_unstable_by_key(|droplet| droplet.id);
    droplets
}

/// Limits the slope of the surface: where scheme sph-swe piles particles up before a wall, it finds columns of great
/// height. The ground's slope comes on top.
fn settle(cells: &Cells<2>, columns: &mut Vec<Column>) {
    let bounded = |own: &Column, all: &[Column]| {
        let reach = REACH * own.spacing;
        let steepest = STEEPEST + own.ground.length();
        let near = cells.ranges_within(own.at.into(), reach).flat_map(|range| &all[range]);
        near.map(|near| (near.state.x, near.at.distance(own.at)))
            .filter(|(_, distance)| *distance < reach)
            .fold(own.state.x, |height, (other, distance)| height.min(other + steepest * distance))
    };
    for _ in 0..SETTLINGS {
        let heights: Vec<f64> = columns.par_iter().map(|own| bounded(own, columns)).collect();
        let settled = columns.iter().zip(&heights).all(|(own, height)| own.state.x == *height);
        columns.iter_mut().zip(heights).for_each(|(own, height)| own.state.x = height);
        if settled {
            break;
        }
    }
}

/// The disc of a particle, in the plane that fits best to its neighbours' surfaces.
fn disc(set: &ParticleSet, cells: &Cells<2>, columns: &[Column], own: &Column) -> Droplet {
    let planes = Planes::around(own, cells, columns);
    let fit = planes.fit(own);
    let slope = DVec2::new(fit.east.x, fit.north.x).clamp_length_max(STEEPEST);
    let normal = DVec3::new(-slope.x, -slope.y, 1.0).normalize();
    // How fast the water of a disc runs together.
    let closing = -(fit.east.y + fit.north.z) * REACH * own.spacing;
    let velocity = DVec3::from(set.velocity[own.index]);
    let radius = DISC * own.spacing;
    let middle = own.at.extend(fit.here.x) - normal * (FLATNESS * radius);
    Droplet {
        position: middle.into(),
        radius,
        normal: normal.into(),
        flatness: FLATNESS,
        volume: set.mass[own.index] / DENSITY,
        reach: REACH * own.spacing,
        flow: [fit.here.y, fit.here.z],
        foam: part(closing, TRAPPED) * part(0.5 * velocity.length_squared(), ENERGY) * part(planes.weight, CLOSED),
        id: set.id[own.index],
    }
}

/// The mean foam within reach of a column: foam spreads, and single particles are not flecked.
fn foam_around(own: &Column, cells: &Cells<2>, columns: &[Column], droplets: &[Droplet]) -> f64 {
    let reach = REACH * own.spacing;
    let near = cells.ranges_within(own.at.into(), reach).flatten();
    let weighed = near.map(|near| {
        let out = columns[near].at.distance_squared(own.at) / (reach * reach);
        ((1.0 - out).max(0.0).powi(3), droplets[near].foam)
    });
    let (sum, weights) =
        weighed.fold((0.0, 0.0), |(sum, weights), (weight, foam)| (sum + weight * foam, weights + weight));
    sum / weights
}

/// Linear step between two values: 0 at the first, 1 at the second (Ihmsen et al. 2012, eq. 1).
fn part(value: f64, [low, high]: [f64; 2]) -> f64 {
    ((value - low) / (high - low)).clamp(0.0, 1.0)
}

/// Weighted sums for planes f = a + b x + c y of least squares, of the three numbers of a column's state at once.
#[derive(Default)]
struct Planes {
    weight: f64,
    at: DVec2,
    xx: f64,
    xy: f64,
    yy: f64,
    state: DVec3,
    state_x: DVec3,
    state_y: DVec3,
}

/// Planes at a column: values there, and slopes east and north.
struct Fit {
    here: DVec3,
    east: DVec3,
    north: DVec3,
}

impl Planes {
    /// Of the columns within reach of one.
    fn around(own: &Column, cells: &Cells<2>, columns: &[Column]) -> Self {
        let reach = REACH * own.spacing;
        let mut planes = Self::default();
        for near in cells.ranges_within(own.at.into(), reach).flat_map(|range| &columns[range]) {
            let away = near.at - own.at;
            let out = away.length_squared() / (reach * reach);
            if out < 1.0 {
                // Heights over a plane along the ground, so that planes of few neighbours lie along it.
                planes.add((1.0 - out).powi(3), away, near.state - DVec3::X * own.ground.dot(away));
            }
        }
        planes
    }

    fn add(&mut self, weight: f64, away: DVec2, state: DVec3) {
        self.weight += weight;
        self.at += weight * away;
        self.xx += weight * away.x * away.x;
        self.xy += weight * away.x * away.y;
        self.yy += weight * away.y * away.y;
        self.state += weight * state;
        self.state_x += weight * away.x * state;
        self.state_y += weight * away.y * state;
    }

    /// With few neighbours, or all in a line, heights follow the ground across it, and velocities do not change.
    fn fit(&self, own: &Column) -> Fit {
        let (at, mean) = (self.at / self.weight, self.state / self.weight);
        let level = LEVEL * own.spacing * own.spacing;
        let xx = self.xx / self.weight - at.x * at.x + level;
        let xy = self.xy / self.weight - at.x * at.y;
        let yy = self.yy / self.weight - at.y * at.y + level;
        let [x, y] = [self.state_x / self.weight - at.x * mean, self.state_y / self.weight - at.y * mean];
        let determinant = xx * yy - xy * xy;
        let (east, north) = ((yy * x - xy * y) / determinant, (xx * y - xy * x) / determinant);
        let here = mean - at.x * east - at.y * north;
        Fit { here, east: east + DVec3::X * own.ground.x, north: north + DVec3::X * own.ground.y }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_model::Column as Named;

    const LEVEL_GROUND: fn([f64; 2]) -> [f64; 2] = |_| [0.0; 2];

    /// Water 1 m deep whose surface is a tilted plane, every particle 1 m from the next, with velocities.
    fn tilted(velocity: impl Fn(f64) -> [f64; 3]) -> ParticleSet {
        let positions: Vec<[f64; 3]> = (0..400)
            .map(|index| [f64::from(index % 20), f64::from(index / 20)])
            .map(|[x, y]| [x, y, 0.2 * x - 0.1 * y])
            .collect();
        let depth = Values::Scalar(vec![1.0; positions.len()]);
        ParticleSet {
            name: "water".into(),
            id: (0..400).collect(),
            velocity: positions.iter().map(|position| velocity(position[0])).collect(),
            radius: vec![0.5; positions.len()],
            mass: vec![1000.0; positions.len()],
            columns: vec![Named { name: "depth", unit: "m", values: depth }],
            position: positions,
        }
    }

    #[test]
    fn discs_lie_in_the_surface() {
        let droplets = Water::default().droplets(0.0, &tilted(|_| [0.0; 3]), LEVEL_GROUND);
        let middle = droplets.iter().find(|droplet| droplet.id == 210).unwrap();
        let normal = DVec3::new(-0.2, 0.1, 1.0).normalize();
        assert!(DVec3::from(middle.normal).angle_between(normal) < 0.02);
        let top = DVec3::from(middle.position) + DVec3::from(middle.normal) * middle.flatness * middle.radius;
        assert!((top.z - (0.2 * top.x - 0.1 * top.y)).abs() < 1e-3, "{top}");
    }

    #[test]
    fn lone_water_lies_along_the_ground() {
        let mut set = tilted(|_| [0.0; 3]);
        set.position.iter_mut().for_each(|position| (0..2).for_each(|k| position[k] *= 9.0));
        let droplets = Water::default().droplets(0.0, &set, |_| [0.3, -0.4]);
        let normal = DVec3::new(-0.3, 0.4, 1.0).normalize();
        assert!(droplets.iter().all(|droplet| DVec3::from(droplet.normal).angle_between(normal) < 1e-6));
    }

    #[test]
    fn sparse_particles_are_as_wide_as_the_water_that_they_stand_for() {
        let mut set = tilted(|_| [0.0; 3]);
        let radius = |set: &ParticleSet| Water::default().droplets(0.0, set, LEVEL_GROUND)[0].radius;
        assert!((radius(&set) - DISC).abs() < 1e-12);
        // A cubic metre that is 0.25 m deep covers 4 m2; of a film no more is drawn than so many spacings.
        for (depth, width) in [(0.25, 2.0), (0.01, WIDEST), (4.0, 1.0)] {
            set.columns[0].values = Values::Scalar(vec![depth; 400]);
            assert!((radius(&set) - width * DISC).abs() < 1e-12, "{depth}");
        }
    }

    #[test]
    fn what_stands_steeper_than_water_can_is_taken_down() {
        let mut set = tilted(|_| [0.0; 3]);
        for index in [209, 210, 229, 230] {
            set.position[index][2] += 30.0;
        }
        let position = set.position.clone();
        let level = |index: usize| 0.2 * position[index][0] - 0.1 * position[index][1];
        let droplets = Water::default().droplets(0.0, &set, LEVEL_GROUND);
        let piled = droplets.iter().find(|droplet| droplet.id == 209).unwrap();
        assert!(piled.position[2] < level(209) + 2.0, "{:?}", piled.position);
        let calm = droplets.iter().find(|droplet| droplet.id == 105).unwrap();
        assert!((calm.position[2] - level(105)).abs() < 0.3);
    }

    #[test]
    fn foam_comes_where_water_meets_water_goes_with_it_and_fades() {
        let foam = |droplets: &[Droplet], id: u64| droplets.iter().find(|droplet| droplet.id == id).unwrap().foam;
        let mut water = Water::default();
        let meeting = tilted(|x| [if x < 10.0 { 3.0 } else { -3.0 }, 0.0, 0.0]);
        let droplets = water.droplets(0.0, &meeting, LEVEL_GROUND);
        assert!(foam(&droplets, 209) > 0.05 && foam(&droplets, 204) == 0.0);
        let parting = tilted(|x| [if x < 10.0 { -3.0 } else { 3.0 }, 0.0, 0.0]);
        assert!(foam(&Water::default().droplets(0.0, &parting, LEVEL_GROUND), 209) < 0.5 * foam(&droplets, 209));
        let calm = tilted(|_| [0.0; 3]);
        let later = water.droplets(LIFE, &calm, LEVEL_GROUND);
        assert!((foam(&later, 209) / foam(&droplets, 209) - (-1f64).exp()).abs() < 1e-9);
    }

    #[test]
    fn what_is_in_the_air_is_a_ball_of_its_volume() {
        let mut set = tilted(|_| [0.0; 3]);
        set.columns.clear();
        let droplets = Water::default().droplets(0.0, &set, LEVEL_GROUND);
        assert_eq!((droplets.len(), droplets[0].flatness, droplets[0].volume), (400, 1.0, 0.0));
        assert!((4.0 / 3.0 * std::f64::consts::PI * droplets[0].radius.powi(3) - 1.0).abs() < 1e-12);
    }
}

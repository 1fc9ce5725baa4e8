//! Balls at random: dropped one after the other where there is room, or grown from dilute.
//!
//! Growing is Lubachevsky and Stillinger's (J. Stat. Phys. 60, 1990, 561): balls that start small and move about grow at a constant
//! rate until they have their radius; the engine handles their collisions.

use super::positions::{JAMMED, closest};
use super::{Setup, ball_volume};
use crate::SetupError;
use crate::engine::Engine;
use crate::functions::pow;
use crate::hash::Hash;
use crate::pause::Pause;
use crate::random::normal;
use crate::world::{Facing, Field, Kind, Start, Wall, World};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// A ball at its position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Placed<const D: usize> {
    pub position: [f64; D],
    pub radius: f64,
}

/// Packings up to which balls are inserted one by one (random sequential addition ends at 0.547 and 0.38).
const INSERTION_PACKING: [f64; 2] = [0.40, 0.25];

/// Packings from which balls are grown; the second where there is no room for the first.
const SEED_PACKINGS: [[f64; 2]; 2] = [[0.25, 0.15], [0.05, 0.05]];

/// Largest radius from which balls are grown, over that which they have in the end.
const SEED_RADIUS: f64 = 0.9;

/// Speed at which radii grow over the thermal speed: in fluids, and beyond the packings below, slower, to end near jamming.
const GROWTH_SPEED: [f64; 2] = [0.6, 0.01];
const FLUID_PACKING: [f64; 2] = [0.68, 0.53];

/// Collisions of each ball at its final radius, in which most of the excess of balls in contact that growing leaves is lost. To grow fast
/// and settle then is nearer to equilibrium than to grow slowly for as many collisions.
const SETTLING_COLLISIONS: u64 = 3;

/// Remaining growth over the mean free path above which growing is given up. Near jamming the gap that is left is
/// about two such paths.
const MAX_GAP_IN_FREE_PATHS: f64 = 5.0;

/// Packings that many equal balls do not reach, and the number from which that holds: by thousands they jam at 0.867 to 0.871, in space a little above 0.64 (measured with this code).
const JAMMING_PACKING: [f64; 2] = [0.875, 0.66];
const JAMMING_MIN_COUNT: usize = 1000;

/// Events between two checks of how far balls have settled.
const EVENTS_PER_CHECK: u64 = 20_000;

/// Consecutive failed tries after which insertion is given up.
const MAX_INSERTION_TRIES: usize = 100_000;

/// Factor on radii, a little above 1, so that a gap remains between balls.
const RADIUS_MARGIN: f64 = 1.0 + 1e-11;

/// Mass of balls that do not move while others grow.
const IMMOVABLE_MASS: f64 = 1e30;

/// Places the species of one region at random, clear of what is placed already: a list for each.
pub(super) fn place<const D: usize>(
    setup: &Setup<D>,
    group: &[usize],
    placed: &[Placed<D>],
    random: &mut ChaCha8Rng,
) -> Result<Vec<Vec<Placed<D>>>, SetupError> {
    let region = setup.region_of(&setup.species[group[0]]);
    let counts: Vec<usize> = group.iter().map(|&number| setup.count_of(&setup.species[number])).collect();
    let radii: Vec<f64> = group
        .iter()
        .zip(&counts)
        .flat_map(|(&number, &count)| std::iter::repeat_n(setup.species[number].radius, count))
        .collect();
    let site = Site { setup, region, repeats: setup.repeats(&region), placed };
    let packing = site.packing(&radii);
    let positions = if packing <= INSERTION_PACKING[D - 2] { site.drop(&radii, random) } else { None };
    let positions = match positions {
        Some(positions) => positions,
        None => site.grow(&radii, packing, random).map_err(|reached| SetupError::Jammed {
            what: site.names(group),
            packing,
            reached,
            limit: JAMMED[D - 2],
            lattice: closest::<D>(),
        })?,
    };
    let mut all = positions.into_iter().zip(radii).map(|(position, radius)| setup.inside(Placed { position, radius }));
    Ok(counts.into_iter().map(|count| all.by_ref().take(count).collect()).collect())
}

/// Where balls are to be placed.
struct Site<'a, const D: usize> {
    setup: &'a Setup<D>,
    region: [[f64; D]; 2],
    repeats: [bool; D],
    placed: &'a [Placed<D>],
}

impl<const D: usize> Site<'_, D> {
    fn names(&self, group: &[usize]) -> String {
        let names: Vec<String> = group.iter().map(|&number| format!("{:?}", self.setup.species[number].name)).collect();
        format!("species {}", names.join(", "))
    }

    fn length(&self) -> [f64; D] {
        std::array::from_fn(|axis| self.region[1][axis] - self.region[0][axis])
    }

    /// What is placed already and reaches into the region.
    fn obstacles(&self) -> impl Iterator<Item = &Placed<D>> {
        let reaches = |placed: &&Placed<D>| {
            (0..D).all(|axis| {
                let x = placed.position[axis];
                x + placed.radius > self.region[0][axis] && x - placed.radius < self.region[1][axis]
            })
        };
        self.placed.iter().filter(reaches)
    }

    /// Part of the region that is filled in the end.
    fn packing(&self, radii: &[f64]) -> f64 {
        let filled = radii.iter().copied().chain(self.obstacles().map(|placed| placed.radius));
        filled.map(ball_volume::<D>).sum::<f64>() / self.length().iter().product::<f64>()
    }

    /// Places at random, the largest balls first; `None` where no more room is found.
    fn drop(&self, radii: &[f64], random: &mut ChaCha8Rng) -> Option<Vec<[f64; D]>> {
        self.drop_scaled(radii, 1.0, random)
    }

    fn drop_scaled(&self, radii: &[f64], scale: f64, random: &mut ChaCha8Rng) -> Option<Vec<[f64; D]>> {
        let largest = radii.iter().copied().chain(self.placed.iter().map(|placed| placed.radius)).fold(0.0, f64::max);
        let count = radii.len() + self.placed.len();
        let periods = std::array::from_fn(|axis| if self.repeats[axis] { self.length()[axis] } else { 0.0 });
        let mut hash = Hash::new(self.region[0], self.length(), periods, 2.0 * largest, count);
        for placed in self.obstacles() {
            hash.add(placed.position, placed.radius * scale);
        }
        let mut order: Vec<usize> = (0..radii.len()).collect();
        order.sort_by(|&a, &b| radii[b].total_cmp(&radii[a]));
        let mut positions = vec![[0.0; D]; radii.len()];
        let mut rest = &order[..];
        while !rest.is_empty() {
            let alike = rest.partition_point(|&ball| radii[ball] > 0.5 * radii[rest[0]]);
            let mut left = rest[..alike].to_vec();
            rest = &rest[alike..];
            let mut in_vain = 0;
            while !left.is_empty() {
                let before = left.len();
                left = self.try_once(&left, radii, scale, &mut positions, &mut hash, random);
                in_vain = if left.len() < before { 0 } else { in_vain + before };
                if in_vain > MAX_INSERTION_TRIES {
                    return None;
                }
            }
        }
        Some(positions)
    }

    /// Draws a position for each ball, in the order of the cells; the balls that have no room there.
    fn try_once(
        &self,
        balls: &[usize],
        radii: &[f64],
        scale: f64,
        positions: &mut [[f64; D]],
        hash: &mut Hash<D>,
        random: &mut ChaCha8Rng,
    ) -> Vec<usize> {
        let drawn: Vec<[f64; D]> = balls.iter().map(|&ball| self.anywhere(radii[ball], random)).collect();
        let mut left = Vec::new();
        for at in hash.in_order(drawn.iter().copied()) {
            let (ball, position) = (balls[at], drawn[at]);
            let radius = radii[ball] * scale;
            if self.clear_of_partition(&position, radii[ball]) && hash.is_clear(&position, radius) {
                hash.add(position, radius);
                positions[ball] = position;
            } else {
                left.push(ball);
            }
        }
        left
    }

    /// A position of the region where a ball is inside it.
    fn anywhere(&self, radius: f64, random: &mut ChaCha8Rng) -> [f64; D] {
        std::array::from_fn(|axis| {
            let margin = if self.repeats[axis] { 0.0 } else { radius };
            let (from, to) = (self.region[0][axis] + margin, self.region[1][axis] - margin);
            from + (to - from) * random.random::<f64>()
        })
    }

    fn clear_of_partition(&self, position: &[f64; D], radius: f64) -> bool {
        let partition = &self.setup.partition;
        partition.as_ref().is_none_or(|partition| (position[partition.axis] - partition.at).abs() >= radius)
    }

    /// Positions reached by growing; the packing at which that ended where it jams.
    fn grow(&self, radii: &[f64], packing: f64, random: &mut ChaCha8Rng) -> Result<Vec<[f64; D]>, f64> {
        let alike = self.obstacles().next().is_none() && radii.iter().all(|&radius| radius == radii[0]);
        if alike && radii.len() >= JAMMING_MIN_COUNT && packing > JAMMING_PACKING[D - 2] {
            return Err(JAMMING_PACKING[D - 2]);
        }
        let (scale, positions) = self.seeds(radii, packing, random)?;
        let mean = radii.iter().sum::<f64>() / radii.len() as f64;
        let field = Field {
            gravity: [0.0; D],
            scale,
            growth: GROWTH_SPEED[0] / mean,
            period: std::array::from_fn(|axis| if self.repeats[axis] { self.length()[axis] } else { 0.0 }),
            slide: Default::default(),
        };
        let mut world = self.dilute(radii, positions, field, random);
        world.walls = self.walls();
        world.wall_tallies = vec![Default::default(); world.walls.len()];
        let mut engine = Engine::new(world);
        let fluid = pow(FLUID_PACKING[D - 2] / packing, 1.0 / D as f64);
        for (speed, end) in [(GROWTH_SPEED[0], fluid.min(RADIUS_MARGIN)), (GROWTH_SPEED[1], RADIUS_MARGIN)] {
            set_growth(&mut engine, speed / mean);
            grow_to(&mut engine, end, mean).map_err(|reached| packing * reached.powi(D as i32))?;
        }
        settle(&mut engine).map_err(|reached| packing * reached.powi(D as i32))?;
        let mut grown = vec![[0.0; D]; radii.len()];
        for ball in 0..engine.world.balls.len() {
            let id = engine.world.records[ball].id as usize;
            if let Some(position) = grown.get_mut(id) {
                *position = engine.world.state(ball, engine.world.now).0;
            }
        }
        Ok(grown)
    }

    /// Radii over those in the end, and positions for balls of them; a packing for which there is no room.
    fn seeds(&self, radii: &[f64], packing: f64, random: &mut ChaCha8Rng) -> Result<(f64, Vec<[f64; D]>), f64> {
        let mut dropped = |seed: [f64; 2]| {
            let scale = pow(seed[D - 2] / packing, 1.0 / D as f64).min(SEED_RADIUS);
            self.drop_scaled(radii, scale, random).map(|positions| (scale, positions))
        };
        SEED_PACKINGS.into_iter().find_map(&mut dropped).ok_or(SEED_PACKINGS[1][D - 2])
    }

    /// The balls, small yet, at thermal speeds, and what is in their way.
    fn dilute(&self, radii: &[f64], positions: Vec<[f64; D]>, field: Field<D>, random: &mut ChaCha8Rng) -> World<D> {
        let mut kinds: Vec<Kind> = Vec::new();
        let mut kind = |radius: f64, mass: f64| {
            let known = kinds.iter().rposition(|kind| *kind == Kind { radius, mass });
            known.unwrap_or_else(|| {
                kinds.push(Kind { radius, mass });
                kinds.len() - 1
            }) as u32
        };
        let mut starts: Vec<Start<D>> = Vec::with_capacity(radii.len());
        for (&radius, position) in radii.iter().zip(positions) {
            let velocity = std::array::from_fn(|_| normal(random));
            starts.push(Start { position, velocity, kind: kind(radius, 1.0), species: 0 });
        }
        for placed in self.obstacles() {
            let kind = kind(placed.radius, IMMOVABLE_MASS);
            starts.push(Start { position: placed.position, velocity: [0.0; D], kind, species: 0 });
        }
        World::new(self.region[0], self.length(), kinds, &starts, field)
    }

    fn walls(&self) -> Vec<Wall> {
        let mut walls = Vec::new();
        for axis in (0..D).filter(|&axis| !self.repeats[axis]) {
            walls.push(Wall::fixed(axis, Facing::Up, self.region[0][axis]));
            walls.push(Wall::fixed(axis, Facing::Down, self.region[1][axis]));
        }
        if let Some(partition) = &self.setup.partition {
            walls.push(Wall::fixed(partition.axis, Facing::Both, partition.at));
        }
        walls
    }
}

/// Lets radii grow to `end` times those in the end; what is reached where that jams. `mean` is the mean radius in the end.
fn grow_to<const D: usize>(engine: &mut Engine<D>, end: f64, mean: f64) -> Result<(), f64> {
    loop {
        let Field { scale, growth, .. } = engine.world.field;
        if scale >= end {
            return Ok(());
        }
        let (path, collisions) = (engine.world.tally.path, engine.world.tally.collisions);
        let until = (end - scale) / growth;
        let pause = engine.run(until, u64::MAX);
        if pause == Pause::Reached {
            engine.world.now = until;
        }
        cool(engine);
        let flights = 2 * (engine.world.tally.collisions - collisions);
        let free = (engine.world.tally.path - path) / flights.max(1) as f64;
        let left = 2.0 * mean * (end - engine.world.field.scale);
        let jams = pause == Pause::WindowFull && flights > 0 && left > MAX_GAP_IN_FREE_PATHS * free;
        if pause == Pause::Standstill || jams {
            return Err(engine.world.field.scale);
        }
    }
}

/// Lets balls that are grown collide for a while; an error where they are jammed.
fn settle<const D: usize>(engine: &mut Engine<D>) -> Result<(), f64> {
    engine.world.kinds.iter_mut().for_each(|kind| kind.radius *= RADIUS_MARGIN);
    (engine.world.field.scale, engine.world.field.growth) = (1.0, 0.0);
    engine.rebuild();
    let enough = engine.world.tally.collisions + SETTLING_COLLISIONS * engine.world.balls.len() as u64 / 2;
    while engine.world.tally.collisions < enough {
        match engine.run(f64::INFINITY, EVENTS_PER_CHECK) {
            Pause::Worked => {}
            Pause::WindowFull => engine.rebuild(),
            Pause::Reached => break,
            Pause::Standstill => return Err(1.0),
        }
    }
    Ok(())
}

/// Goes on growing at another rate.
fn set_growth<const D: usize>(engine: &mut Engine<D>, growth: f64) {
    if growth != engine.world.field.growth {
        engine.world.field.growth = growth;
        engine.rebuild();
    }
}

/// Begins a new window with the balls at temperature 1: growing heats them.
fn cool<const D: usize>(engine: &mut Engine<D>) {
    engine.world.begin_window::<crate::world::Growing>();
    let world = &mut engine.world;
    let movable: Vec<usize> = (0..world.balls.len()).filter(|&ball| world.mass(ball) < IMMOVABLE_MASS).collect();
    let energy: f64 = movable.iter().map(|&ball| world.balls[ball].velocity.iter().map(|v| v * v).sum::<f64>()).sum();
    let factor = (D as f64 * movable.len() as f64 / energy).sqrt();
    for ball in movable {
        world.balls[ball].velocity = world.balls[ball].velocity.map(|v| v * factor);
    }
    engine.rebuild();
}

//! Making a gas from a set-up.

use super::{Gas, Plan};
use crate::SetupError;
use crate::engine::Engine;
use crate::measure::{Measures, Set};
use crate::method::{FixedStep, List, Mover};
use crate::setup::{Method, Placed, Region, Setup};
use crate::world::{CountedRegion, Field, Followed, Kind, Rebound, Slide, Start, World};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// The widest bar of a speed histogram ends at this many thermal speeds.
const FASTEST: f64 = 5.0;

impl<const D: usize> Gas<D> {
    pub(crate) fn new(setup: Setup<D>) -> Result<Self, SetupError> {
        let (starts, kinds, sets) = setup.starts()?;
        let mut world = World::new([0.0; D], setup.size, kinds, &starts, setup.field());
        world.rebound = Rebound { restitution: setup.restitution, contact_time: setup.contact_time() };
        world.random = ChaCha8Rng::seed_from_u64(setup.seed);
        world.random.set_stream(1);
        let mut plans = Vec::new();
        for (mut wall, schedule) in setup.walls() {
            let home = wall.position;
            let mut plan = schedule.map(|schedule| Plan { schedule, next: 0, home });
            if let Some(plan) = &mut plan {
                plan.start(&mut wall);
            }
            plans.push(plan);
            world.walls.push(wall);
        }
        world.wall_tallies = vec![Default::default(); world.walls.len()];
        world.followed = setup.followed(&starts);
        if let Some(well) = setup.well {
            world.dig_wells(well.depth, well.width);
        }
        let moves_momentum = setup.keeps_momentum_and_energy() || setup.shear.is_some();
        world.moments = moves_momentum.then(Default::default);
        let region = |region: &Region<D>| CountedRegion { from: region.from, to: region.to, virial: 0.0 };
        world.regions = setup.regions.iter().map(region).collect();
        let partition = setup.partition.is_some().then(|| world.walls.len() - 1);
        let largest = setup.largest_speeds(&sets, &world);
        let measures = Measures::new(&setup, sets.len(), largest);
        let mover = match setup.method {
            Method::EventDriven => Mover::EventDriven(Box::new(Engine::new(world))),
            Method::List => Mover::List(List::new(world)),
            Method::FixedStep(step) => Mover::FixedStep(FixedStep::new(world, step)),
        };
        let mut gas = Gas {
            setup,
            mover,
            sets,
            plans,
            partition,
            lifted: false,
            reversed: false,
            next_sample: 0,
            measures,
            initial: [0.0; 2],
            shown: 0.0,
            checked: (0.0, 0),
            si: false,
            live: Default::default(),
        };
        gas.initial = [gas.energy(), gas.momentum().iter().sum()];
        if let Some(temperature) = gas.setup.shear.and_then(|shear| shear.temperature) {
            gas.hold_temperature(Some(temperature)).map_err(|error| SetupError::Contradiction(error.to_string()))?;
        }
        Ok(gas)
    }
}

/// All balls at their positions, with velocities; the table of kinds; the sets.
type Contents<const D: usize> = (Vec<Start<D>>, Vec<Kind>, Vec<Set>);

impl Plan {
    /// Takes the knots that are at time 0.
    fn start(&mut self, wall: &mut crate::world::Wall) {
        while let Some(knot) = self.schedule.knot(self.next).filter(|knot| knot.time <= 0.0) {
            wall.position = self.home + knot.displacement;
            (wall.speed, wall.acceleration) = (knot.speed, knot.acceleration);
            self.next += 1;
        }
    }
}

impl<const D: usize> Setup<D> {
    /// What is in the box at the start.
    fn starts(&self) -> Result<Contents<D>, SetupError> {
        self.check()?;
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        let balls = self.placed(&mut random)?;
        self.check_overlaps(&balls)?;
        self.check_plans(&balls)?;
        self.check_pistons(&balls)?;
        let mut table = Table::default();
        let mut starts = Vec::with_capacity(balls.len());
        let mut at = balls.iter();
        let mut put = |name: &str, mass: f64, velocity: [f64; D], table: &mut Table| {
            let Some(&Placed { position, radius }) = at.next() else { return };
            let (kind, species) = (table.kind(radius, mass), table.set(name, mass));
            starts.push(Start { position, velocity, kind, species });
        };
        for ball in &self.balls {
            put(&ball.name, ball.mass, ball.velocity, &mut table);
        }
        for (species, velocities) in self.species.iter().zip(self.velocities(&mut random)) {
            for velocity in velocities {
                put(&species.name, species.mass, velocity, &mut table);
            }
        }
        if starts.is_empty() {
            return Err(SetupError::Contradiction("there are no balls".into()));
        }
        let field = self.field();
        for start in starts.iter_mut().filter(|_| field.is_sheared()) {
            start.velocity[0] += field.flow_at(0.0, start.position[1]);
        }
        Ok((starts, table.kinds, table.sets))
    }

    fn field(&self) -> Field<D> {
        let period = std::array::from_fn(|axis| if self.repeats_along(axis) { self.size[axis] } else { 0.0 });
        let speed = self.shear.map_or(0.0, |shear| shear.rate * self.size[1]);
        let slide = Slide { speed, displacement: 0.0 };
        Field { gravity: self.gravity, scale: 1.0, growth: 0.0, period, slide }
    }

    fn followed(&self, starts: &[Start<D>]) -> Option<Followed<D>> {
        let id = self.follow.filter(|&ball| ball < starts.len())?;
        Some(Followed { id: id as u32, collisions: 0, bends: vec![(0.0, starts[id].position)] })
    }

    /// Speeds up to which histograms go, for each set: some thermal speeds at the temperature of the whole.
    pub(super) fn largest_speeds(&self, sets: &[Set], world: &World<D>) -> Vec<f64> {
        let energy: f64 = (0..world.balls.len())
            .map(|ball| (world.mass(ball), world.thermal_velocity(ball, world.balls[ball].time)))
            .map(|(mass, velocity)| 0.5 * mass * velocity.iter().map(|v| v * v).sum::<f64>())
            .sum();
        let per_direction = 2.0 * (energy - self.energy_as_a_whole(world)) / (D * world.balls.len()) as f64;
        // Balls of one name may differ: the lightest are the fastest.
        let mut lightest: Vec<f64> = sets.iter().map(|set| set.mass).collect();
        for (ball, record) in world.records.iter().enumerate() {
            let least = &mut lightest[record.species as usize];
            *least = least.min(world.mass(ball));
        }
        lightest.iter().map(|mass| FASTEST * (per_direction / mass).sqrt().max(f64::MIN_POSITIVE)).collect()
    }

    /// Energy of the motion as a whole along the axes on which nothing changes it; 0 of one ball.
    fn energy_as_a_whole(&self, world: &World<D>) -> f64 {
        let balls = || 0..world.balls.len();
        let mass: f64 = balls().map(|ball| world.mass(ball)).sum();
        let velocity = |ball: usize| world.thermal_velocity(ball, world.balls[ball].time);
        let momentum = |axis: usize| balls().map(|ball| world.mass(ball) * velocity(ball)[axis]).sum::<f64>();
        let along = (0..D).filter(|axis| world.balls.len() > 1 && self.conserves_momentum(*axis));
        along.map(|axis| momentum(axis).powi(2)).sum::<f64>() / (2.0 * mass)
    }

    /// Distance up to which g(r) is counted.
    pub(crate) fn pair_distance(&self) -> f64 {
        let radii = self.balls.iter().map(|ball| ball.radius).chain(self.species.iter().map(|species| species.radius));
        let shortest = self.size.iter().copied().fold(f64::INFINITY, f64::min);
        self.measure.pair_distance.unwrap_or(10.0 * radii.fold(0.0, f64::max)).min(0.5 * shortest)
    }
}

/// Kinds and sets as they turn up.
#[derive(Default)]
struct Table {
    kinds: Vec<Kind>,
    sets: Vec<Set>,
}

impl Table {
    fn kind(&mut self, radius: f64, mass: f64) -> u32 {
        let kind = Kind { radius, mass };
        // Like balls come one after the other.
        let known = self.kinds.iter().rev().take(64).position(|known| *known == kind);
        let at = known.map_or(self.kinds.len(), |back| self.kinds.len() - 1 - back);
        if at == self.kinds.len() {
            self.kinds.push(kind);
        }
        at as u32
    }

    fn set(&mut self, name: &str, mass: f64) -> u32 {
        let known = self.sets.iter().position(|set| set.name == name);
        known.unwrap_or_else(|| {
            self.sets.push(Set { name: name.into(), mass, colour: None });
            self.sets.len() - 1
        }) as u32
    }
}

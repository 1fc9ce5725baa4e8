//! Frames, gauges and measures of a gas.

use super::Gas;
use crate::hash::Hash;
use crate::measure::estimate::{average, change, duration};
use crate::measure::transport::growth;
use crate::measure::{Estimate, Maxwell, Sample, Snapshot, mixing_entropy, p_value};
use crate::method::{Mover, Nearest};
use crate::world::{Moments, Well, speed};
use corpuscle_model::CompensatedSum;

/// Samples over which current values such as the pressure are averaged.
const RECENT: usize = 10;

/// Parts of the second half of the time, from which the error of a diffusion coefficient is found.
const DIFFUSION_PARTS: usize = 10;

/// Momentum of the whole over the sum of the balls' momenta above which a gas moves as a whole: more than rounding.
const LEAST_DRIFT: f64 = 1e-9;

impl<const D: usize> Gas<D> {
    /// The time shown, counted in the window.
    pub(super) fn now(&self) -> f64 {
        self.mover.world().in_window(self.shown)
    }

    /// Positions and velocities of all balls at the time shown, in order of their numbers; positions inside the box.
    pub fn states(&self) -> Vec<([f64; D], [f64; D])> {
        let world = self.mover.world();
        let mut states = vec![([0.0; D], [0.0; D]); world.balls.len()];
        for ball in 0..world.balls.len() {
            states[world.records[ball].id as usize] = world.state(ball, self.now());
        }
        states
    }

    /// Positions at the time shown as if the box did not repeat.
    pub fn unwrapped(&self) -> Vec<[f64; D]> {
        self.snapshot(self.shown).unwrapped
    }

    /// Number of balls.
    pub fn len(&self) -> usize {
        self.mover.world().balls.len()
    }

    /// Never true: a gas has at least one ball.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Names of the sets of balls: those given one by one, then the species.
    pub fn sets(&self) -> Vec<&str> {
        self.sets.iter().map(|set| set.name.as_str()).collect()
    }

    /// Radius and mass of a ball, by its number.
    pub fn body(&self, number: usize) -> (f64, f64) {
        let world = self.mover.world();
        let ball = world.records.iter().position(|record| record.id as usize == number).unwrap_or(0);
        (world.radius(ball), world.mass(ball))
    }

    /// Kinetic energy at the time shown.
    pub fn kinetic_energy(&self) -> f64 {
        let world = self.mover.world();
        let one = |ball| 0.5 * world.mass(ball) * speed(&world.state(ball, self.now()).1).powi(2);
        (0..world.balls.len()).map(one).collect::<CompensatedSum>().value()
    }

    /// Kinetic energy of the motion relative to the flow of a sheared box, at the time shown; else that of all motion.
    pub fn thermal_energy(&self) -> f64 {
        let world = self.mover.world();
        let one = |ball| 0.5 * world.mass(ball) * speed(&world.thermal_velocity(ball, self.now())).powi(2);
        (0..world.balls.len()).map(one).collect::<CompensatedSum>().value()
    }

    /// Momentum of the motion relative to the flow, at the time shown.
    fn thermal_momentum(&self) -> [f64; D] {
        let world = self.mover.world();
        std::array::from_fn(|axis| {
            let one = |ball| world.mass(ball) * world.thermal_velocity(ball, self.now())[axis];
            (0..world.balls.len()).map(one).collect::<CompensatedSum>().value()
        })
    }

    /// Kinetic and potential energy at the time shown.
    pub fn energy(&self) -> f64 {
        self.kinetic_energy() + self.potential_energy()
    }

    /// Energy in gravity and in square wells at the time shown.
    pub fn potential_energy(&self) -> f64 {
        let world = self.mover.world();
        let heights = |ball: usize| -> f64 {
            let position = world.unwrapped(ball, self.now());
            world.mass(ball) * (0..D).map(|axis| -world.field.gravity[axis] * position[axis]).sum::<f64>()
        };
        let raised =
            if world.falls() { (0..world.balls.len()).map(heights).collect::<CompensatedSum>().value() } else { 0.0 };
        raised + world.well.as_ref().map_or(0.0, Well::energy)
    }

    /// Number of pairs that are in their square wells; 0 without wells.
    pub fn pairs_in_wells(&self) -> u64 {
        self.mover.world().well.as_ref().map_or(0, Well::pairs)
    }

    /// Pairs that went into their square wells, out of them, and turned back at the rim, so far.
    pub fn rim_events(&self) -> [u64; 3] {
        let tally = self.mover.world().well.as_ref().map(|well| well.tally).unwrap_or_default();
        [tally.captures, tally.escapes, tally.returns]
    }

    /// Momentum at the time shown.
    pub fn momentum(&self) -> [f64; D] {
        let world = self.mover.world();
        std::array::from_fn(|axis| {
            (0..world.balls.len())
                .map(|ball| world.mass(ball) * world.state(ball, self.now()).1[axis])
                .collect::<CompensatedSum>()
                .value()
        })
    }

    /// Temperature at the time shown, from the motion relative to the mean velocity of all.
    pub fn temperature(&self) -> f64 {
        let world = self.mover.world();
        let mass: f64 = (0..world.balls.len()).map(|ball| world.mass(ball)).sum();
        let drift = self.drift_energy(&self.thermal_momentum(), mass);
        let freedom = self.setup.degrees_of_freedom(world.balls.len());
        2.0 * (self.thermal_energy() - drift) / (freedom * self.setup.boltzmann)
    }

    /// Energy of the motion as a whole along the axes on which nothing changes it.
    pub(super) fn drift_energy(&self, momentum: &[f64; D], mass: f64) -> f64 {
        let along = (0..D).filter(|axis| self.setup.conserves_momentum(*axis));
        along.map(|axis| momentum[axis] * momentum[axis]).sum::<f64>() / (2.0 * mass)
    }

    /// Velocity of the gas as a whole along the axes on which nothing changes it, from the velocities relative to the flow; 0 where it is no more
    /// than rounding, and of one ball.
    fn drift(&self, now: f64) -> [f64; D] {
        let world = self.mover.world();
        let (mut mass, mut momentum, mut magnitude) = (0.0, [0.0; D], 0.0);
        for ball in 0..world.balls.len() {
            let (own, velocity) = (world.mass(ball), world.thermal_velocity(ball, now));
            mass += own;
            magnitude += own * speed(&velocity);
            (0..D).for_each(|axis| momentum[axis] += own * velocity[axis]);
        }
        let drifts =
            |axis: usize| self.setup.conserves_momentum(axis) && momentum[axis].abs() > LEAST_DRIFT * magnitude;
        let is_gas = world.balls.len() > 1;
        std::array::from_fn(|axis| if is_gas && drifts(axis) { momentum[axis] / mass } else { 0.0 })
    }

    /// Centre of mass at the time shown, as if the box did not repeat.
    pub fn centre_of_mass(&self) -> [f64; D] {
        let (world, now) = (self.mover.world(), self.now());
        let masses: f64 = (0..world.balls.len()).map(|ball| world.mass(ball)).sum();
        std::array::from_fn(|axis| {
            let position = |ball: usize| world.unwrapped(ball, now)[axis];
            (0..world.balls.len()).map(|ball| world.mass(ball) * position(ball)).collect::<CompensatedSum>().value()
                / masses
        })
    }

    /// Area (in three dimensions volume) of the box at the time shown.
    pub fn volume(&self) -> f64 {
        self.mover.world().volume(self.now())
    }

    /// Part of the box that is filled with balls.
    pub fn packing(&self) -> f64 {
        let world = self.mover.world();
        (0..world.balls.len()).map(|ball| crate::ball_volume::<D>(world.radius(ball))).sum::<f64>() / self.volume()
    }

    /// Collisions of balls so far.
    pub fn collisions(&self) -> u64 {
        self.mover.world().tally.collisions
    }

    /// Work done on and heat given to the gas by walls and shear so far.
    pub fn work(&self) -> f64 {
        let world = self.mover.world();
        world.wall_tallies.iter().map(|tally| tally.energy()).sum::<f64>() + world.tally.shear.work()
    }

    /// Shear stress along x on planes across y, since averages began: what balls carry, relative to the flow, and exchange in collisions
    /// (Irving & Kirkwood, J. Chem. Phys. 18, 1950, 817), above 0 where it resists the shear. Not a number without shear.
    pub fn shear_stress(&self) -> Estimate {
        if self.setup.shear.is_none() {
            return Estimate { mean: f64::NAN, error: f64::NAN };
        }
        let volume = self.volume();
        let moved = |samples: &[Sample]| change(samples, |sample| sample.moments.momentum[0]) / duration(samples);
        self.measures.estimate(self.setup.measure.from, |samples| -moved(samples) / volume)
    }

    /// Height and mean velocity along x of layers of a sheared box, since averages began.
    pub fn flow_profile(&self) -> Vec<[f64; 2]> {
        self.measures.flow.as_ref().map_or_else(Vec::new, |flow| flow.profile([0.0, self.setup.size[1]]))
    }

    /// Position and velocity, at the time shown, of the lower (0) or upper (1) wall along an axis; none where the box repeats.
    pub fn wall(&self, axis: usize, end: usize) -> Option<[f64; 2]> {
        use crate::world::Facing::{Down, Up};
        let facing = if end == 0 { Up } else { Down };
        let world = self.mover.world();
        let wall = world.walls.iter().find(|wall| wall.axis == axis && wall.facing == facing)?;
        Some([wall.position_at(self.now()), wall.speed_at(self.now())])
    }

    /// Deepest overlap of two balls over the smallest radius of all, or of a ball and a wall over its own, at the time shown; 0 for
    /// none.
    pub fn deepest_overlap(&self) -> f64 {
        let world = self.mover.world();
        let (mut deepest, now) = (0.0_f64, self.now());
        let extents: [[f64; 2]; D] = std::array::from_fn(|axis| world.extent(axis, now));
        let largest = (0..world.balls.len()).map(|ball| world.radius(ball)).fold(0.0, f64::max);
        let length = extents.map(|[low, high]| high - low);
        let mut hash =
            Hash::new(extents.map(|[low, _]| low), length, world.field.period, 2.0 * largest, world.balls.len())
                .slid(world.field.slid_at(now));
        let smallest = world.kinds.iter().map(|kind| kind.radius).fold(f64::INFINITY, f64::min);
        for ball in 0..world.balls.len() {
            let (position, radius) = (world.state(ball, now).0, world.radius(ball));
            if let Some((_, depth)) = hash.overlap(&position, radius) {
                deepest = deepest.max(depth / smallest);
            }
            for axis in (0..D).filter(|&axis| world.field.period[axis] == 0.0) {
                let [low, high] = extents[axis];
                deepest = deepest.max((radius - (position[axis] - low).min(high - position[axis])) / radius);
            }
            hash.add(position, radius);
        }
        deepest
    }

    /// Overlaps and missed hits of the fixed-step method so far, and its deepest overlap over the smaller radius; none for the
    /// others, which make no such faults.
    pub fn faults(&self) -> Option<(u64, u64, f64)> {
        match &self.mover {
            Mover::FixedStep(steps) => Some((steps.faults.overlaps, steps.faults.missed, steps.faults.deepest)),
            _ => None,
        }
    }

    /// The list of the published method: the nearest event of each ball; none for the others.
    pub fn nearest(&self) -> Option<Vec<Nearest>> {
        let Mover::List(list) = &self.mover else { return None };
        let origin = list.world.origin.value();
        Some(list.nearest.iter().map(|event| Nearest { time: origin + event.time, ..*event }).collect())
    }

    /// Cell edges crossed and partners lost so far: what the event-driven method does besides collisions.
    pub fn side_events(&self) -> [u64; 2] {
        match &self.mover {
            Mover::EventDriven(engine) => [engine.crossings, engine.disturbed],
            _ => [0; 2],
        }
    }

    /// Bytes held for the balls and what is to come of them.
    pub fn bytes(&self) -> usize {
        self.mover.bytes()
    }

    /// The chance that speeds after Maxwell would deviate from his distribution by more than they do now (chi-square).
    pub fn maxwell_p_value(&self) -> f64 {
        let world = self.mover.world();
        let count = world.balls.len();
        let total: f64 = (0..count).map(|ball| world.mass(ball)).sum();
        let freedom = self.setup.degrees_of_freedom(count);
        // All axes, or their motion is not the same.
        let bound = freedom == (D * (count - 1)) as f64;
        let momentum = self.thermal_momentum();
        let along = |axis: usize| if self.setup.conserves_momentum(axis) { momentum[axis] / total } else { 0.0 };
        let drift: [f64; D] = std::array::from_fn(along);
        let energy = self.thermal_energy() - 0.5 * total * drift.iter().map(|v| v * v).sum::<f64>();
        let Some(first) = Maxwell::new(D, freedom, energy, world.mass(0), total, bound) else { return f64::NAN };
        p_value((0..count).map(|ball| {
            let mass = world.mass(ball);
            let own = Maxwell::new(D, freedom, energy, mass, total, bound).unwrap_or(first);
            let velocity = world.thermal_velocity(ball, self.now());
            let speed2 = (0..D).map(|axis| (velocity[axis] - drift[axis]).powi(2)).sum::<f64>();
            (speed2, own)
        }))
    }

    /// Entropy of mixing at the time shown, in units of Boltzmann's constant: N ln 2 for two equal parts fully mixed.
    pub fn mixing_entropy(&self) -> f64 {
        mixing_entropy(&self.snapshot(self.shown), self.sets.len())
    }

    /// Pressure from the virial of the collisions, since averages began: (2 kinetic energy + virial) / (dimensions x volume).
    pub fn pressure_virial(&self) -> Estimate {
        self.measures.estimate(self.setup.measure.from, pressure_virial::<D>)
    }

    /// Number of balls of each set.
    pub(super) fn counts(&self) -> Vec<usize> {
        let mut counts = vec![0; self.sets.len()];
        self.mover.world().records.iter().for_each(|record| counts[record.species as usize] += 1);
        counts
    }

    /// Kinetic energy of each set at the time shown.
    pub(super) fn energies(&self) -> Vec<f64> {
        let world = self.mover.world();
        self.energies_by(|ball| world.state(ball, self.now()).1)
    }

    /// The same of the motion relative to the flow of a sheared box and to the motion as a whole.
    pub(super) fn thermal_energies(&self) -> Vec<f64> {
        let world = self.mover.world();
        let drift = self.drift(self.now());
        self.energies_by(|ball| less(&world.thermal_velocity(ball, self.now()), &drift))
    }

    fn energies_by(&self, velocity: impl Fn(usize) -> [f64; D]) -> Vec<f64> {
        let world = self.mover.world();
        let mut sums = vec![0.0; self.sets.len()];
        for ball in 0..world.balls.len() {
            let squares: f64 = velocity(ball).iter().map(|v| v * v).sum();
            sums[world.records[ball].species as usize] += 0.5 * world.mass(ball) * squares;
        }
        sums
    }

    /// Radius of the balls, where all have the same.
    pub(super) fn only_radius(&self) -> Option<f64> {
        let kinds = &self.mover.world().kinds;
        kinds.windows(2).all(|pair| pair[0].radius == pair[1].radius).then(|| kinds[0].radius)
    }

    /// Pressure on a wall, the lower (0) or upper (1) along an axis, since averages began.
    pub fn pressure_on(&self, axis: usize, end: usize) -> Estimate {
        match self.facing(axis, end) {
            Some((wall, sign)) => {
                self.measures.estimate(self.setup.measure.from, |samples| sign * pressure_on(samples, wall))
            }
            None => Estimate { mean: f64::NAN, error: f64::NAN },
        }
    }

    /// Number of a wall, and the sign of the momentum that hits give it.
    fn facing(&self, axis: usize, end: usize) -> Option<(usize, f64)> {
        use crate::world::Facing::{Down, Up};
        let (facing, sign) = if end == 0 { (Up, -1.0) } else { (Down, 1.0) };
        let wall = self.mover.world().walls.iter().position(|wall| wall.axis == axis && wall.facing == facing)?;
        Some((wall, sign))
    }

    /// Pressure on a wall over some samples; none where there is no wall.
    pub(super) fn recent_pressure_on(&self, recent: &[Sample], axis: usize, end: usize) -> Option<f64> {
        let (wall, sign) = self.facing(axis, end)?;
        Some(if recent.len() > 1 { sign * pressure_on(recent, wall) } else { f64::NAN })
    }

    /// Pressure on all walls of the box together, since averages began; not a number without walls.
    pub fn pressure_walls(&self) -> Estimate {
        self.measures.estimate(self.setup.measure.from, |samples| self.pressure_walls_of(samples))
    }

    fn pressure_walls_of(&self, samples: &[Sample]) -> f64 {
        use crate::world::Facing;
        let outer = self.mover.world().walls.iter().enumerate().filter(|(_, wall)| wall.facing != Facing::Both);
        let (mut force, mut area) = (0.0, 0.0);
        for (number, wall) in outer {
            let sign = if wall.facing == Facing::Up { -1.0 } else { 1.0 };
            force += sign * change(samples, |sample| sample.walls[number]) / duration(samples);
            area += average(samples, |sample| sample.areas[number]);
        }
        force / area
    }

    /// P V / N k T since averages began.
    pub fn compressibility(&self) -> Estimate {
        let count = self.len() as f64;
        self.measures.estimate(self.setup.measure.from, |samples| {
            let thermal = count * self.setup.boltzmann * average(samples, |sample| sample.temperature);
            pressure_virial::<D>(samples) * average(samples, |sample| sample.volume) / thermal
        })
    }

    /// Collisions of a ball in a unit of time, since averages began.
    pub fn collision_rate(&self) -> Estimate {
        let count = self.len() as f64;
        self.measures.estimate(self.setup.measure.from, |samples| collision_rate(samples) / count)
    }

    /// Length of path between two collisions of a ball, since averages began.
    pub fn mean_free_path(&self) -> Estimate {
        if self.drifts_periodically() {
            return Estimate { mean: f64::NAN, error: f64::NAN };
        }
        self.measures.estimate(self.setup.measure.from, mean_free_path)
    }

    /// Mean-square displacement of a set since averages began: rows of time since then and value.
    pub fn mean_square_displacement(&self, set: usize) -> Vec<[f64; 2]> {
        let moving = self.measures.samples.iter().filter(|sample| !sample.displacement.is_empty());
        moving.map(|sample| [sample.time - self.measures.started, sample.displacement[set]]).collect()
    }

    /// Axes along which displacement is counted: not that along which a shear flow carries balls away.
    fn counted_axes(&self) -> usize {
        D - usize::from(self.setup.shear.is_some())
    }

    /// Diffusion coefficient of a set: slope of the second half of its mean-square displacement over 2 x dimensions (Einstein 1905). Its
    /// error is from slopes of parts of that half.
    pub fn diffusion(&self, set: usize) -> Estimate {
        let rows = self.mean_square_displacement(set);
        let late = &rows[rows.len() / 2..];
        let count = late.len() as f64;
        let mean = |part: usize| late.iter().map(|row| row[part]).sum::<f64>() / count;
        let (time, value) = (mean(0), mean(1));
        let above: f64 = late.iter().map(|row| (row[0] - time) * (row[1] - value)).sum();
        let below: f64 = late.iter().map(|row| (row[0] - time).powi(2)).sum();
        let parts = DIFFUSION_PARTS.min(late.len() - 1);
        let edge = |part: usize| late[part * (late.len() - 1) / parts];
        let slopes: Vec<f64> = (0..parts)
            .map(|part| (edge(part), edge(part + 1)))
            .map(|(start, end)| (end[1] - start[1]) / (end[0] - start[0]))
            .collect();
        Estimate { mean: above / below, error: Estimate::of(&slopes).error }
            .times(1.0 / (2 * self.counted_axes()) as f64)
    }

    /// Shear viscosity since averages began: in a sheared box stress over rate; else from the growth of Helfand's moments; not a number where walls, gravity or loss change momentum
    /// or energy, where the gas moves as a whole or its temperature is held, and before there are enough samples. In two dimensions it has
    /// no limit at late times.
    pub fn viscosity(&self) -> Estimate {
        if let Some(shear) = self.setup.shear {
            return self.shear_stress().times(1.0 / shear.rate);
        }
        let shears = Moments::shears(D);
        let growth = self.growth(|sample| {
            std::array::from_fn::<_, 3, _>(|k| if k < shears { sample.moments.momentum[k] } else { 0.0 })
        });
        // The mean is over three moments, of which there is one in two dimensions.
        growth.times(3.0 / shears as f64 / self.thermal_volume())
    }

    /// Thermal conductivity since averages began, as [`Gas::viscosity`]; not a number for balls of several masses, whose flow of heat depends
    /// on how it is told from their diffusion, and for balls with wells, whose potential energy is not counted in what they move.
    pub fn conductivity(&self) -> Estimate {
        if !self.measures_conductivity() {
            return Estimate { mean: f64::NAN, error: f64::NAN };
        }
        let growth = self.growth(|sample| sample.moments.energy);
        growth.times(3.0 / D as f64 / (self.thermal_volume() * self.mean_temperature()))
    }

    /// Whether viscosity and thermal conductivity are measured.
    pub(super) fn measures_transport(&self) -> bool {
        self.mover.world().moments.is_some()
    }

    pub(super) fn measures_conductivity(&self) -> bool {
        let world = self.mover.world();
        let one_mass = world.kinds.windows(2).all(|pair| pair[0].mass == pair[1].mass);
        self.measures_transport() && one_mass && world.well.is_none() && !world.field.is_sheared()
    }

    fn growth(&self, moments: impl Fn(&Sample) -> [f64; 3]) -> Estimate {
        let samples = self.measures.since_started();
        let held = self.live.thermostat.is_some();
        if samples.len() < 2 || !self.measures_transport() || held || self.drifts() {
            return Estimate { mean: f64::NAN, error: f64::NAN };
        }
        let collisions_per_time = collision_rate(samples) / self.len() as f64;
        growth(samples, self.setup.measure.lag_collisions / collisions_per_time, moments)
    }

    /// True where the gas moves as a whole along an axis on which nothing changes that: it flies farther than its heat alone makes it.
    pub(super) fn drifts_periodically(&self) -> bool {
        self.drift(self.now()) != [0.0; D]
    }

    /// True where the gas moves as a whole, and carries momentum and energy along.
    fn drifts(&self) -> bool {
        let world = self.mover.world();
        let magnitudes: f64 =
            (0..world.balls.len()).map(|ball| world.mass(ball) * speed(&world.balls[ball].velocity)).sum();
        speed(&self.momentum()) > LEAST_DRIFT * magnitudes
    }

    fn mean_temperature(&self) -> f64 {
        let samples = self.measures.since_started();
        if samples.len() < 2 { f64::NAN } else { average(samples, |sample| sample.temperature) }
    }

    /// Volume times temperature as an energy.
    fn thermal_volume(&self) -> f64 {
        self.volume() * self.setup.boltzmann * self.mean_temperature()
    }

    /// Distances and g there, since averages began.
    pub fn pair_distribution(&self) -> Vec<[f64; 2]> {
        self.measures.pairs.g::<D>()
    }

    /// Time and position of every bend of the followed ball's path so far, and where it is now.
    pub fn path(&self) -> Vec<(f64, [f64; D])> {
        let world = self.mover.world();
        let Some(followed) = &world.followed else { return Vec::new() };
        let mut path = followed.bends.clone();
        if let Some(ball) = world.records.iter().position(|record| record.id == followed.id) {
            path.push((self.shown, world.state(ball, self.now()).0));
        }
        path
    }

    /// The last samples and the time shown.
    pub(super) fn recent(&self) -> Vec<Sample> {
        let samples = &self.measures.samples;
        let mut recent = samples[samples.len().saturating_sub(RECENT)..].to_vec();
        recent.retain(|sample| sample.time < self.shown);
        recent.push(self.sample(self.shown));
        recent
    }

    /// Samples the gas at a time.
    pub(super) fn sample_measures(&mut self, time: f64) {
        let mut snapshot = self.snapshot(time);
        if self.sets.len() > 1 {
            snapshot.sample.mixing = mixing_entropy(&snapshot, self.sets.len());
        }
        snapshot.sample.beyond = self.beyond(&snapshot);
        self.measures.add(&snapshot, &self.setup.measure);
    }

    /// Balls of each set beyond the partition, or beyond where it was; empty without one.
    pub(super) fn beyond(&self, snapshot: &Snapshot<D>) -> Vec<f64> {
        let Some(partition) = &self.setup.partition else { return Vec::new() };
        let mut beyond = vec![0.0; self.sets.len()];
        for (position, &set) in snapshot.position.iter().zip(&snapshot.set) {
            if position[partition.axis] > partition.at {
                beyond[set as usize] += 1.0;
            }
        }
        beyond
    }

    fn sample(&self, time: f64) -> Sample {
        let world = self.mover.world();
        let now = world.in_window(time);
        let mut kinetic = CompensatedSum::default();
        let (mut mass, mut momentum) = (0.0, [0.0; D]);
        for ball in 0..world.balls.len() {
            let (own, velocity) = (world.mass(ball), world.thermal_velocity(ball, now));
            kinetic.add(0.5 * own * velocity.iter().map(|v| v * v).sum::<f64>());
            mass += own;
            for axis in 0..D {
                momentum[axis] += own * velocity[axis];
            }
        }
        let (kinetic, freedom) = (kinetic.value(), self.setup.degrees_of_freedom(world.balls.len()));
        let drift = self.drift_energy(&momentum, mass);
        let lengths: [f64; D] =
            std::array::from_fn(|axis| world.extent(axis, now)).map(|[low, high]: [f64; 2]| high - low);
        // Centres stay a radius away from walls.
        let radius = self.mean_radius();
        let open: [f64; D] =
            std::array::from_fn(|axis| lengths[axis] - if self.setup.repeats_along(axis) { 0.0 } else { 2.0 * radius });
        let area = |axis: usize| (0..D).filter(|&other| other != axis).map(|other| lengths[other]).product();
        Sample {
            time,
            temperature: 2.0 * (kinetic - drift) / (freedom * self.setup.boltzmann),
            kinetic: kinetic - drift,
            volume: lengths.iter().product(),
            open: open.iter().product(),
            collisions: world.tally.collisions,
            virial: world.tally.virial,
            path: world.path_at(now),
            moments: world.moments_at(now),
            walls: world.wall_tallies.iter().map(|tally| tally.momentum.value()).collect(),
            areas: world.walls.iter().map(|wall| area(wall.axis)).collect(),
            displacement: Vec::new(),
            mixing: f64::NAN,
            beyond: Vec::new(),
            regions: world.sample_regions(now),
        }
    }

    fn mean_radius(&self) -> f64 {
        let world = self.mover.world();
        (0..world.balls.len()).map(|ball| world.radius(ball)).sum::<f64>() / world.balls.len() as f64
    }

    pub(super) fn snapshot(&self, time: f64) -> Snapshot<D> {
        let world = self.mover.world();
        let now = world.in_window(time);
        let count = world.balls.len();
        let mut snapshot = Snapshot {
            sample: self.sample(time),
            position: vec![[0.0; D]; count],
            unwrapped: vec![[0.0; D]; count],
            velocity: vec![[0.0; D]; count],
            thermal: Vec::new(),
            drift: self.drift(now),
            slid: world.field.slid_at(now),
            set: vec![0; count],
            extent: std::array::from_fn(|axis| world.extent(axis, now)),
            period: world.field.period,
        };
        for (ball, record) in world.records.iter().enumerate() {
            let (position, velocity) = world.state(ball, now);
            let number = record.id as usize;
            snapshot.unwrapped[number] = world.unwrapped(ball, now);
            (snapshot.position[number], snapshot.velocity[number]) = (position, velocity);
            snapshot.set[number] = record.species;
        }
        if world.field.is_sheared() || snapshot.drift != [0.0; D] {
            snapshot.thermal = vec![[0.0; D]; count];
            for (ball, record) in world.records.iter().enumerate() {
                snapshot.thermal[record.id as usize] = less(&world.thermal_velocity(ball, now), &snapshot.drift);
            }
        }
        snapshot
    }
}

/// A velocity relative to another.
fn less<const D: usize>(velocity: &[f64; D], other: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|axis| velocity[axis] - other[axis])
}

/// Pressure from the virial between the first and the last of some samples.
pub(super) fn pressure_virial<const D: usize>(samples: &[Sample]) -> f64 {
    let kinetic = 2.0 * average(samples, |sample| sample.kinetic);
    let virial = change(samples, |sample| sample.virial) / duration(samples);
    (kinetic + virial) / (D as f64 * average(samples, |sample| sample.volume))
}

fn pressure_on(samples: &[Sample], wall: usize) -> f64 {
    change(samples, |sample| sample.walls[wall]) / duration(samples) / average(samples, |sample| sample.areas[wall])
}

/// Collisions' ends in a unit of time: two of each collision.
pub(super) fn collision_rate(samples: &[Sample]) -> f64 {
    2.0 * change(samples, |sample| sample.collisions as f64) / duration(samples)
}

pub(super) fn mean_free_path(samples: &[Sample]) -> f64 {
    change(samples, |sample| sample.path) / (2.0 * change(samples, |sample| sample.collisions as f64))
}

impl<const D: usize> Gas<D> {
    /// Pressure on the walls over the last samples.
    pub(super) fn recent_pressure_walls(&self, recent: &[Sample]) -> f64 {
        self.pressure_walls_of(recent)
    }
}

#[cfg(test)]
mod tests {
    use crate::{Amount, Setup, Species};
    use corpuscle_model::Model;
    use std::sync::atomic::AtomicBool;

    /// Sums over the balls of momentum along the first of two axes times position along the second, and of energy times position.
    fn sums(gas: &crate::Gas<3>) -> [f64; 6] {
        let mut sums = [0.0; 6];
        for (number, (position, velocity)) in gas.states().iter().enumerate() {
            let mass = gas.body(number).1;
            for (k, (a, b)) in [(0, 1), (0, 2), (1, 2)].into_iter().enumerate() {
                sums[k] += mass * velocity[a] * position[b];
            }
            let energy = 0.5 * mass * velocity.iter().map(|v| v * v).sum::<f64>();
            (0..3).for_each(|axis| sums[3 + axis] += energy * position[axis]);
        }
        sums
    }

    /// In a part of a box that no ball leaves the moments are what their definition says.
    #[test]
    fn moments_are_momentum_and_energy_times_position() {
        let region = Some([[40.0; 3], [44.0; 3]]);
        let heavy = Species { region, mass: 3.0, radius: 0.3, ..Species::new("heavy", Amount::Count(20)) };
        let setup = Setup::<3>::new([84.0; 3]).periodic().species(heavy);
        let light = Species { region, radius: 0.4, ..Species::new("light", Amount::Count(20)) };
        let mut gas = setup.species(light).seed(3).build().unwrap();
        let before = sums(&gas);
        for time in [0.5, 1.3, 4.0] {
            gas.advance_to(time, &AtomicBool::new(false)).unwrap();
            let moments = gas.mover.world().moments_at(gas.now());
            let found = [moments.momentum, moments.energy].concat();
            for (k, (now, before)) in sums(&gas).iter().zip(&before).enumerate() {
                assert!((now - before - found[k]).abs() < 1e-9, "{k} at {time}: {} and {}", now - before, found[k]);
            }
        }
        assert!(gas.collisions() > 20, "{}", gas.collisions());
    }
}

//! Balls that are put in and taken out while a gas runs.

use super::super::Gas;
use crate::hash::Hash;
use crate::random::normal;
use crate::world::{Ball, Facing, NONE, Record};
use corpuscle_model::ModelError;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Random positions tried for one ball before it is reported that there is no room.
const MAX_PLACEMENT_TRIES: u32 = 20_000;

/// Factor on radii, a little above 1, so that a gap remains between balls.
const RADIUS_MARGIN: f64 = 1.0 + 1e-9;

/// Random numbers of what is put in are another stream for each time; the first few are taken.
const FIRST_STREAM: u64 = 16;

impl<const D: usize> Gas<D> {
    /// Puts balls at free positions at random, like the others of their set, with velocities after Maxwell's law at the temperature now.
    pub(super) fn add_balls(&mut self, set: usize, count: usize) -> Result<(), ModelError> {
        let like = self.first_of(set)?;
        let temperature = self.temperature();
        let mut random = ChaCha8Rng::seed_from_u64(self.setup.seed);
        random.set_stream(FIRST_STREAM + self.live.added + self.live.removed);
        let kind = self.mover.world().balls[like].kind;
        let positions = self.free_positions(self.mover.world().radius(like), count, &mut random)?;
        self.come_to_now();
        self.mover.begin_window();
        let thermal = (self.setup.boltzmann * temperature / self.mover.world().mass(like)).sqrt();
        for position in positions {
            let mut velocity: [f64; D] = std::array::from_fn(|_| thermal * normal(&mut random));
            let world = self.mover.world_mut();
            if world.field.is_sheared() {
                velocity[0] += world.field.flow_at(world.low[1], position[1]);
            }
            let record = Record {
                id: world.balls.len() as u32,
                species: set as u32,
                image: [0; D],
                collided: f64::NEG_INFINITY,
            };
            world.balls.push(Ball { position, velocity, time: 0.0, kind, next: NONE });
            world.records.push(record);
            self.book_ball(self.len() - 1, 1.0);
            let pairs = self.mover.world_mut().dig_last_well();
            self.book_wells(pairs, 1.0);
        }
        self.live.added += count as u64;
        self.mover.begin_window();
        Ok(())
    }

    /// Takes balls out at random; one of the set stays, and the one that is followed by the scene.
    pub(super) fn remove_balls(&mut self, set: usize, count: usize) -> Result<(), ModelError> {
        self.first_of(set)?;
        let followed = self.mover.world().followed.as_ref().map(|followed| followed.id);
        let of_set = |record: &Record<D>| record.species as usize == set;
        let records = &self.mover.world().records;
        let all = records.iter().filter(|record| of_set(record)).count();
        let mut ids: Vec<u32> =
            records.iter().filter(|r| of_set(r) && Some(r.id) != followed).map(|record| record.id).collect();
        if count + 1 > all || count > ids.len() {
            let what =
                format!("{count} balls of {all} cannot be taken out: one must stay, and the one that is followed");
            return Err(ModelError::Setup(what));
        }
        self.come_to_now();
        self.mover.begin_window();
        let mut random = ChaCha8Rng::seed_from_u64(self.setup.seed);
        random.set_stream(FIRST_STREAM + self.live.added + self.live.removed);
        ids.sort_unstable();
        for _ in 0..count {
            let id = ids.swap_remove(random.random_range(0..ids.len()));
            let last = self.len() as u32 - 1;
            self.take_out(id, last);
            ids.iter_mut().filter(|other| **other == last).for_each(|other| *other = id);
        }
        self.live.removed += count as u64;
        self.mover.begin_window();
        Ok(())
    }

    /// Takes a ball out; the last gets its number, so that there is no gap.
    fn take_out(&mut self, id: u32, last: u32) {
        let found = self.mover.world().records.iter().position(|record| record.id == id);
        let Some(ball) = found else { return };
        self.book_ball(ball, -1.0);
        let world = self.mover.world_mut();
        let pairs = world.well.as_mut().map_or(0, |well| well.swap_remove(ball));
        world.balls.swap_remove(ball);
        world.records.swap_remove(ball);
        world.records.iter_mut().filter(|record| record.id == last).for_each(|record| record.id = id);
        if let Some(followed) = world.followed.as_mut().filter(|followed| followed.id == last) {
            followed.id = id;
        }
        self.book_wells(pairs, -1.0);
    }

    /// Books the potential energy of pairs in wells of a ball that is added (1) or removed (-1).
    fn book_wells(&mut self, pairs: usize, sign: f64) {
        let depth = self.mover.world().well.as_ref().map_or(0.0, |well| well.depth);
        self.live.book(-sign * depth * pairs as f64, 0.0);
    }

    /// A ball of a set.
    fn first_of(&self, set: usize) -> Result<usize, ModelError> {
        let found = self.mover.world().records.iter().position(|record| record.species as usize == set);
        found.ok_or_else(|| ModelError::Setup(format!("there is no set {set} of balls")))
    }

    /// Books energy and momentum of a ball that is added (1) or removed (-1).
    fn book_ball(&mut self, ball: usize, sign: f64) {
        let world = self.mover.world();
        let (mass, gravity) = (world.mass(ball), world.field.gravity);
        let Ball { position, velocity, .. } = world.balls[ball];
        let unwrapped =
            |axis: usize| position[axis] + f64::from(world.records[ball].image[axis]) * world.field.period[axis];
        let height: f64 = (0..D).map(|axis| -gravity[axis] * unwrapped(axis)).sum();
        let energy = sign * mass * (0.5 * velocity.iter().map(|v| v * v).sum::<f64>() + height);
        // The ledger counts gravity's push on all balls that there are from the start on.
        let pushed: f64 = gravity.iter().sum::<f64>() * world.time();
        let momentum = sign * mass * (velocity.iter().sum::<f64>() - pushed);
        self.live.book(energy, momentum);
    }

    /// Positions in the box where balls of a radius overlap nothing.
    fn free_positions(&self, radius: f64, count: usize, random: &mut ChaCha8Rng) -> Result<Vec<[f64; D]>, ModelError> {
        let world = self.mover.world();
        let largest = world.kinds.iter().map(|kind| kind.radius).fold(radius, f64::max);
        let balls = world.balls.len() + count;
        let extent: [[f64; 2]; D] = std::array::from_fn(|axis| world.extent(axis, self.now()));
        let (low, length) = (extent.map(|[low, _]| low), extent.map(|[low, high]| high - low));
        let mut hash = Hash::new(low, length, world.field.period, 2.0 * RADIUS_MARGIN * largest, balls)
            .slid(world.field.slid_at(self.now()));
        for number in 0..world.balls.len() {
            hash.add(world.state(number, self.now()).0, world.radius(number));
        }
        let anywhere = |random: &mut ChaCha8Rng| -> [f64; D] {
            std::array::from_fn(|axis| {
                let margin = if world.field.period[axis] > 0.0 { 0.0 } else { RADIUS_MARGIN * radius };
                low[axis] + margin + (length[axis] - 2.0 * margin).max(0.0) * random.random::<f64>()
            })
        };
        let divides = world.walls.iter().filter(|wall| wall.present && wall.facing == Facing::Both);
        let divides: Vec<_> = divides.map(|wall| (wall.axis, wall.position)).collect();
        let is_free = |position: &[f64; D], hash: &Hash<D>| {
            divides.iter().all(|&(axis, at)| (position[axis] - at).abs() > RADIUS_MARGIN * radius)
                && hash.is_clear(position, RADIUS_MARGIN * radius)
        };
        let mut positions = Vec::with_capacity(count);
        for _ in 0..count {
            let position = (0..MAX_PLACEMENT_TRIES).map(|_| anywhere(random)).find(|position| is_free(position, &hash));
            let none = || ModelError::Setup(format!("there is no room for {count} more balls"));
            let position = position.ok_or_else(none)?;
            hash.add(position, radius);
            positions.push(position);
        }
        Ok(positions)
    }
}

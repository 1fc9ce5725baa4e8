//! Keeping the whole state, to the bit, and taking it back.

use super::Gas;
use super::live_change::LiveTally;
use crate::engine;
use crate::measure::Measures;
use crate::method::{Faults, Mover};
use crate::world::{Ball, Moments, NONE, Record, Slide, Tally, Wall, WallTally, Well, World};
use corpuscle_model::CompensatedSum;
use corpuscle_model::ModelError;
use serde::{Deserialize, Serialize};

/// Everything that changes.
#[derive(Serialize, Deserialize)]
struct State {
    dimensions: usize,
    world: SavedWorld,
    method: SavedMethod,
    /// Knots of each wall's schedule that are done.
    knots: Vec<usize>,
    lifted: bool,
    reversed: bool,
    next_sample: u64,
    measures: Measures,
    initial: [f64; 2],
    shown: f64,
    checked: (f64, u64),
    live: LiveTally,
}

#[derive(Serialize, Deserialize)]
struct SavedWorld {
    position: Vec<f64>,
    velocity: Vec<f64>,
    time: Vec<f64>,
    kind: Vec<u32>,
    id: Vec<u32>,
    species: Vec<u32>,
    image: Vec<i32>,
    collided: Vec<f64>,
    walls: Vec<Wall>,
    low: Vec<f64>,
    length: Vec<f64>,
    now: f64,
    origin: CompensatedSum,
    tally: Tally,
    wall_tallies: Vec<WallTally>,
    standstill: u32,
    well: Option<Well>,
    slide: Slide,
    moments: Option<Moments>,
    random: u128,
    bends: Vec<(f64, Vec<f64>)>,
    /// Collisions of the followed ball.
    followed_collisions: u64,
    /// The virial of each region.
    regions: Vec<f64>,
}

#[derive(Serialize, Deserialize)]
enum SavedMethod {
    EventDriven(engine::Saved),
    List(u64),
    FixedStep(Faults),
}

impl<const D: usize> Gas<D> {
    pub(super) fn saved(&self) -> Vec<u8> {
        let method = match &self.mover {
            Mover::EventDriven(engine) => SavedMethod::EventDriven(engine.save()),
            Mover::List(list) => SavedMethod::List(list.handled()),
            Mover::FixedStep(steps) => SavedMethod::FixedStep(steps.faults),
        };
        let state = State {
            dimensions: D,
            world: SavedWorld::of(self.mover.world()),
            method,
            knots: self.plans.iter().map(|plan| plan.as_ref().map_or(0, |plan| plan.next)).collect(),
            lifted: self.lifted,
            reversed: self.reversed,
            next_sample: self.next_sample,
            measures: self.measures.clone(),
            initial: self.initial,
            shown: self.shown,
            checked: self.checked,
            live: self.live.clone(),
        };
        postcard::to_stdvec(&state).unwrap_or_default()
    }

    pub(super) fn take_back(&mut self, bytes: &[u8]) -> Result<(), ModelError> {
        let refused = |what: String| ModelError::Checkpoint(what);
        let state: State =
            postcard::from_bytes(bytes).map_err(|error| refused(format!("its bytes are damaged ({error})")))?;
        let other = || refused("it belongs to another scene".into());
        if state.dimensions != D || state.knots.len() != self.plans.len() {
            return Err(other());
        }
        // Balls may have been put in and taken out by live changes since the start.
        let at_the_start =
            |balls: usize, live: &LiveTally| (balls as u64).checked_add(live.removed)?.checked_sub(live.added);
        if at_the_start(self.len(), &self.live) != at_the_start(state.world.time.len(), &state.live) {
            return Err(other());
        }
        let (walls, regions) = (self.mover.world().walls.len(), self.mover.world().regions.len());
        let balls = state.world.time.len();
        if !state.measures.fit::<D>(&self.measures, walls, regions, balls) || !state.live.fits(walls) {
            return Err(other());
        }
        state.world.put_into(self.mover.world_mut(), self.sets.len()).ok_or_else(other)?;
        match (&mut self.mover, &state.method) {
            (Mover::EventDriven(engine), SavedMethod::EventDriven(saved)) => engine.restore(saved).ok_or_else(other)?,
            (Mover::List(list), SavedMethod::List(handled)) => {
                list.set_handled(*handled);
                list.find_all_events();
            }
            (Mover::FixedStep(steps), SavedMethod::FixedStep(faults)) => steps.faults = *faults,
            _ => return Err(other()),
        }
        for (plan, next) in self.plans.iter_mut().zip(state.knots) {
            if let Some(plan) = plan {
                plan.next = next;
            }
        }
        (self.lifted, self.reversed, self.next_sample) = (state.lifted, state.reversed, state.next_sample);
        (self.measures, self.initial, self.shown) = (state.measures, state.initial, state.shown);
        (self.checked, self.live) = (state.checked, state.live);
        // All that was due by then has been done: what is due again and again would be made up for, however often.
        if !self.shown.is_finite() || self.next_due().0 < self.shown {
            return Err(other());
        }
        Ok(())
    }
}

impl SavedWorld {
    fn of<const D: usize>(world: &World<D>) -> Self {
        let bends = world.followed.iter().flat_map(|followed| &followed.bends);
        SavedWorld {
            position: world.balls.iter().flat_map(|ball| ball.position).collect(),
            velocity: world.balls.iter().flat_map(|ball| ball.velocity).collect(),
            time: world.balls.iter().map(|ball| ball.time).collect(),
            kind: world.balls.iter().map(|ball| ball.kind).collect(),
            id: world.records.iter().map(|record| record.id).collect(),
            species: world.records.iter().map(|record| record.species).collect(),
            image: world.records.iter().flat_map(|record| record.image).collect(),
            collided: world.records.iter().map(|record| record.collided).collect(),
            walls: world.walls.clone(),
            low: world.low.to_vec(),
            length: world.length.to_vec(),
            now: world.now,
            origin: world.origin,
            tally: world.tally.clone(),
            wall_tallies: world.wall_tallies.clone(),
            standstill: world.standstill,
            well: world.well.clone(),
            slide: world.field.slide,
            moments: world.moments,
            random: world.random.get_word_pos(),
            bends: bends.map(|(time, position)| (*time, position.to_vec())).collect(),
            followed_collisions: world.followed.as_ref().map_or(0, |followed| followed.collisions),
            regions: world.regions.iter().map(|region| region.virial).collect(),
        }
    }

    /// `None` where it does not fit a world with balls of so many sets.
    fn put_into<const D: usize>(&self, world: &mut World<D>, sets: usize) -> Option<()> {
        let count = self.time.len();
        let singles = [self.kind.len(), self.id.len(), self.species.len(), self.collided.len()];
        let vectors = [self.position.len(), self.velocity.len(), self.image.len()];
        let fits = singles.iter().all(|&len| len == count)
            && vectors.iter().all(|&len| len == count * D)
            && self.walls.len() == world.walls.len()
            && self.wall_tallies.len() == world.walls.len()
            && self.regions.len() == world.regions.len()
            && self.slide.speed == world.field.slide.speed
            && self.well.is_some() == world.well.is_some()
            && self.well.as_ref().is_none_or(|well| well.fits(count))
            && self.walls.iter().zip(&world.walls).all(|(a, b)| a.axis == b.axis)
            && self.kind.iter().all(|&kind| (kind as usize) < world.kinds.len())
            && self.species.iter().all(|&set| (set as usize) < sets);
        let mut is_taken = vec![false; count];
        let is_free = |id: &u32| is_taken.get_mut(*id as usize).is_some_and(|taken| !std::mem::replace(taken, true));
        if !fits || !self.id.iter().all(is_free) {
            return None;
        }
        fn vector<T: Copy, const D: usize>(from: &[T], ball: usize) -> Option<[T; D]> {
            from.get(ball * D..(ball + 1) * D)?.try_into().ok()
        }
        let first = *world.balls.first()?;
        world.balls.resize(count, first);
        world.records.resize(count, world.records[0]);
        for ball in 0..count {
            world.balls[ball] = Ball {
                position: vector(&self.position, ball)?,
                velocity: vector(&self.velocity, ball)?,
                time: self.time[ball],
                kind: self.kind[ball],
                next: NONE,
            };
            world.records[ball] = Record {
                id: self.id[ball],
                species: self.species[ball],
                image: vector(&self.image, ball)?,
                collided: self.collided[ball],
            };
        }
        world.walls.clone_from(&self.walls);
        world.low = vector(&self.low, 0)?;
        world.length = vector(&self.length, 0)?;
        (world.now, world.origin, world.standstill) = (self.now, self.origin, self.standstill);
        world.moments = self.moments;
        world.well.clone_from(&self.well);
        world.field.slide = self.slide;
        world.tally = self.tally.clone();
        world.wall_tallies.clone_from(&self.wall_tallies);
        world.random.set_word_pos(self.random);
        world.regions.iter_mut().zip(&self.regions).for_each(|(region, virial)| region.virial = *virial);
        if let Some(followed) = &mut world.followed {
            followed.collisions = self.followed_collisions;
            followed.bends =
                self.bends.iter().filter_map(|(time, position)| Some((*time, vector(position, 0)?))).collect();
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setup::Setup;
    use corpuscle_model::Model;
    use std::sync::atomic::AtomicBool;

    /// A gas in steady shear at 1, with a sample each tenth.
    fn gas() -> Gas<2> {
        let mut gas = Setup::<2>::fluid(30, 0.3).shear(0.1, None).measured(0.0, 0.1).build().unwrap();
        gas.advance_to(1.0, &AtomicBool::new(false)).unwrap();
        gas
    }

    /// Whether a state is taken back after a change.
    fn is_taken_back(change: impl Fn(&mut State)) -> bool {
        let mut gas = gas();
        let mut state: State = postcard::from_bytes(&gas.saved()).unwrap();
        change(&mut state);
        gas.take_back(&postcard::to_stdvec(&state).unwrap()).is_ok()
    }

    #[test]
    fn a_state_that_cannot_be_gone_on_with_is_refused() {
        assert!(is_taken_back(|_| {}));
        // Samples were made up for one by one, until memory was full.
        assert!(!is_taken_back(|state| state.next_sample = 0));
        assert!(!is_taken_back(|state| state.shown = f64::NAN));
        assert!(!is_taken_back(|state| state.world.slide.displacement = 1e9));
        // A box too narrow for its balls ended the program.
        assert!(!is_taken_back(|state| state.world.length = vec![1.0, 1.0]));
    }
}

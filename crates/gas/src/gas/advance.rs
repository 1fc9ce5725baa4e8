//! Moving a gas on: events, and in between what happens by plan.

use super::{Due, Gas};
use crate::method::Mover;
use crate::pause::Pause;
use crate::world::Ball;
use corpuscle_model::{CompensatedSum, ModelError};
use std::sync::atomic::{AtomicBool, Ordering};

/// Events between two checks whether to stop.
const AT_A_TIME: u64 = 20_000;

/// Shortest mean path between two hits, over the radius, to which walls may press a gas together.
const LEAST_ROOM: f64 = 1e-3;

/// Shortest mean path between two hits, over the radius, of balls that lose energy. A pile at rest has none at all.
const LEAST_FLIGHT: f64 = 1e-5;

/// Events up to the requested time above which a gas is given up: at a million a second they take thirty years.
const MOST_EVENTS: f64 = 1e15;

impl<const D: usize> Gas<D> {
    /// Advances to `time`, or until `stop` is set.
    pub(super) fn advance(&mut self, time: f64, stop: &AtomicBool) -> Result<(), ModelError> {
        loop {
            let (when, due) = self.next_due();
            let reached = self.run_to(when.min(time), stop);
            if !matches!(reached, Ok(true)) {
                // After a breakdown too: shown at an earlier time, balls would go back along paths that hits have bent since.
                self.shown = self.shown.max(self.mover.world().time());
                return reached.map(|_| ());
            }
            if when > time {
                self.shown = time;
                return Ok(());
            }
            if let Some(due) = due {
                self.carry_out(when, due);
            }
            if stop.load(Ordering::Relaxed) {
                self.shown = self.shown.max(self.mover.world().time());
                return Ok(());
            }
        }
    }

    /// What happens by plan next, and when; of things at one time the first named here.
    pub(super) fn next_due(&self) -> (f64, Option<Due>) {
        let mut next = (f64::INFINITY, None);
        let mut offer = |time: f64, due: Due| {
            if time < next.0 {
                next = (time, Some(due));
            }
        };
        for (wall, plan) in self.plans.iter().enumerate() {
            if let Some(knot) = plan.as_ref().and_then(|plan| plan.schedule.knot(plan.next)) {
                offer(knot.time, Due::Knot(wall));
            }
        }
        if let Some(time) = self.setup.partition.as_ref().and_then(|partition| partition.lifted_at)
            && !self.lifted
        {
            offer(time, Due::Lift);
        }
        if let Some(time) = self.setup.reversed_at.filter(|_| !self.reversed) {
            offer(time, Due::Reverse);
        }
        self.live.due().for_each(|(time, due)| offer(time, due));
        if let Some(every) = self.setup.measure.every {
            offer(self.next_sample as f64 * every, Due::Sample);
        }
        next
    }

    /// Handles all events up to a time; false where `stop` was set before.
    fn run_to(&mut self, time: f64, stop: &AtomicBool) -> Result<bool, ModelError> {
        loop {
            let until = self.mover.world().in_window(time);
            match self.mover.run(until, AT_A_TIME) {
                Pause::Reached => return self.check_balls().map(|()| true),
                Pause::Worked => {}
                Pause::WindowFull => {
                    let (past, left) = (self.mover.world().now, until - self.mover.world().now);
                    self.mover.begin_window();
                    self.check()?;
                    self.check_pace(past, left)?;
                }
                Pause::Standstill => {
                    self.check_balls()?;
                    return Err(self.broken(
                        "collisions follow each other without anything moving: balls are squeezed between walls or jammed, \
                         or have come to rest on each other. Give them more room, stop the wall that closes in, or (with a \
                         restitution below 1) take a longer contact time",
                    ));
                }
            }
            if stop.load(Ordering::Relaxed) {
                return Ok(false);
            }
        }
    }

    /// Positions and velocities are finite.
    fn check_balls(&self) -> Result<(), ModelError> {
        let world = self.mover.world();
        if let Some(ball) = world.refused {
            let which = self.ball_in_words(ball);
            return Err(self.broken(&format!("the velocity of {which} after a collision would no longer be a number")));
        }
        let broken = |ball: &Ball<D>| {
            let named = [("position", &ball.position), ("velocity", &ball.velocity)];
            named.into_iter().find(|(_, vector)| !vector.iter().all(|along| along.is_finite())).map(|(name, _)| name)
        };
        let found = world.balls.iter().enumerate().find_map(|(number, ball)| Some((number, broken(ball)?)));
        let Some((number, quantity)) = found else { return Ok(()) };
        Err(self.broken(&format!("the {quantity} of {} is no longer a number", self.ball_in_words(number))))
    }

    /// A ball and its position, in words.
    fn ball_in_words(&self, ball: usize) -> String {
        let world = self.mover.world();
        let record = &world.records[ball];
        let set = self.sets.get(record.species as usize).map_or("", |set| set.name.as_str());
        format!("ball {} of `{set}` at {:.6?}", record.id, world.balls[ball].position)
    }

    /// Numbers are numbers, and the box can hold its balls.
    fn check(&mut self) -> Result<(), ModelError> {
        self.check_balls()?;
        let world = self.mover.world();
        for axis in 0..D {
            let [low, high] = world.extent(axis, world.now);
            if high <= low {
                return Err(self.broken("two walls have met: nothing is left of the box"));
            }
        }
        let Some(room) = self.room() else { return Ok(()) };
        let world = self.mover.world();
        if world.walls.iter().any(|wall| wall.moves) && room < LEAST_ROOM {
            return Err(self.broken(&format!(
                "walls that close in leave the balls hardly any room: between two hits they fly {room:.1e} of a radius, \
                 and would hit each other ever faster without end. Stop the wall earlier, or take fewer or smaller balls"
            )));
        }
        if world.rebound.restitution < 1.0 && room < LEAST_FLIGHT {
            return Err(self.broken(&format!(
                "the balls have come to rest on each other: between two hits they fly {room:.1e} of a radius. Collisions \
                 with loss that follow each other without end are a collapse. End before it, or take a longer contact time, \
                 less gravity or a restitution nearer to 1"
            )));
        }
        Ok(())
    }

    /// Some tens of events of each ball took the time `past`: those of the time `left` can be waited for.
    fn check_pace(&self, past: f64, left: f64) -> Result<(), ModelError> {
        let events = 10.0 * self.len() as f64 * left / past;
        // Where nothing moves at all, that is the reason to be named.
        if events > MOST_EVENTS && self.mover.world().standstill == 0 {
            return Err(self.broken(&format!(
                "balls hit each other so often that up to t = {} there would be about {events:.0e} collisions, too many to \
                 wait for. Ask for a shorter time, or for lower temperatures or fewer balls",
                self.mover.world().time() + left
            )));
        }
        Ok(())
    }

    /// Length of path between two hits of a ball since the last check, over the smallest radius; `None` where none was hit.
    fn room(&mut self) -> Option<f64> {
        let world = self.mover.world();
        let hits = world.wall_tallies.iter().map(|tally| tally.hits).sum::<u64>();
        let now = (world.tally.path, 2 * world.tally.collisions + hits);
        let (path, ends) = std::mem::replace(&mut self.checked, now);
        let radius = world.kinds.iter().map(|kind| kind.radius).fold(f64::INFINITY, f64::min);
        (now.1 > ends).then(|| (now.0 - path) / (now.1 - ends) as f64 / radius)
    }

    fn broken(&self, what: &str) -> ModelError {
        let world = self.mover.world();
        ModelError::Breakdown { time: world.time(), step: world.tally.collisions, what: what.into() }
    }

    fn carry_out(&mut self, time: f64, due: Due) {
        let moved = !matches!(self.mover, Mover::FixedStep(_));
        if moved && due != Due::Sample {
            let world = self.mover.world_mut();
            world.now = world.in_window(time);
        }
        match due {
            Due::Knot(wall) => self.bend_wall(wall, time),
            Due::Lift => {
                self.lift();
            }
            Due::Reverse => {
                self.reversed = true;
                self.reverse();
            }
            Due::Arrive(held) => self.arrive(held),
            Due::Regulate => self.regulate(),
            Due::Sample => {
                self.next_sample += 1;
                self.sample_measures(time);
            }
        }
    }

    /// The partition is taken away now.
    pub(super) fn lift(&mut self) {
        self.lifted = true;
        if let Some(number) = self.partition {
            let wall = &mut self.mover.world_mut().walls[number];
            (wall.present, wall.bends) = (false, wall.bends.wrapping_add(1));
            self.mover.wall_changed(number);
        }
    }

    /// A wall that moves by plan changes its motion.
    fn bend_wall(&mut self, wall: usize, time: f64) {
        let Some(plan) = &mut self.plans[wall] else { return };
        let Some(knot) = plan.schedule.knot(plan.next) else { return };
        plan.next += 1;
        let position = plan.home + knot.displacement;
        let world = self.mover.world_mut();
        let now = world.in_window(time);
        let moving = &mut world.walls[wall];
        moving.bend(now, knot.speed);
        (moving.position, moving.acceleration) = (position, knot.acceleration);
        self.mover.wall_changed(wall);
    }

    /// Turns all velocities round; walls' too that do not move by plan.
    fn reverse(&mut self) {
        self.mover.begin_window();
        let planned: Vec<bool> = self.plans.iter().map(Option::is_some).collect();
        let world = self.mover.world_mut();
        let momenta =
            (0..world.balls.len()).map(|ball| world.mass(ball) * world.balls[ball].velocity.iter().sum::<f64>());
        let turned = -2.0 * momenta.collect::<CompensatedSum>().value();
        self.live.momentum.add(turned);
        let world = self.mover.world_mut();
        world.reverse();
        let now = world.now;
        for (wall, planned) in world.walls.iter_mut().zip(planned) {
            if !planned && wall.moves {
                let speed = -wall.speed_at(now);
                wall.bend(now, speed);
            }
        }
        self.mover.begin_window();
    }
}

#[cfg(test)]
mod tests {
    use crate::{Amount, Gas, Method, Setup, Species};
    use corpuscle_model::Model;
    use std::sync::atomic::AtomicBool;

    const METHODS: [Method; 3] = [Method::EventDriven, Method::List, Method::FixedStep(0.001)];

    /// Amid a run.
    fn balls(method: Method) -> Gas<3> {
        let light = Species { radius: 0.4, ..Species::new("light", Amount::Count(20)) };
        let mut setup = Setup::<3>::new([8.0; 3]).species(light).seed(3);
        setup.method = method;
        let mut gas = setup.build().unwrap();
        advance(&mut gas, 0.5).unwrap();
        gas
    }

    fn advance(gas: &mut Gas<3>, time: f64) -> Result<(), corpuscle_model::ModelError> {
        gas.advance_to(time, &AtomicBool::new(false))
    }

    #[test]
    fn a_ball_that_is_no_longer_anywhere_ends_the_run_with_its_time_and_position() {
        for method in METHODS {
            for quantity in ["position", "velocity"] {
                let mut gas = balls(method);
                let ball = &mut gas.mover.world_mut().balls[4];
                let vector = if quantity == "position" { &mut ball.position } else { &mut ball.velocity };
                vector[1] = f64::NAN;
                let told = advance(&mut gas, 0.501).expect_err(quantity).to_string();
                for word in ["broke down at t = 0.", "ball ", "of `light` at ["] {
                    assert!(told.contains(word), "{method:?}, {quantity}, {word}: {told}");
                }
                assert!(told.contains(quantity) || told.contains("velocity"), "{told}");
            }
        }
    }

    /// By a mass or the temperature of a wall: what the event would have set is shown nowhere.
    #[test]
    fn an_event_that_gives_no_velocity_does_not_happen_and_ends_the_run() {
        type Break = fn(&mut Gas<3>);
        let breaks: [(&str, Break); 2] = [
            ("mass", |gas| gas.mover.world_mut().kinds.iter_mut().for_each(|kind| kind.mass = f64::NAN)),
            ("wall", |gas| {
                gas.mover.world_mut().walls.iter_mut().for_each(|wall| wall.temperature = Some(f64::NAN));
            }),
        ];
        for method in METHODS {
            for (what, break_it) in breaks {
                let mut gas = balls(method);
                break_it(&mut gas);
                let told = advance(&mut gas, 100.0).expect_err(what).to_string();
                let is_told = told.contains("ball ") && told.contains("of `light` at [") && !told.contains("NaN");
                assert!(is_told, "{method:?}, {what}: {told}");
                let frame = gas.frame();
                for set in &frame.sets {
                    let mut all = set.position.iter().chain(&set.velocity).flatten();
                    assert!(all.all(|along| along.is_finite()), "{method:?}, {what}");
                }
            }
        }
    }
}

//! Live changes of a gas: what is changed while it runs.

mod balls;
mod piston;
mod thermostat;

use super::{Due, Gas};
use crate::method::Mover;
use crate::world::{Facing, Wall};
use corpuscle_model::{CompensatedSum, ModelError};
use piston::Grip;
use serde::{Deserialize, Serialize};
use std::any::Any;
use thermostat::Thermostat;

/// A change of a gas that runs. Walls are named by their axis, 0 to 2, and end, 0 at the smaller coordinate and 1 at the larger.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum LiveChange {
    /// All velocities become so many times greater that the kinetic energy, and the temperature of a gas at rest, is this many times
    /// what it was; above 0.
    Heat(f64),
    /// The partition is taken away.
    LiftPartition,
    /// A thermal wall is held at another temperature, above 0.
    WallTemperature {
        /// The wall.
        wall: [usize; 2],
        /// Its temperature from now on.
        temperature: f64,
    },
    /// A piston is pressed by another pressure from outside, 0 or more.
    PistonPressure {
        /// The wall.
        wall: [usize; 2],
        /// The pressure from now on.
        pressure: f64,
    },
    /// A piston is taken hold of, dragged to a position, and held there.
    DragPiston {
        /// The wall.
        wall: [usize; 2],
        /// Where it is to be, m.
        to: f64,
    },
    /// A piston that is held is let go, at rest.
    LetPistonGo {
        /// The wall.
        wall: [usize; 2],
    },
    /// The temperature is held at this, above 0, by scaling the velocities from time to time; `None`: no longer.
    HoldTemperature(Option<f64>),
    /// Balls come in at free positions at random, like the others of their set, with velocities after Maxwell's law at the temperature now.
    AddBalls {
        /// The set, from 0.
        set: usize,
        /// How many.
        count: usize,
    },
    /// Balls of a set are taken out at random; one at least stays. The last balls get the numbers of those that have gone.
    RemoveBalls {
        /// The set, from 0.
        set: usize,
        /// How many.
        count: usize,
    },
}

impl LiveChange {
    /// Changes a model that is a gas, at the time shown. Averages over time start again.
    ///
    /// # Errors
    /// [`ModelError::Setup`] where it is none, has no such wall or partition, or the number is out of range: nothing has changed then.
    pub fn change(self, model: &mut dyn Any) -> Result<(), ModelError> {
        if let Some(gas) = model.downcast_mut::<Gas<2>>() {
            return gas.change_live(self);
        }
        match model.downcast_mut::<Gas<3>>() {
            Some(gas) => gas.change_live(self),
            None => Err(ModelError::Setup("this model is no gas".into())),
        }
    }
}

/// Energy and momentum that live changes added and removed, and the values that they hold.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct LiveTally {
    pub gained: CompensatedSum,
    pub lost: CompensatedSum,
    /// Sum of the components, with what the balls were given when all velocities were reversed.
    pub momentum: CompensatedSum,
    /// Balls put in and taken out.
    pub added: u64,
    pub removed: u64,
    /// Pistons that are held.
    pub grips: Vec<Grip>,
    /// What holds the temperature.
    pub thermostat: Option<Thermostat>,
}

impl LiveTally {
    /// Whether it is of a gas with so many walls.
    pub(super) fn fits(&self, walls: usize) -> bool {
        self.grips.iter().all(|grip| grip.wall() < walls)
            && self.thermostat.is_none_or(|thermostat| thermostat.goes_on())
    }
}

impl LiveTally {
    fn book(&mut self, energy: f64, momentum: f64) {
        if energy >= 0.0 {
            self.gained.add(energy)
        } else {
            self.lost.add(-energy)
        }
        self.momentum.add(momentum);
    }

    /// The next updates of held values, with their times.
    pub fn due(&self) -> impl Iterator<Item = (f64, Due)> {
        let grips = self.grips.iter().enumerate().map(|(held, grip)| (grip.arrives, Due::Arrive(held)));
        grips.chain(self.thermostat.map(|thermostat| (thermostat.next, Due::Regulate)))
    }
}

impl<const D: usize> Gas<D> {
    fn change_live(&mut self, change: LiveChange) -> Result<(), ModelError> {
        let positive = |value: f64, what: &str| match value.is_finite() && value > 0.0 {
            true => Ok(()),
            false => Err(ModelError::Setup(format!("{what} must be above 0, not {value}"))),
        };
        match change {
            LiveChange::Heat(factor) => {
                positive(factor, "the factor of the temperature")?;
                self.come_to_now();
                self.scale_energy(factor);
            }
            LiveChange::LiftPartition if self.partition.is_none() || self.lifted => {
                return Err(ModelError::Setup("there is no partition to be lifted".into()));
            }
            LiveChange::LiftPartition => {
                self.come_to_now();
                self.lift();
            }
            LiveChange::WallTemperature { wall, temperature } => {
                positive(temperature, "the temperature of a wall")?;
                let boltzmann = self.setup.boltzmann;
                let wall = self.wall_where(wall, "thermal wall", |wall| wall.temperature.is_some())?;
                self.mover.world_mut().walls[wall].temperature = Some(boltzmann * temperature);
            }
            LiveChange::PistonPressure { wall: [axis, end], pressure } => {
                if !(pressure.is_finite() && pressure >= 0.0) {
                    return Err(ModelError::Setup(format!("a pressure must be 0 or more, not {pressure}")));
                }
                let wall = self.piston([axis, end])?;
                if !self.press_held(wall, axis, pressure) {
                    self.press(wall, axis, pressure);
                }
            }
            LiveChange::DragPiston { wall, to } => self.drag(wall, to)?,
            LiveChange::LetPistonGo { wall } => self.let_go(wall)?,
            LiveChange::HoldTemperature(temperature) => {
                temperature.map_or(Ok(()), |temperature| positive(temperature, "a temperature"))?;
                self.hold_temperature(temperature)?;
            }
            LiveChange::AddBalls { set, count } => self.add_balls(set, count)?,
            LiveChange::RemoveBalls { set, count } => self.remove_balls(set, count)?,
        }
        self.begin_averages_anew();
        Ok(())
    }

    /// Number of the wall at an end of an axis that is of a kind.
    fn wall_where(&self, [axis, end]: [usize; 2], kind: &str, is: impl Fn(&Wall) -> bool) -> Result<usize, ModelError> {
        let facing = if end == 0 { Facing::Up } else { Facing::Down };
        let mut walls = self.mover.world().walls.iter();
        let found = walls.position(|wall| wall.axis == axis && wall.facing == facing && is(wall));
        found.ok_or_else(|| ModelError::Setup(format!("there is no {kind} at this end of the box")))
    }

    /// Events up to the time shown have happened: the clock comes to it. Equal steps stay at the step they are at.
    fn come_to_now(&mut self) {
        if !matches!(self.mover, Mover::FixedStep(_)) {
            let shown = self.shown;
            let world = self.mover.world_mut();
            world.now = world.in_window(shown);
        }
    }

    /// Scales all velocities now, relative to the flow of a sheared box, so that the kinetic energy is multiplied by a factor.
    fn scale_energy(&mut self, factor: f64) {
        // All balls are brought to the beginning of a window, and what is to come of them is found anew after it.
        self.mover.begin_window();
        let times = factor.sqrt();
        let world = self.mover.world_mut();
        let (mut energy, mut momentum) = (CompensatedSum::default(), CompensatedSum::default());
        for ball in 0..world.balls.len() {
            let mass = world.mass(ball);
            let height = world.balls[ball].position[1];
            let flow = if world.field.is_sheared() { world.field.flow_at(world.low[1], height) } else { 0.0 };
            for (axis, velocity) in world.balls[ball].velocity.iter_mut().enumerate() {
                let flow = if axis == 0 { flow } else { 0.0 };
                let before = std::mem::replace(velocity, flow + times * (*velocity - flow));
                energy.add(0.5 * mass * (*velocity * *velocity - before * before));
                momentum.add(mass * (*velocity - before));
            }
            world.note_bend(ball);
        }
        self.mover.begin_window();
        self.live.book(energy.value(), momentum.value());
    }

    /// A piston's acceleration is the pressure from outside on its area, over its mass, as where it was set up.
    fn press(&mut self, number: usize, axis: usize, pressure: f64) {
        self.come_to_now();
        let area = self.area_across(axis);
        let world = self.mover.world_mut();
        let now = world.now;
        let wall = &mut world.walls[number];
        let inward = if wall.facing == Facing::Up { 1.0 } else { -1.0 };
        let speed = wall.speed_at(now);
        wall.bend(now, speed);
        wall.acceleration = inward * pressure * area / wall.mass.unwrap_or(f64::INFINITY);
        self.mover.wall_changed(number);
    }

    /// Counts of speeds, profile and pairs are of what comes now.
    fn begin_averages_anew(&mut self) {
        let largest = self.setup.largest_speeds(&self.sets, self.mover.world());
        self.measures.begin_anew(&self.setup, largest);
    }
}

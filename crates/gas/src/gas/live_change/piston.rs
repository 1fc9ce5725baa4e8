//! Pistons that are held, dragged and let go while a gas runs.

use super::super::Gas;
use crate::world::Facing;
use corpuscle_model::ModelError;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Speed at which a piston is dragged, over the thermal speed of the balls: slow enough that the gas follows.
const DRAG_SPEED: f64 = 0.3;

/// Packing up to which a gas is compressed by dragging, in two and three dimensions: well below where balls jam.
const MAX_DRAG_PACKING: [f64; 2] = [0.6, 0.45];

/// A piston that is held.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Grip {
    wall: usize,
    /// Its mass when it is free.
    mass: f64,
    /// Its acceleration when it is free.
    acceleration: f64,
    /// When it is where it is to be, s; infinite where it is.
    pub arrives: f64,
    /// Where it is to be, m.
    to: f64,
}

impl Grip {
    /// The wall that is held.
    pub(crate) fn wall(&self) -> usize {
        self.wall
    }
}

impl<const D: usize> Gas<D> {
    /// Takes hold of a piston and drags it to a position, where it is held.
    pub(super) fn drag(&mut self, [axis, end]: [usize; 2], to: f64) -> Result<(), ModelError> {
        let number = self.piston([axis, end])?;
        self.check_room(axis, end, to)?;
        self.come_to_now();
        let energy = 2.0 * self.kinetic_energy() / (D as f64 * self.total_mass());
        let world = self.mover.world_mut();
        let (now, time) = (world.now, world.time());
        let wall = &mut world.walls[number];
        let displacement = to - wall.position_at(now);
        let speed = (DRAG_SPEED * energy.sqrt()).copysign(displacement);
        let held = self.live.grips.iter().position(|grip| grip.wall == number);
        let free = held.map(|held| self.live.grips.swap_remove(held));
        let mass = wall.mass.or(free.map(|free| free.mass)).unwrap_or(f64::INFINITY);
        let acceleration = free.map_or(wall.acceleration, |free| free.acceleration);
        let moves = speed != 0.0 && displacement != 0.0;
        wall.bend(now, if moves { speed } else { 0.0 });
        (wall.mass, wall.acceleration) = (None, 0.0);
        let arrives = if moves { time + displacement / speed } else { f64::INFINITY };
        self.live.grips.push(Grip { wall: number, mass, acceleration, arrives, to });
        self.mover.wall_changed(number);
        Ok(())
    }

    /// Lets a piston go, at rest: what presses it drives it again.
    pub(super) fn let_go(&mut self, [axis, end]: [usize; 2]) -> Result<(), ModelError> {
        let number = self.piston([axis, end])?;
        let Some(held) = self.live.grips.iter().position(|grip| grip.wall == number) else {
            return Err(ModelError::Setup("this piston is not held".into()));
        };
        let grip = self.live.grips.swap_remove(held);
        self.come_to_now();
        let world = self.mover.world_mut();
        let now = world.now;
        let wall = &mut world.walls[number];
        wall.bend(now, 0.0);
        (wall.mass, wall.acceleration) = (Some(grip.mass), grip.acceleration);
        self.mover.wall_changed(number);
        Ok(())
    }

    /// A piston that was dragged is where it was to be.
    pub(in super::super) fn arrive(&mut self, held: usize) {
        let Some(grip) = self.live.grips.get_mut(held) else { return };
        grip.arrives = f64::INFINITY;
        let (number, to) = (grip.wall, grip.to);
        let world = self.mover.world_mut();
        let now = world.now;
        let wall = &mut world.walls[number];
        wall.bend(now, 0.0);
        // Rounding must not push it into a ball.
        if (wall.position - to).abs() < 1e-9 * to.abs().max(1e-300) && wall.facing == Facing::Up {
            wall.position = wall.position.min(to);
        }
        self.mover.wall_changed(number);
    }

    /// The pressure from outside of a piston that is held, for when it is let go; false where it is not.
    pub(super) fn press_held(&mut self, number: usize, axis: usize, pressure: f64) -> bool {
        let area = self.area_across(axis);
        let facing = self.mover.world().walls[number].facing;
        let inward = if facing == Facing::Up { 1.0 } else { -1.0 };
        let held = self.live.grips.iter_mut().find(|grip| grip.wall == number);
        held.map(|grip| grip.acceleration = inward * pressure * area / grip.mass).is_some()
    }

    /// Number of the piston at an end of an axis, free or held.
    pub(super) fn piston(&self, [axis, end]: [usize; 2]) -> Result<usize, ModelError> {
        let held = |number: usize| self.live.grips.iter().any(|grip| grip.wall == number);
        let facing = if end == 0 { Facing::Up } else { Facing::Down };
        let walls = self.mover.world().walls.iter().enumerate();
        let mut at_end = walls.filter(|(_, wall)| wall.axis == axis && wall.facing == facing);
        let found = at_end.find(|(number, wall)| wall.mass.is_some() || held(*number));
        found
            .map(|(number, _)| number)
            .ok_or_else(|| ModelError::Setup("there is no piston at this end of the box".into()))
    }

    /// Refuses a position at which the balls would have too little room.
    fn check_room(&self, axis: usize, end: usize, to: f64) -> Result<(), ModelError> {
        let world = self.mover.world();
        let now = world.in_window(self.shown);
        let extent = world.extent(axis, now);
        let length = if end == 0 { extent[1] - to } else { to - extent[0] };
        let ball = |radius: f64| if D == 2 { PI * radius * radius } else { 4.0 / 3.0 * PI * radius.powi(3) };
        let filled: f64 = (0..world.balls.len()).map(|number| ball(world.radius(number))).sum();
        let widest = world.kinds.iter().map(|kind| 3.0 * kind.radius).fold(0.0, f64::max);
        let least = (filled / (MAX_DRAG_PACKING[D - 2] * self.area_across(axis))).max(widest);
        if to.is_finite() && length >= least {
            return Ok(());
        }
        Err(ModelError::Setup(format!(
            "a piston at {to} would leave the balls a length of {length:.4}: they need {least:.4} at least"
        )))
    }

    /// Area (in two dimensions length) across an axis.
    pub(super) fn area_across(&self, axis: usize) -> f64 {
        (0..D).filter(|&other| other != axis).map(|other| self.setup.size[other]).product()
    }

    fn total_mass(&self) -> f64 {
        let world = self.mover.world();
        (0..world.balls.len()).map(|ball| world.mass(ball)).sum()
    }
}

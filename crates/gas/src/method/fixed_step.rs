//! The old method: equal steps, after each of which all pairs are tested. Balls overlap, and pass through one another; both are
//! counted.

use crate::pause::Pause;
use crate::world::{Facing, Falling, Mode, Path, Quadratic, Straight, World};
use serde::{Deserialize, Serialize};

/// Errors of the method.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Faults {
    /// Pairs found overlapping, once for each step.
    pub overlaps: u64,
    /// Pairs that touched during a step and no longer did at its end.
    pub missed: u64,
    /// Deepest overlap so far, over the smaller radius.
    pub deepest: f64,
    /// Steps taken.
    pub steps: u64,
}

/// Balls that are moved in steps.
#[derive(Debug)]
pub(crate) struct FixedStep<const D: usize> {
    pub world: World<D>,
    pub faults: Faults,
    step: f64,
}

/// Steps before times are counted afresh.
const STEPS_PER_WINDOW: u64 = 4096;

impl<const D: usize> FixedStep<D> {
    pub fn new(world: World<D>, step: f64) -> Self {
        FixedStep { world, step, faults: Faults::default() }
    }

    /// Begins a new window now.
    pub fn begin_window(&mut self) {
        if self.world.falls() {
            self.world.begin_window::<Falling>();
        } else {
            self.world.begin_window::<Straight>();
        }
    }

    /// Takes whole steps up to `until` (in the window), `most` at most.
    pub fn run(&mut self, until: f64, most: u64) -> Pause {
        for _ in 0..most.div_ceil(self.world.balls.len().max(1) as u64) {
            if self.world.now + self.step > until {
                return Pause::Reached;
            }
            if self.world.falls() {
                self.step_as::<Falling>();
            } else {
                self.step_as::<Straight>();
            }
            if self.faults.steps.is_multiple_of(STEPS_PER_WINDOW) {
                return Pause::WindowFull;
            }
        }
        Pause::Worked
    }

    fn step_as<M: Mode>(&mut self) {
        let start = self.world.now;
        let before: Vec<Path<D>> = (0..self.world.balls.len())
            .map(|ball| self.world.field.state::<M>(&self.world.balls[ball], start))
            .map(|(position, velocity)| Path { position, velocity, time: start })
            .collect();
        self.world.now += self.step;
        self.faults.steps += 1;
        self.test_walls::<M>();
        self.test_pairs::<M>(&before);
    }

    /// Balls that a wall overlaps and that approach it rebound.
    fn test_walls<M: Mode>(&mut self) {
        let now = self.world.now;
        for ball in 0..self.world.balls.len() {
            for wall in 0..self.world.walls.len() {
                let meets = {
                    let world = &self.world;
                    world.walls[wall].meeting::<D, M>(&world.balls[ball], world.radius(ball), &world.field)
                };
                if meets <= now {
                    self.world.hit::<M>(ball, wall);
                    self.lift_out(ball, wall);
                }
            }
            for axis in 0..D {
                self.wrap::<M>(ball, axis);
            }
        }
    }

    /// A ball that went into a wall lies against it.
    fn lift_out(&mut self, ball: usize, wall: usize) {
        let world = &mut self.world;
        let (axis, position, radius) =
            (world.walls[wall].axis, world.walls[wall].position_at(world.now), world.radius(ball));
        let x = &mut world.balls[ball].position[axis];
        // Not by the larger of both: a position that is not a number must not become the wall's.
        match world.walls[wall].facing {
            Facing::Up if *x < position + radius => *x = position + radius,
            Facing::Down if *x > position - radius => *x = position - radius,
            _ => {}
        }
    }

    fn wrap<M: Mode>(&mut self, ball: usize, axis: usize) {
        let world = &mut self.world;
        if world.field.period[axis] > 0.0 {
            let position = world.field.state::<M>(&world.balls[ball], world.now).0[axis] - world.low[axis];
            let over = (position / world.length[axis]).floor();
            if over != 0.0 {
                world.wrap(ball, axis, over as i32);
            }
        }
    }

    /// Pairs that overlap and approach rebound; what was missed is counted.
    fn test_pairs<M: Mode>(&mut self, before: &[Path<D>]) {
        for a in 0..before.len() {
            for b in a + 1..before.len() {
                let world = &self.world;
                let reach = world.radius(a) + world.radius(b);
                let now = world.now;
                let (position_a, _) = world.field.state::<M>(&world.balls[a], now);
                let (position_b, _) = world.field.state::<M>(&world.balls[b], now);
                let mut apart: [f64; D] = std::array::from_fn(|axis| position_b[axis] - position_a[axis]);
                world.field.nearest(&mut apart);
                let apart2: f64 = apart.iter().map(|x| x * x).sum();
                if apart2 < reach * reach {
                    self.overlap::<M>(a, b, reach - apart2.sqrt());
                    continue;
                }
                let mut then: [f64; D] =
                    std::array::from_fn(|axis| before[b].position[axis] - before[a].position[axis]);
                let direct = then;
                world.field.nearest(&mut then);
                let offset = std::array::from_fn(|axis| then[axis] - direct[axis]);
                let exact = Quadratic::new::<D, M>(&before[a], &before[b], &offset, reach, &world.field);
                if exact.maybe_before::<M>(now) && exact.c > 0.0 && exact.root::<M>() <= now {
                    self.faults.missed += 1;
                }
            }
        }
    }

    fn overlap<M: Mode>(&mut self, a: usize, b: usize, depth: f64) {
        self.faults.overlaps += 1;
        self.faults.deepest = self.faults.deepest.max(depth / self.world.radius(a).min(self.world.radius(b)));
        let state = |ball: usize| self.world.field.state::<M>(&self.world.balls[ball], self.world.now);
        let ((position_a, velocity_a), (position_b, velocity_b)) = (state(a), state(b));
        let mut apart: [f64; D] = std::array::from_fn(|axis| position_b[axis] - position_a[axis]);
        self.world.field.nearest(&mut apart);
        let approach: f64 = (0..D).map(|axis| apart[axis] * (velocity_b[axis] - velocity_a[axis])).sum();
        if approach < 0.0 {
            self.world.collide::<M>(a, b);
        }
    }

    /// Bytes held for the balls.
    pub fn bytes(&self) -> usize {
        let each = size_of::<crate::world::Ball<D>>() + size_of::<crate::world::Record<D>>();
        self.world.balls.len() * each
    }
}

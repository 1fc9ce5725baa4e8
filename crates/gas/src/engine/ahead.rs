//! Prefetching of the memory of coming events.
//!
//! The next event is anywhere in the gas. In a large one its balls are in no cache, and each read waits for the one before it:
//! queue, event, partner, cells, balls in them. So events are followed through these stages some time before their turn, and what
//! they will need is prefetched. Results do not depend on it.

use super::Engine;
use super::event::Event;
use super::grid::Grid;
use crate::memory::prefetch;
use crate::world::{Ball, NONE};

/// Number of balls from which prefetching pays: fewer are found in a CPU's own cache (2 MiB is usual) often enough.
pub(super) const PREFETCH_MIN_BALLS: usize = 50_000;

/// Buckets behind the front that are prefetched. With too many, memory is evicted again before it is used.
const PREFETCHED_BUCKETS: u64 = 6;

/// Buckets from the one that is read to the one that is prefetched.
const PREFETCHED_CHUNKS: u64 = 8;

/// How many events later each stage follows on the one before it: memory needs that long.
const LAG: usize = 3;

/// Events kept; more than there are stages times [`LAG`].
const ROOM: usize = 16;

/// Neighbours kept of each event: the first balls of no more than 4 cells along each axis.
const NEAR: usize = 64;

/// An event to come.
#[derive(Debug, Clone, Copy)]
struct Coming {
    ball: u32,
    stamp: u32,
    /// The first balls in the cells that will be searched, and their number.
    near: [u32; NEAR],
    count: usize,
}

/// Coming events in the stages of the pipeline.
#[derive(Debug)]
pub(super) struct Ahead {
    coming: Box<[Coming; ROOM]>,
    /// How many have been found.
    found: usize,
    /// Number of the last bucket that was read.
    bucket: u64,
}

impl Ahead {
    pub fn new() -> Self {
        let none = Coming { ball: NONE, stamp: 0, near: [0; NEAR], count: 0 };
        Ahead { coming: Box::new([none; ROOM]), found: 0, bucket: 0 }
    }

    /// The event in a stage, if it is still to come.
    #[inline(always)]
    fn at_stage(&mut self, stage: usize) -> Option<&mut Coming> {
        let coming = &mut self.coming[self.found.wrapping_sub(stage * LAG) & (ROOM - 1)];
        (coming.ball != NONE).then_some(coming)
    }
}

impl<const D: usize> Engine<D> {
    /// Follows the events of the buckets that have come near since this was last called.
    #[inline(always)]
    pub(super) fn look_ahead(&mut self) {
        let Engine { queue, events, world, ahead, grid, .. } = self;
        let front = queue.front_bucket();
        ahead.bucket = ahead.bucket.max(front);
        while ahead.bucket < front + PREFETCHED_BUCKETS {
            ahead.bucket += 1;
            queue.ask_for_chunk(ahead.bucket + PREFETCHED_CHUNKS);
            queue.each_in(ahead.bucket, |ball, stamp| {
                let coming = &mut ahead.coming[ahead.found & (ROOM - 1)];
                (coming.ball, coming.stamp) = (ball, stamp);
                follow(ahead, events, &world.balls, grid);
                ahead.found += 1;
            });
        }
    }
}

/// Takes each event one stage further that is due for it.
#[inline(always)]
fn follow<const D: usize>(ahead: &mut Ahead, events: &[Event<D>], balls: &[Ball<D>], grid: &Grid<D>) {
    let ask_for = |ball: u32| {
        prefetch(&events[ball as usize]);
        prefetch(&balls[ball as usize]);
    };
    if let Some(coming) = ahead.at_stage(0) {
        ask_for(coming.ball);
    }
    if let Some(coming) = ahead.at_stage(1) {
        let event = &events[coming.ball as usize];
        if event.stamp != coming.stamp {
            coming.ball = NONE;
        } else if let Some(partner) = event.what.ball() {
            ask_for(partner as u32);
        }
    }
    if let Some(coming) = ahead.at_stage(2) {
        cells_around(grid, events, coming.ball, |cell| prefetch(&grid.heads[cell]));
    }
    if let Some(Coming { ball, near, count, .. }) = ahead.at_stage(3) {
        *count = 0;
        cells_around(grid, events, *ball, |cell| {
            let head = grid.heads[cell];
            near[*count & (NEAR - 1)] = head;
            *count += usize::from(head != NONE);
        });
        near[..*count].iter().for_each(|&ball| ask_for(ball));
    }
    if let Some(coming) = ahead.at_stage(4) {
        let next = coming.near[..coming.count].iter().map(|&ball| balls[ball as usize].next);
        next.filter(|&next| next != NONE).for_each(ask_for);
    }
}

/// Calls `visit` with the cells that touch those where a ball and its partner will be, and these themselves.
#[inline(always)]
fn cells_around<const D: usize>(grid: &Grid<D>, events: &[Event<D>], ball: u32, mut visit: impl FnMut(usize)) {
    let event = &events[ball as usize];
    let level = &grid.levels[event.level as usize];
    let (mut low, mut high) = (event.cell, event.cell);
    if let Some(partner) = event.what.ball() {
        let theirs = &events[partner];
        for axis in 0..D {
            let (a, b) = (event.cell[axis], theirs.cell[axis]);
            // A partner across a periodic side, or of another size, is skipped.
            if a.abs_diff(b) == 1 && theirs.level == event.level {
                (low[axis], high[axis]) = (a.min(b), a.max(b));
            }
        }
    } else if let Some((axis, up)) = event.what.as_edge() {
        let cell = if up { event.cell[axis] + 1 } else { event.cell[axis] - 1 };
        low[axis] = cell.clamp(1, level.count[axis]);
        high[axis] = low[axis];
    }
    let column = |axis: usize| &level.table[axis][low[axis] as usize - 1..high[axis] as usize + 2];
    for x in column(0) {
        for y in column(1) {
            if D == 2 {
                visit((x + y) as usize);
            } else {
                column(D - 1).iter().for_each(|z| visit((x + y + z) as usize));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Engine;
    use crate::pause::Pause;
    use crate::world::{Facing, Field, Kind, Start, Wall, World};

    /// Balls of diameter 1 or 0.4 on a lattice 1.1 wide, with velocities without order: parts of the multiples of irrational numbers
    /// (Weyl 1916). The box repeats along the last axis.
    fn world<const D: usize>(along: usize, gravity: f64) -> World<D> {
        let length = 1.1 * along as f64;
        let start = |number: usize| Start {
            position: std::array::from_fn(|axis| 1.1 * ((number / along.pow(axis as u32) % along) as f64 + 0.5)),
            velocity: std::array::from_fn(|axis| 2.0 * (number as f64 * [2_f64, 3.0, 5.0][axis].sqrt()).fract() - 1.0),
            kind: (number % 3 / 2) as u32,
            species: 0,
        };
        let starts: Vec<Start<D>> = (0..along.pow(D as u32)).map(start).collect();
        let mut field =
            Field { gravity: [0.0; D], scale: 1.0, growth: 0.0, period: [0.0; D], slide: Default::default() };
        (field.gravity[0], field.period[D - 1]) = (gravity, length);
        let kinds = vec![Kind { radius: 0.5, mass: 1.0 }, Kind { radius: 0.2, mass: 0.5 }];
        let mut world = World::new([0.0; D], [length; D], kinds, &starts, field);
        for axis in 0..D - 1 {
            world.walls.push(Wall::fixed(axis, Facing::Up, 0.0));
            world.walls.push(Wall::fixed(axis, Facing::Down, length));
        }
        world.wall_tallies = vec![Default::default(); world.walls.len()];
        world
    }

    /// All numbers of the balls after many windows, and the collisions.
    fn end<const D: usize>(along: usize, gravity: f64, prefetches: bool) -> (Vec<u64>, u64) {
        let mut engine = Engine::new(world::<D>(along, gravity));
        engine.prefetches = prefetches;
        engine.rebuild();
        let mut windows = 0;
        while windows < 4 {
            if engine.run(f64::INFINITY, u64::MAX) == Pause::WindowFull {
                engine.rebuild();
                windows += 1;
            }
        }
        let numbers = engine.world.balls.iter().flat_map(|ball| ball.position.into_iter().chain(ball.velocity));
        (numbers.map(f64::to_bits).collect(), engine.world.tally.collisions)
    }

    #[test]
    fn looking_ahead_changes_nothing() {
        for gravity in [0.0, -0.5] {
            assert!(end::<2>(20, gravity, true) == end::<2>(20, gravity, false));
            assert!(end::<3>(8, gravity, true) == end::<3>(8, gravity, false));
        }
        assert!(end::<3>(8, 0.0, true).1 > 2000);
    }
}

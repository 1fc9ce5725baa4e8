//! What happens next to a ball.

use super::Engine;
use super::event::{Event, What};
use super::near::{Near, ROOM};
use crate::world::{Ball, Field, Mode, NONE, Well, first_contact};

/// The earliest thing found so far.
#[derive(Debug, Clone, Copy)]
pub(super) struct Next {
    time: f64,
    what: What,
    partner_bends: u32,
}

impl<const D: usize> Engine<D> {
    /// Finds what happens next to a ball and queues it.
    #[inline(always)]
    pub(super) fn predict<M: Mode>(&mut self, ball: usize) {
        self.foresee::<M>(ball);
        let event = &self.events[ball];
        self.queue.push(event.time, ball as u32, event.stamp);
    }

    /// Finds what happens next to a ball.
    #[inline(always)]
    pub(super) fn foresee<M: Mode>(&mut self, ball: usize) {
        let next = self.next::<M>(ball);
        let event = &mut self.events[ball];
        event.time = next.time;
        event.what = next.what;
        event.partner_bends = next.partner_bends;
        event.stamp = event.stamp.wrapping_add(1);
    }

    #[inline(always)]
    fn next<M: Mode>(&mut self, ball: usize) -> Next {
        let event = self.events[ball];
        let mut next = Next { time: f64::INFINITY, what: What::NOTHING, partner_bends: 0 };
        self.cell_edges::<M>(ball, &event, &mut next);
        let level = &self.grid.levels[event.level as usize];
        let seam = level.at_seam(&self.grid.periodic, &event.cell) || self.grid.levels.len() > 1;
        if M::SHEARS && seam {
            self.neighbours_in_shear::<M>(ball, &mut next);
        } else if seam {
            self.neighbours::<M, true>(ball, &event, &mut next);
        } else {
            self.neighbours::<M, false>(ball, &event, &mut next);
        }
        if M::WELLS {
            self.bound_partners::<M>(ball, &mut next);
        }
        if !self.world.walls.is_empty() {
            self.walls::<M>(ball, &event, &mut next);
        }
        next.time = next.time.max(self.world.now);
        next
    }

    /// The edge of its cell that the ball crosses first.
    #[inline(always)]
    fn cell_edges<M: Mode>(&self, ball: usize, event: &Event<D>, next: &mut Next) {
        let level = &self.grid.levels[event.level as usize];
        let ball = &self.world.balls[ball];
        for axis in 0..D {
            let cell = event.cell[axis];
            let low = self.grid.low[axis] + f64::from(cell - 1) * level.size[axis];
            let high = self.grid.low[axis] + f64::from(cell) * level.size[axis];
            let open_up = self.grid.periodic[axis] | (cell < level.count[axis]);
            let open_down = self.grid.periodic[axis] | (cell > 1);
            let (time, up) = if M::FALLS && self.world.field.gravity[axis] != 0.0 {
                let (position, velocity) = self.world.field.state::<M>(ball, self.world.now);
                let (x, v, g) = (position[axis], velocity[axis], self.world.field.gravity[axis]);
                let climbs = if open_up { first_contact(high - x, -v, -g) } else { f64::INFINITY };
                let sinks = if open_down { first_contact(x - low, v, g) } else { f64::INFINITY };
                (self.world.now + climbs.min(sinks), climbs < sinks)
            } else {
                let v = ball.velocity[axis];
                let up = v > 0.0;
                let time = ball.time + (if up { high } else { low } - ball.position[axis]) / v;
                let open = (if up { open_up } else { open_down }) & (v != 0.0);
                (if open { time } else { f64::INFINITY }, up)
            };
            if time < next.time {
                *next = Next { time, what: What::edge(axis, up), partner_bends: 0 };
            }
        }
    }

    /// The ball that it meets first, of those in cells around it. With `WRAP`, some of them may be across periodic sides.
    #[inline(always)]
    fn neighbours<M: Mode, const WRAP: bool>(&mut self, ball: usize, event: &Event<D>, next: &mut Next) {
        let mut found = [0_u32; ROOM];
        let mut offsets = [[0.0; D]; ROOM];
        let mut count = 0;
        let level = &self.grid.levels[event.level as usize];
        let column = |axis: usize| -> [(u32, f64); 3] {
            let at = event.cell[axis] as usize;
            let table = &level.table[axis][at - 1..at + 2];
            let period = self.world.field.period[axis];
            let below = if WRAP && at == 1 { -period } else { 0.0 };
            let above = if WRAP && at == level.count[axis] as usize { period } else { 0.0 };
            [(table[0], below), (table[1], 0.0), (table[2], above)]
        };
        let heads = &self.grid.heads;
        let mut collect = |number: u32, offset: [f64; D]| {
            let head = heads[number as usize];
            found[count & (ROOM - 1)] = head;
            if WRAP {
                offsets[count & (ROOM - 1)] = offset;
            }
            count += usize::from(head != NONE);
        };
        let (xs, ys) = (column(0), column(1));
        if D == 2 {
            for x in xs {
                for y in ys {
                    collect(x.0 + y.0, std::array::from_fn(|axis| [x.1, y.1][axis & 1]));
                }
            }
        } else {
            let zs = column(D - 1);
            for x in xs {
                for y in ys {
                    for z in zs {
                        collect(x.0 + y.0 + z.0, std::array::from_fn(|axis| [x.1, y.1, z.1][axis]));
                    }
                }
            }
        }
        self.chains::<M, WRAP>(ball, &mut found, &mut offsets, count, next);
        if self.grid.levels.len() > 1 {
            self.other_levels::<M>(ball, event, next);
        }
    }

    /// Compares the ball with those at the heads of cells and all that follow them.
    #[inline(always)]
    pub(super) fn chains<M: Mode, const WRAP: bool>(
        &mut self,
        ball: usize,
        found: &mut [u32; ROOM],
        offsets: &mut [[f64; D]; ROOM],
        count: usize,
        next: &mut Next,
    ) {
        let Engine { world, events, near, alike, .. } = self;
        let (balls, kinds, field) = (&world.balls[..], &world.kinds[..], &world.field);
        let (events, near) = (&events[..], &mut **near);
        let me = &balls[ball];
        let radius = kinds[me.kind as usize].radius;
        let well = if M::WELLS { world.well.as_ref() } else { None };
        let mut count = count;
        let mut done = 0;
        while done < count {
            let other = &balls[found[done & (ROOM - 1)] as usize];
            let mut reach = radius + if *alike { radius } else { kinds[other.kind as usize].radius };
            if let Some(well) = well {
                reach *= well.width;
            }
            let offset = offsets[done & (ROOM - 1)];
            if M::SHEARS && offset[1] != 0.0 {
                near.set::<WRAP>(done, &field.image_above(other, offset[1].signum()), &offset, reach);
            } else {
                near.set::<WRAP>(done, other, &offset, reach);
            }
            done += 1;
            found[count & (ROOM - 1)] = other.next;
            if WRAP {
                offsets[count & (ROOM - 1)] = offset;
            }
            count += usize::from(other.next != NONE);
            if count == ROOM && done < count {
                nearest::<D, M, WRAP>(near, events, (ball, me), (field, well), &found[..done], next);
                found.copy_within(done..count, 0);
                if WRAP {
                    offsets.copy_within(done..count, 0);
                }
                (count, done) = (count - done, 0);
            }
        }
        nearest::<D, M, WRAP>(near, events, (ball, me), (field, well), &found[..done], next);
    }

    /// What happens first between the ball and those that are in a well with it.
    #[inline(always)]
    fn bound_partners<M: Mode>(&self, ball: usize, next: &mut Next) {
        let Some(well) = &self.world.well else { return };
        for &other in well.bound_to(ball) {
            let (time, rim) = self.world.next_in_well::<M>(well, ball, other as usize);
            offer(next, &self.events, other, time, rim);
        }
    }

    /// As [`Engine::neighbours`], among the balls of other sizes.
    #[cold]
    fn other_levels<M: Mode>(&mut self, ball: usize, event: &Event<D>, next: &mut Next) {
        let mut found = [0_u32; ROOM];
        let mut offsets = [[0.0; D]; ROOM];
        let mut count = 0;
        for level in 0..self.grid.levels.len() {
            if level == event.level as usize {
                continue;
            }
            let (low, high) = self.range(event, level);
            let mut cell = low;
            'cells: loop {
                let (head, offset) = self.head(level, &cell);
                if head != NONE {
                    (found[count], offsets[count]) = (head, offset);
                    count += 1;
                }
                if count == ROOM / 2 {
                    self.chains::<M, true>(ball, &mut found, &mut offsets, count, next);
                    count = 0;
                }
                for axis in 0..D {
                    cell[axis] += 1;
                    if cell[axis] <= high[axis] {
                        continue 'cells;
                    }
                    cell[axis] = low[axis];
                }
                break;
            }
        }
        self.chains::<M, true>(ball, &mut found, &mut offsets, count, next);
    }

    /// The first ball in a cell, which may be beyond the box where it repeats, and where the cell is from there.
    fn head(&self, level: usize, cell: &[i64; D]) -> (u32, [f64; D]) {
        let grid = &self.grid.levels[level];
        let (mut number, mut offset) = (0, [0.0; D]);
        for axis in 0..D {
            let mut within = cell[axis];
            if self.grid.periodic[axis] {
                let count = i64::from(grid.count[axis]);
                let images = (within - 1).div_euclid(count);
                within -= images * count;
                offset[axis] = images as f64 * self.world.field.period[axis];
            }
            number += grid.table[axis][within as usize];
        }
        (self.grid.heads[number as usize], offset)
    }

    /// First and last cell along each axis, in another level, of the neighbourhood in which a ball's pairs are searched.
    fn range(&self, event: &Event<D>, level: usize) -> ([i64; D], [i64; D]) {
        let mine = event.level as usize;
        let mut low = [0; D];
        let mut high = [0; D];
        for axis in 0..D {
            let cell = i64::from(event.cell[axis]) - 1;
            (low[axis], high[axis]) = if level > mine {
                let coarse = cell >> (level - mine);
                (coarse, coarse + 2)
            } else {
                let finer = mine - level;
                (((cell - 1) << finer) + 1, (cell + 2) << finer)
            };
            if !self.grid.periodic[axis] {
                low[axis] = low[axis].max(1);
                high[axis] = high[axis].min(i64::from(self.grid.levels[level].count[axis]));
            }
        }
        (low, high)
    }

    /// The wall that the ball hits first.
    #[inline(always)]
    fn walls<M: Mode>(&self, ball: usize, event: &Event<D>, next: &mut Next) {
        let level = &self.grid.levels[event.level as usize];
        let border = (0..D).any(|axis| (event.cell[axis] == 1) | (event.cell[axis] == level.count[axis]));
        if !border && !self.walls_roam {
            return;
        }
        let me = &self.world.balls[ball];
        let radius = self.world.kinds[me.kind as usize].radius;
        for (number, wall) in self.world.walls.iter().enumerate() {
            let time = wall.meeting::<D, M>(me, radius, &self.world.field);
            if time < next.time {
                *next = Next { time, what: What::wall(number), partner_bends: wall.bends };
            }
        }
    }
}

/// The first meeting of `me` with one of the balls in `near`.
///
/// A ball with an earlier event than the meeting is skipped: after that event it searches again. `me` is
/// among them, too, and does not meet itself; but a growing ball would, by the same formula.
#[inline(always)]
fn nearest<const D: usize, M: Mode, const WRAP: bool>(
    near: &mut Near<D>,
    events: &[Event<D>],
    (ball, me): (usize, &Ball<D>),
    (field, well): (&Field<D>, Option<&Well>),
    found: &[u32],
    next: &mut Next,
) {
    let mut met = near.compare::<M, WRAP>(found.len(), me, field, next.time);
    while met != 0 {
        let at = met.trailing_zeros() as usize;
        met &= met - 1;
        let (other, meets) = (found[at], near.meeting::<M>(at));
        if M::GROWS && other as usize == ball {
            continue;
        }
        // Pairs in their wells are searched by themselves.
        if M::WELLS && well.is_some_and(|well| well.are_bound(ball, other as usize)) {
            continue;
        }
        offer(next, events, other, meets, M::WELLS);
    }
}

/// Takes the event of a pair where it comes before what was found so far and before what its partner does next.
#[inline(always)]
fn offer<const D: usize>(next: &mut Next, events: &[Event<D>], other: u32, meets: f64, rim: bool) {
    if meets < next.time || (meets == next.time && next.what.ball().is_some_and(|rival| other < rival as u32)) {
        let theirs = &events[other as usize];
        if meets < theirs.time {
            *next = Next { time: meets, what: What::pair(other, rim), partner_bends: theirs.bends };
        }
    }
}

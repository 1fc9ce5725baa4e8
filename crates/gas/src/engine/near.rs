//! One ball compared with many.

use crate::world::{Ball, Field, Mode, Path, Quadratic};

/// How many balls are compared with one at a time, at most.
pub(crate) const ROOM: usize = 64;

/// How many numbers the compiler is invited to work on at once.
const LANES: usize = 8;

/// Balls near one, number by number, and what comes of comparing them with it.
#[derive(Debug)]
#[repr(C, align(64))]
pub(crate) struct Near<const D: usize> {
    position: [[f64; ROOM]; D],
    velocity: [[f64; ROOM]; D],
    /// From where a ball is to the image of it that is near.
    offset: [[f64; ROOM]; D],
    time: [f64; ROOM],
    reach: [f64; ROOM],
    /// Later of the two balls' times.
    start: [f64; ROOM],
    /// Half the rate of change of the distance squared at `start`.
    b: [f64; ROOM],
    /// Distance squared at `start`, less that at contact.
    c: [f64; ROOM],
    /// Relative speed squared.
    a: [f64; ROOM],
}

impl<const D: usize> Near<D> {
    pub fn new() -> Self {
        let zero = [0.0; ROOM];
        Near {
            position: [zero; D],
            velocity: [zero; D],
            offset: [zero; D],
            time: zero,
            reach: zero,
            start: zero,
            b: zero,
            c: zero,
            a: zero,
        }
    }

    #[inline(always)]
    pub fn set<const WRAP: bool>(&mut self, at: usize, ball: &Ball<D>, offset: &[f64; D], reach: f64) {
        let at = at & (ROOM - 1);
        for axis in 0..D {
            self.position[axis][at] = ball.position[axis];
            self.velocity[axis][at] = ball.velocity[axis];
            if WRAP {
                self.offset[axis][at] = offset[axis];
            }
        }
        self.time[at] = ball.time;
        self.reach[at] = reach;
    }

    /// Compares the first `count` balls with `me`; a bit is set for each that is met, perhaps, before `limit`. With `WRAP`,
    /// in the given images.
    #[inline(always)]
    pub fn compare<M: Mode, const WRAP: bool>(
        &mut self,
        count: usize,
        me: &Ball<D>,
        field: &Field<D>,
        limit: f64,
    ) -> u64 {
        let mine = Path { position: me.position, velocity: me.velocity, time: me.time };
        let mut met = 0;
        for block in 0..count.div_ceil(LANES) {
            let mut maybe = [false; LANES];
            for (lane, maybe) in maybe.iter_mut().enumerate() {
                let at = (block * LANES + lane) & (ROOM - 1);
                let position: [f64; D] = std::array::from_fn(|axis| self.position[axis][at]);
                let velocity: [f64; D] = std::array::from_fn(|axis| self.velocity[axis][at]);
                let offset = std::array::from_fn(|axis| if WRAP { self.offset[axis][at] } else { 0.0 });
                let other = Path { position, velocity, time: self.time[at] };
                let quadratic = Quadratic::new::<D, M>(&mine, &other, &offset, self.reach[at], field);
                *maybe = quadratic.maybe_before::<M>(limit);
                (self.start[at], self.a[at], self.b[at], self.c[at]) =
                    (quadratic.start, quadratic.a, quadratic.b, quadratic.c);
            }
            let bits = maybe.iter().enumerate().fold(0_u64, |bits, (lane, &maybe)| bits | u64::from(maybe) << lane);
            met |= bits << ((block * LANES) & (ROOM - 1));
        }
        if count < ROOM { met & ((1 << count) - 1) } else { met }
    }

    /// When a ball for which [`Near::compare`] set a bit is met.
    #[inline(always)]
    pub fn meeting<M: Mode>(&self, at: usize) -> f64 {
        let at = at & (ROOM - 1);
        Quadratic { start: self.start[at], a: self.a[at], b: self.b[at], c: self.c[at] }.root::<M>()
    }
}

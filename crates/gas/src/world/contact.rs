//! When balls meet.
//!
//! The moment at which two balls meet is counted from the later of their own times. So it depends only on their two
//! paths, not on when it is computed: every method finds the same moments, to the bit. (Where the box repeats, to rounding
//! errors: a path is measured from the image of the box where the ball is.)

use super::ball::Ball;
use super::shear::Slide;

/// What bends paths between collisions, whether balls grow, and whether they have wells. Known when the program is compiled, so that what is absent costs nothing.
pub(crate) trait Mode: Copy {
    /// Balls fall.
    const FALLS: bool;
    /// Balls grow (only while a start state is made).
    const GROWS: bool;
    /// Balls have square wells.
    const WELLS: bool = false;
    /// The box is sheared.
    const SHEARS: bool = false;
}

/// Straight paths.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Straight;
impl Mode for Straight {
    const FALLS: bool = false;
    const GROWS: bool = false;
}

/// Paths bent by gravity.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Falling;
impl Mode for Falling {
    const FALLS: bool = true;
    const GROWS: bool = false;
}

/// Straight paths of growing balls.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Growing;
impl Mode for Growing {
    const FALLS: bool = false;
    const GROWS: bool = true;
}

/// As another mode, of balls with square wells.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Welled<M>(std::marker::PhantomData<M>);
impl<M: Mode> Mode for Welled<M> {
    const FALLS: bool = M::FALLS;
    const GROWS: bool = M::GROWS;
    const WELLS: bool = true;
}

/// Straight paths in a sheared box.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sheared;
impl Mode for Sheared {
    const FALLS: bool = false;
    const GROWS: bool = false;
    const SHEARS: bool = true;
}

/// The modes, by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Motion {
    Straight,
    Falling,
    Growing,
    Welled,
    WelledFalling,
    Sheared,
}

/// Does something with the [`Mode`] of a [`Motion`].
macro_rules! in_mode {
    ($motion:expr, $mode:ident => $something:expr) => {{
        use crate::world::{Falling, Growing, Motion, Sheared, Straight, Welled};
        macro_rules! of {
            ($own:ty) => {{
                type $mode = $own;
                $something
            }};
        }
        match $motion {
            Motion::Straight => of!(Straight),
            Motion::Falling => of!(Falling),
            Motion::Growing => of!(Growing),
            Motion::Welled => of!(Welled<Straight>),
            Motion::WelledFalling => of!(Welled<Falling>),
            Motion::Sheared => of!(Sheared),
        }
    }};
}
pub(crate) use in_mode;

/// Fields that act on all balls equally.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Field<const D: usize> {
    pub gravity: [f64; D],
    /// Radii over those in the table at time 0 of the window, and how fast they grow.
    pub scale: f64,
    pub growth: f64,
    /// The box's length along each axis, for the nearest image across periodic sides; 0 where the box does not repeat.
    pub period: [f64; D],
    /// How the image above slides, in a sheared box.
    pub slide: Slide,
}

impl<const D: usize> Field<D> {
    /// Position and velocity of a ball at a time.
    #[inline(always)]
    pub fn state<M: Mode>(&self, ball: &Ball<D>, time: f64) -> ([f64; D], [f64; D]) {
        let since = time - ball.time;
        let mut position: [f64; D] = std::array::from_fn(|axis| ball.position[axis] + ball.velocity[axis] * since);
        let mut velocity = ball.velocity;
        if M::FALLS {
            for axis in 0..D {
                position[axis] += 0.5 * self.gravity[axis] * since * since;
                velocity[axis] += self.gravity[axis] * since;
            }
        }
        (position, velocity)
    }

    /// Takes off whole periods, so that a difference of positions is the shortest.
    #[inline(always)]
    pub fn nearest(&self, apart: &mut [f64; D]) {
        for axis in 0..D {
            if self.period[axis] > 0.0 {
                apart[axis] -= self.period[axis] * (apart[axis] / self.period[axis]).round_ties_even();
            }
        }
    }

    /// Radii over those in the table at a time.
    #[inline(always)]
    pub fn scale_at<M: Mode>(&self, time: f64) -> f64 {
        if M::GROWS { self.scale + self.growth * time } else { 1.0 }
    }
}

/// A ball's path.
pub(crate) struct Path<const D: usize> {
    pub position: [f64; D],
    pub velocity: [f64; D],
    pub time: f64,
}

/// The distance squared of two balls, less that at contact: a t^2 + 2 b t + c from `start` on.
pub(crate) struct Quadratic {
    pub start: f64,
    pub a: f64,
    pub b: f64,
    pub c: f64,
}

/// The later of two balls' times, and then the line from one to an image of the other, and its rate of change.
#[inline(always)]
fn relative<const D: usize, M: Mode>(
    a: &Path<D>,
    b: &Path<D>,
    offset: &[f64; D],
    field: &Field<D>,
) -> (f64, [f64; D], [f64; D]) {
    let start = if a.time > b.time { a.time } else { b.time };
    let (since_a, since_b) = (start - a.time, start - b.time);
    let mut apart = [0.0; D];
    let mut approach = [0.0; D];
    for axis in 0..D {
        let mut position_a = a.position[axis] + a.velocity[axis] * since_a;
        let mut position_b = b.position[axis] + b.velocity[axis] * since_b;
        approach[axis] = b.velocity[axis] - a.velocity[axis];
        if M::FALLS {
            let gravity = field.gravity[axis];
            position_a += 0.5 * gravity * since_a * since_a;
            position_b += 0.5 * gravity * since_b * since_b;
            approach[axis] = (b.velocity[axis] + gravity * since_b) - (a.velocity[axis] + gravity * since_a);
        }
        apart[axis] = (position_b - position_a) + offset[axis];
    }
    (start, apart, approach)
}

/// The rate of change of a line times itself, the line times that rate, and the line times itself.
#[inline(always)]
fn products<const D: usize>(apart: &[f64; D], approach: &[f64; D]) -> [f64; 3] {
    let mut products = [0.0; 3];
    for axis in 0..D {
        products[0] += approach[axis] * approach[axis];
        products[1] += apart[axis] * approach[axis];
        products[2] += apart[axis] * apart[axis];
    }
    products
}

impl Quadratic {
    /// Of the image of `b` that is `offset` from where `b` is. It must be given: when the counting starts, balls that meet after
    /// long ways across a periodic box may be nearest in other images.
    #[inline(always)]
    pub fn new<const D: usize, M: Mode>(
        a: &Path<D>,
        b: &Path<D>,
        offset: &[f64; D],
        reach: f64,
        field: &Field<D>,
    ) -> Self {
        let (start, apart, approach) = relative::<D, M>(a, b, offset, field);
        let [mut a, mut b, apart2] = products(&apart, &approach);
        let mut reach = reach;
        if M::GROWS {
            let growth = reach * field.growth;
            reach *= field.scale_at::<M>(start);
            a -= growth * growth;
            b -= reach * growth;
        }
        let c = apart2 - reach * reach;
        // Balls that overlap by a rounding error touch.
        Quadratic { start, a, b, c: if c > 0.0 { c } else { 0.0 } }
    }

    /// When two balls that are nearer than `reach` are as far apart; infinite for never.
    #[inline(always)]
    pub fn leaving<const D: usize, M: Mode>(
        a: &Path<D>,
        b: &Path<D>,
        offset: &[f64; D],
        reach: f64,
        field: &Field<D>,
    ) -> f64 {
        let (start, apart, approach) = relative::<D, M>(a, b, offset, field);
        let [a, b, apart2] = products(&apart, &approach);
        if a == 0.0 {
            return f64::INFINITY;
        }
        // Balls that are beyond by a rounding error are at the distance.
        let c = (apart2 - reach * reach).min(0.0);
        let root = (b * b - a * c).sqrt();
        // The second root, in the form that loses no digits.
        start + if b > 0.0 { -c / (b + root) } else { (root - b) / a }
    }

    /// False where the balls do not meet, or not before `limit`: where a is not negative the meeting is later than c / (-2 b).
    #[inline(always)]
    pub fn maybe_before<M: Mode>(&self, limit: f64) -> bool {
        let meets = self.b * self.b >= self.a * self.c;
        let soon = (self.b < 0.0) & (self.c <= -2.0 * self.b * (limit - self.start));
        // Only balls that grow meet with a negative a.
        meets & (soon | (M::GROWS & (self.a < 0.0)))
    }

    /// The meeting, where there is one: the first root, in the form that loses no digits.
    #[inline(always)]
    pub fn root<M: Mode>(&self) -> f64 {
        let root = (self.b * self.b - self.a * self.c).sqrt();
        if M::GROWS && self.b > 0.0 {
            // Balls that part, and are caught up by their growth.
            return self.start - (self.b + root) / self.a;
        }
        self.start + self.c / (root - self.b)
    }
}

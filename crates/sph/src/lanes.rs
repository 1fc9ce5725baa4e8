//! Several numbers at once.
//!
//! Plain arrays in plain loops: the compiler turns each operation into the widest vector instruction of the function
//! it is inlined into, and the result is the same to the bit on every processor.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// How many numbers a [`Lanes`] holds: one AVX-512 register, two AVX2 registers.
pub const LANES: usize = 8;

/// Several `f64`, operated on lane by lane.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub struct Lanes(pub [f64; LANES]);

macro_rules! lane_by_lane {
    ($trait:ident, $method:ident, $operator:tt) => {
        impl $trait for Lanes {
            type Output = Lanes;
            #[inline(always)]
            fn $method(self, other: Lanes) -> Lanes {
                let mut out = [0.0; LANES];
                for lane in 0..LANES {
                    out[lane] = self.0[lane] $operator other.0[lane];
                }
                Lanes(out)
            }
        }
        impl $trait<f64> for Lanes {
            type Output = Lanes;
            #[inline(always)]
            fn $method(self, other: f64) -> Lanes {
                self $operator Lanes::splat(other)
            }
        }
    };
}

lane_by_lane!(Add, add, +);
lane_by_lane!(Sub, sub, -);
lane_by_lane!(Mul, mul, *);
lane_by_lane!(Div, div, /);

impl Neg for Lanes {
    type Output = Lanes;
    #[inline(always)]
    fn neg(self) -> Lanes {
        self.map(|value| -value)
    }
}

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Lanes) {
        *self = *self + other;
    }
}

impl Lanes {
    /// All lanes 0.
    pub const ZERO: Lanes = Lanes([0.0; LANES]);

    /// The same number in every lane.
    #[inline(always)]
    pub fn splat(value: f64) -> Lanes {
        Lanes([value; LANES])
    }

    /// Lane by lane from a function of the lane's number.
    #[inline(always)]
    pub fn from_fn(mut value: impl FnMut(usize) -> f64) -> Lanes {
        let mut out = [0.0; LANES];
        for (lane, out) in out.iter_mut().enumerate() {
            *out = value(lane);
        }
        Lanes(out)
    }

    #[inline(always)]
    fn map(self, function: impl Fn(f64) -> f64) -> Lanes {
        Lanes::from_fn(|lane| function(self.0[lane]))
    }

    /// Square root.
    #[inline(always)]
    pub fn sqrt(self) -> Lanes {
        self.map(f64::sqrt)
    }

    /// Magnitude.
    #[inline(always)]
    pub fn abs(self) -> Lanes {
        self.map(f64::abs)
    }

    /// The larger of two numbers, neither of them not-a-number.
    #[inline(always)]
    pub fn max(self, other: Lanes) -> Lanes {
        Lanes::from_fn(|lane| if self.0[lane] > other.0[lane] { self.0[lane] } else { other.0[lane] })
    }

    /// The smaller of two numbers, neither of them not-a-number.
    #[inline(always)]
    pub fn min(self, other: Lanes) -> Lanes {
        Lanes::from_fn(|lane| if self.0[lane] < other.0[lane] { self.0[lane] } else { other.0[lane] })
    }

    /// The number itself where it is positive, else 0.
    #[inline(always)]
    pub fn positive(self) -> Lanes {
        self.max(Lanes::ZERO)
    }

    /// `yes` where `self < limit`, else `no`.
    #[inline(always)]
    pub fn select_below(self, limit: Lanes, yes: Lanes, no: Lanes) -> Lanes {
        Lanes::from_fn(|lane| if self.0[lane] < limit.0[lane] { yes.0[lane] } else { no.0[lane] })
    }

    /// Sum of the lanes, in one fixed order.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        let [a, b, c, d, e, f, g, h] = self.0;
        ((a + e) + (c + g)) + ((b + f) + (d + h))
    }

    /// Largest of the lanes.
    #[inline(always)]
    pub fn largest(self) -> f64 {
        self.0.into_iter().fold(f64::NEG_INFINITY, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arithmetic_is_lane_by_lane() {
        let a = Lanes::from_fn(|lane| lane as f64);
        let b = Lanes::splat(2.0);
        assert_eq!((a * b + 1.0 - b / 4.0).0[3], 6.5);
        assert_eq!((-a).abs().sum(), 28.0);
        assert_eq!(a.max(b).sum(), 31.0);
        assert_eq!(a.min(b).sum(), 13.0);
        assert_eq!(a.largest(), 7.0);
        assert_eq!(a.select_below(b, b, Lanes::ZERO).sum(), 4.0);
        assert_eq!((a - b).positive().sqrt().0[6], 2.0);
    }
}

//! Lengths of paths.

use super::speed;
use crate::functions::asinh;

/// Where gravity changes the speed by less than this part, Simpson's rule is exact to 10^-8.
const NEARLY_STRAIGHT: f64 = 0.1;

/// Length of the path of a ball that begins with this velocity and falls for a time: of a piece of a parabola.
///
/// Speed is `sqrt(c^2 + u^2)`, with c across and u along gravity; its integral over u is `(u sqrt(c^2 + u^2) + c^2 asinh(u / c)) / 2`.
#[inline(always)]
pub(super) fn length<const D: usize>(velocity: &[f64; D], gravity: &[f64; D], time: f64) -> f64 {
    let at = |time: f64| speed(&std::array::from_fn::<f64, D, _>(|axis| velocity[axis] + gravity[axis] * time));
    let (first, strength) = (speed(velocity), speed(gravity));
    if strength * time <= NEARLY_STRAIGHT * first {
        return (first + 4.0 * at(0.5 * time) + at(time)) * time / 6.0;
    }
    let dot: f64 = velocity.iter().zip(gravity).map(|(v, g)| v * g).sum();
    let along = dot / strength;
    let across2 = (first * first - along * along).max(0.0);
    let across = across2.sqrt();
    let integral = |along: f64| {
        let turn = if across > 0.0 { across2 * asinh(along / across) } else { 0.0 };
        0.5 * (along * (across2 + along * along).sqrt() + turn)
    };
    (integral(along + strength * time) - integral(along)) / strength
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The length as a sum of many straight pieces.
    fn summed(velocity: [f64; 2], gravity: [f64; 2], time: f64) -> f64 {
        const PIECES: usize = 20_000;
        let step = time / PIECES as f64;
        let speed_in = |piece: usize| {
            let at = (piece as f64 + 0.5) * step;
            (velocity[0] + gravity[0] * at).hypot(velocity[1] + gravity[1] * at)
        };
        (0..PIECES).map(|piece| speed_in(piece) * step).sum()
    }

    #[test]
    fn a_ball_that_is_thrown_up_comes_down_by_the_same_way() {
        assert!((length(&[0.0, 2.0], &[0.0, -2.0], 2.0) - 2.0).abs() < 1e-15);
        assert_eq!(length(&[3.0, 4.0, 0.0], &[0.0; 3], 2.0), 10.0);
        assert_eq!(length(&[0.0; 2], &[0.0, -2.0], 3.0), 9.0);
    }

    proptest! {
        #[test]
        fn it_is_the_sum_of_its_pieces(
            velocity in [-3.0..3.0, -3.0..3.0], gravity in [-5.0..5.0, -5.0..5.0], time in 0.0..4.0,
        ) {
            let (found, exact) = (length(&velocity, &gravity, time), summed(velocity, gravity, time));
            prop_assert!((found - exact).abs() <= 2e-7 * exact + 1e-12, "{found} {exact}");
        }
    }
}

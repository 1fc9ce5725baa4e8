//! The water at a boundary face by the characteristics that reach it (Toro 2001, section 6.3): u + 2c comes from inside unless the flow comes in
//! faster than waves, u - 2c from beyond unless it goes out faster.

use super::super::reconstruction::AtFace;
use super::{AtBoundary, Now};

/// Iterations of Newton's method, which doubles its digits in each; on a GPU, in single precision, `BOUNDARY_ITERATIONS_ON_GPU`.
const BOUNDARY_ITERATIONS: usize = 30;

/// The water at a boundary face before which the water is `at`.
pub(crate) fn state(now: Now, at: &AtFace, gravity: f64) -> AtBoundary {
    let own = AtBoundary { depth: at.depth, across: at.across };
    let celerity = (gravity * at.depth).sqrt();
    let is_supercritical = at.depth > 0.0 && at.across >= celerity;
    let outgoing = at.across + 2.0 * celerity;
    let inside = Inside { celerity, across: at.across };
    match now {
        Now::Wall => AtBoundary { across: 0.0, ..own },
        Now::Moving(inwards) => moves(inwards, inside, gravity),
        Now::Discharge(inwards) if inwards > 0.0 => comes_in(inwards, inside, gravity),
        _ if is_supercritical => own,
        Now::Open(level) => {
            let beyond = (gravity * (level - (at.level - at.depth)).max(0.0)).sqrt();
            let found = meets(beyond, 0.0, at.depth > 0.0, outgoing, gravity);
            if found.across >= 0.0 { found } else { still(outgoing, gravity) }
        }
        Now::Discharge(inwards) => goes_out(-inwards, outgoing, gravity),
        Now::Normal(factor) => normal(factor, outgoing, gravity),
        Now::Beyond(level, drift, ground) => {
            let beyond = (gravity * (level - (at.level - at.depth)).max(0.0)).sqrt();
            let found = meets(beyond, drift, at.depth > 0.0, outgoing, gravity);
            // Nothing from inside meets it: neither does the ground of the cell.
            let depth = (level - ground).max(0.0);
            let is_fast = -drift >= (gravity * depth).sqrt() && found.across <= -(gravity * found.depth).sqrt();
            if is_fast { AtBoundary { depth, across: drift } } else { found }
        }
    }
}

/// Depth at which waves have a celerity, m.
fn depth_of(celerity: f64, gravity: f64) -> f64 {
    celerity * celerity / gravity
}

/// No water passes: the level rises or falls until what comes from inside is at rest.
fn still(outgoing: f64, gravity: f64) -> AtBoundary {
    AtBoundary { depth: depth_of((0.5 * outgoing).max(0.0), gravity), across: 0.0 }
}

/// The water inside, before a face at which it may become deeper by a bore: where it runs towards the face faster than waves there is no other way, and by
/// the characteristics it would become hundreds of times too deep.
#[derive(Clone, Copy)]
struct Inside {
    /// Celerity of waves, m/s.
    celerity: f64,
    /// Velocity towards the face, m/s.
    across: f64,
}

impl Inside {
    /// The velocity towards the face that it loses, m/s, where a wave changes its celerity to `after`, and the slope of that: a rarefaction where it becomes
    /// shallower, a bore where it becomes deeper (Toro 2001, section 5.3).
    fn slowed(self, after: f64) -> (f64, f64) {
        let before = self.celerity;
        if after <= before {
            return (2.0 * (after - before), 2.0);
        }
        let mean = (0.5 * (after * after + before * before)).sqrt();
        let ratio = after / before - before / after;
        (ratio * mean, (1.0 / before + before / (after * after)) * mean + 0.5 * ratio * after / mean)
    }

    /// A celerity at least as large as that at which it has lost `by` m/s. A bore needs less depth for it than a smooth wave, and less than where
    /// the depth before the bore is left out of the force on it.
    fn at_most(self, by: f64) -> f64 {
        let without_bore = self.celerity + 0.5 * by;
        if by <= 0.0 {
            return without_bore;
        }
        without_bore.min((self.celerity * (self.celerity + std::f64::consts::SQRT_2 * by)).sqrt())
    }
}

/// The root of a function with its slope by Newton's method.
fn solve(mut root: f64, function: impl Fn(f64) -> (f64, f64)) -> f64 {
    for _ in 0..BOUNDARY_ITERATIONS {
        let (value, slope) = function(root);
        root -= value / slope;
    }
    root
}

/// Water before a wall that moves inwards as fast: as fast as the wall, at the level that the wave from inside gives it. A wall that recedes faster than
/// the water can follow leaves it behind.
fn moves(inwards: f64, inside: Inside, gravity: f64) -> AtBoundary {
    let closing = inside.across + inwards;
    let mut celerity = inside.at_most(closing);
    if inside.celerity <= 0.0 || celerity <= 0.0 {
        return AtBoundary { depth: 0.0, across: 0.0 };
    }
    if closing > 0.0 {
        celerity = solve(celerity, |celerity| {
            let (slowed, slope) = inside.slowed(celerity);
            (slowed - closing, slope)
        });
    }
    AtBoundary { depth: depth_of(celerity, gravity), across: -inwards }
}

/// Water of celerity `beyond` that moves outwards at `drift`.
fn meets(beyond: f64, drift: f64, is_wet: bool, outgoing: f64, gravity: f64) -> AtBoundary {
    if beyond == 0.0 {
        // It falls over the edge: critical depth.
        let critical = (outgoing / 3.0).max(0.0);
        return AtBoundary { depth: depth_of(critical, gravity), across: critical };
    }
    let incoming = drift - 2.0 * beyond;
    let (across, celerity) = (0.5 * (outgoing + incoming), 0.25 * (outgoing - incoming));
    if is_wet && across >= -celerity {
        return AtBoundary { depth: depth_of(celerity.max(0.0), gravity), across };
    }
    // Onto dry ground or a film, faster than waves: as it is beyond where it is as fast there, else the critical depth of a dam break (Ritter 1892).
    if -drift >= beyond {
        return AtBoundary { depth: depth_of(beyond, gravity), across: drift };
    }
    let critical = (-incoming / 3.0).max(0.0);
    AtBoundary { depth: depth_of(critical, gravity), across: -critical }
}

/// A discharge inwards, m2/s: the water inside loses its velocity to that of what comes in, where that flow is slower than waves; critical depth where it is not.
fn comes_in(discharge: f64, inside: Inside, gravity: f64) -> AtBoundary {
    let target = gravity * discharge;
    let critical = target.cbrt();
    // What comes in at this celerity less the discharge, times gravity.
    let excess = |celerity: f64| {
        let (slowed, slope) = inside.slowed(celerity);
        let inwards = slowed - inside.across;
        (celerity * celerity * inwards - target, celerity * (2.0 * inwards + celerity * slope))
    };
    let celerity = if inside.celerity <= 0.0 || excess(critical).0 >= 0.0 {
        critical
    } else {
        solve(inside.at_most(inside.across + critical), excess)
    };
    AtBoundary { depth: depth_of(celerity, gravity), across: -target / (celerity * celerity) }
}

/// A discharge outwards, m2/s, and that of critical flow at most: the larger root of c^2 (outgoing - 2c) = g q.
fn goes_out(discharge: f64, outgoing: f64, gravity: f64) -> AtBoundary {
    if outgoing <= 0.0 || discharge <= 0.0 {
        return still(outgoing, gravity);
    }
    let critical = outgoing / 3.0;
    let target = gravity * discharge;
    if target >= critical.powi(3) {
        return AtBoundary { depth: depth_of(critical, gravity), across: critical };
    }
    let mut celerity = 0.5 * outgoing;
    for _ in 0..BOUNDARY_ITERATIONS {
        let value = celerity * celerity * (outgoing - 2.0 * celerity) - target;
        let slope = celerity * (2.0 * outgoing - 6.0 * celerity);
        celerity -= value / slope;
    }
    AtBoundary { depth: depth_of(celerity, gravity), across: target / (celerity * celerity) }
}

/// Normal flow with velocity `factor` depth^(2/3) where that is slower than waves, critical flow where it is not.
fn normal(factor: f64, outgoing: f64, gravity: f64) -> AtBoundary {
    if outgoing <= 0.0 {
        return still(outgoing, gravity);
    }
    let velocity = |celerity: f64| factor * depth_of(celerity, gravity).powf(2.0 / 3.0);
    let (mut low, mut high) = (0.0, 0.5 * outgoing);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if velocity(middle) + 2.0 * middle < outgoing { low = middle } else { high = middle }
    }
    if velocity(low) > low {
        low = outgoing / 3.0;
    }
    AtBoundary { depth: depth_of(low, gravity), across: outgoing - 2.0 * low }
}

#[cfg(test)]
mod tests {
    use super::*;

    const G: f64 = 9.81;

    fn at(depth: f64, across: f64) -> AtFace {
        AtFace { depth, level: depth + 1.0, across, along: 0.4 }
    }

    #[test]
    fn a_level_that_rises_over_still_water_is_the_level_there() {
        let (before, after) = (2.0_f64, 2.1_f64);
        let drift = -2.0 * ((G * after).sqrt() - (G * before).sqrt());
        let found = state(Now::Beyond(after + 1.0, drift, 1.0), &at(before, 0.0), G);
        assert!((found.depth - after).abs() < 1e-12 && found.across < 0.0);
    }

    #[test]
    fn a_wave_leaves_by_a_held_level_as_it_is() {
        // An outgoing simple wave on water of 2 m: u = 2 (c - c0).
        let across = 2.0 * ((G * 2.2_f64).sqrt() - (G * 2.0_f64).sqrt());
        let found = state(Now::Beyond(3.0, 0.0, 1.0), &at(2.2, across), G);
        assert!((found.depth - 2.2).abs() < 1e-12 && (found.across - across).abs() < 1e-12);
    }

    /// Still water beyond comes in over a film as over dry ground, and the less the deeper the water inside is.
    #[test]
    fn a_held_level_comes_in_over_a_film_as_over_dry_ground() {
        let into = |depth: f64| {
            let found = state(Now::Beyond(1.6, 0.0, 1.0), &at(depth, 0.0), G);
            -found.depth * found.across
        };
        let dry = 8.0 / 27.0 * 0.6 * (G * 0.6).sqrt();
        assert!((into(0.0) / dry - 1.0).abs() < 1e-12);
        for film in [1e-9, 1e-6, 1e-4] {
            assert!((into(film) / dry - 1.0).abs() < 1e-12, "{film} m");
        }
        let mut before = dry;
        for depth in (1..=600).map(|k| 0.001 * f64::from(k)) {
            let now = into(depth);
            assert!(now <= before * (1.0 + 1e-12) && before - now < 0.01 * dry, "{depth} m: {now} after {before} m2/s");
            before = now;
        }
        assert!(before.abs() < 1e-12, "{before}");
    }

    /// What comes in faster than waves comes over the ground of the face, whatever that of the cell is.
    #[test]
    fn water_that_is_faster_than_waves_comes_in_as_it_is() {
        for inside in [at(0.5, -3.5), at(0.0, 0.0)] {
            let found = state(Now::Beyond(1.7, -4.0, 1.2), &inside, G);
            assert!((found.depth - 0.5).abs() < 1e-12 && found.across == -4.0, "{found:?}");
        }
    }

    /// How far the step from `before` to the water at the face is from a bore that keeps volume and momentum (Rankine & Hugoniot), or, where the water gets
    /// shallower, from a rarefaction that keeps u + 2c; over the celerity.
    fn off_the_wave(before: &AtFace, found: &AtBoundary) -> f64 {
        let celerity = (G * before.depth).sqrt();
        if found.depth <= before.depth {
            let kept = found.across + 2.0 * (G * found.depth).sqrt() - before.across - 2.0 * celerity;
            return kept.abs() / celerity;
        }
        let flux = |depth: f64, across: f64| [depth * across, depth * across * across + 0.5 * G * depth * depth];
        let ([volume, thrust], [volume_after, thrust_after]) =
            (flux(before.depth, before.across), flux(found.depth, found.across));
        let speed = (volume_after - volume) / (found.depth - before.depth);
        (thrust_after - thrust - speed * (volume_after - volume)).abs() / (thrust_after + thrust)
    }

    /// The discharge is met, and the wave that brings the water inside to it where the flow is slower than waves: also against water that runs towards the
    /// face faster than waves, where without a bore it would become hundreds of times too deep.
    #[test]
    fn discharges_are_met_in_both_directions() {
        for (discharge, before) in [
            (0.3, at(1.0, -0.2)),
            (0.3, at(0.0, 0.0)),
            (8.0, at(0.5, 0.0)),
            (0.2, at(0.03, 60.0)),
            (0.2, at(1e-9, 3.0)),
            (3.0, at(0.4, 2.5)),
            (-0.4, at(1.0, 0.1)),
        ] {
            let found = state(Now::Discharge(discharge), &before, G);
            assert!((found.depth * found.across + discharge).abs() < 1e-9, "{discharge}: {found:?}");
            let is_critical = (found.across.abs() / (G * found.depth).sqrt() - 1.0).abs() < 1e-9;
            assert!(is_critical || off_the_wave(&before, &found) < 1e-9, "{discharge} {before:?}: {found:?}");
        }
    }

    /// Water of 3 cm that runs into a wall with 60 m/s stands 4.7 m deep before it: by a wave without a jump it would be 95 m.
    #[test]
    fn water_that_runs_into_a_wall_makes_a_bore() {
        for (inwards, before) in [(0.0, at(0.03, 60.0)), (0.0, at(1.0, 2.0)), (3.0, at(0.5, 0.0)), (5.0, at(1e-6, 0.0))]
        {
            let found = state(Now::Moving(inwards), &before, G);
            assert!(found.across == -inwards && off_the_wave(&before, &found) < 1e-12, "{before:?}: {found:?}");
        }
        let found = state(Now::Moving(0.0), &at(0.03, 60.0), G);
        assert!((found.depth - 4.7).abs() < 0.1, "{found:?}");
    }

    #[test]
    fn water_before_a_moving_wall_is_as_fast_as_the_wall() {
        let still = at(2.0, 0.0);
        let celerity = (G * 2.0_f64).sqrt();
        for inwards in [-0.3, 0.0] {
            let found = state(Now::Moving(inwards), &still, G);
            let exact = (celerity + 0.5 * inwards).powi(2) / G;
            assert!((found.depth - exact).abs() < 1e-12 && found.across == -inwards, "{found:?}");
        }
        let left = AtBoundary { depth: 0.0, across: 0.0 };
        assert_eq!(state(Now::Moving(-20.0), &still, G), left);
        assert_eq!(state(Now::Moving(1.0), &at(0.0, 0.0), G), left);
    }

    #[test]
    fn water_in_normal_flow_leaves_as_it_comes() {
        let depth: f64 = 0.8;
        let factor = 0.001_f64.sqrt() / 0.03;
        let across = factor * depth.powf(2.0 / 3.0);
        let found = state(Now::Normal(factor), &at(depth, across), G);
        assert!((found.depth / depth - 1.0).abs() < 1e-9 && (found.across / across - 1.0).abs() < 1e-9);
    }
}

//! How far to go in a slice of wall-clock time.

use std::time::Duration;

/// Longest that a slice may take, s: each gives a picture, and commands are taken between them.
const LONGEST: f64 = 0.015;
/// A slice that was waited for longer than this is not made up for, s.
const MOST_OWED: f64 = 0.1;
/// Weight of the newest slice in what a slice costs, and in the pace that is told.
const NEWEST: f64 = 0.2;

/// Keeps simulated time in step with the wall clock, or as near as can be computed.
#[derive(Debug, Clone)]
pub(super) struct Pace {
    /// Simulated seconds in a second, as asked for.
    pub asked: f64,
    /// Wall-clock seconds that a simulated second takes; none before the first slice.
    cost: Option<f64>,
    /// Simulated seconds in a second, as it goes.
    pub real: f64,
}

impl Pace {
    pub fn new(asked: f64) -> Self {
        Self { asked, cost: None, real: 0.0 }
    }

    /// How far to go, s, when the last slice began so long ago. The first slice is a try.
    pub fn next(&self, since: Duration) -> f64 {
        let wanted = self.asked * since.as_secs_f64().min(MOST_OWED);
        match self.cost {
            Some(cost) => wanted.min(LONGEST / cost.max(1e-300)),
            None => 0.02 * wanted,
        }
    }

    /// A slice went so far, s; it took `worked`, and with waiting `whole`.
    pub fn went(&mut self, far: f64, worked: Duration, whole: Duration) {
        if far <= 0.0 {
            return;
        }
        let mix = |old: f64, new: f64| old + NEWEST * (new - old);
        let cost = worked.as_secs_f64() / far;
        self.cost = Some(self.cost.map_or(cost, |old| mix(old, cost)));
        let real = far / whole.as_secs_f64().max(1e-9);
        self.real = if self.real == 0.0 { real } else { mix(self.real, real) };
    }

    /// True where it is too much to compute.
    pub fn is_behind(&self) -> bool {
        self.real > 0.0 && self.real < 0.9 * self.asked && self.cost.is_some_and(|cost| cost * self.asked > 0.7)
    }

    /// Nothing goes on.
    pub fn rest(&mut self) {
        self.real = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Goes on for a second of the wall clock where a simulated second costs so much work, in slices of at least 16 ms.
    fn second(pace: &mut Pace, cost: f64) -> (f64, f64) {
        let (mut clock, mut simulated, mut since, mut longest) = (0.0, 0.0, 0.016, 0.0_f64);
        while clock < 1.0 {
            let far = pace.next(Duration::from_secs_f64(since));
            let worked = far * cost;
            since = worked.max(0.016);
            pace.went(far, Duration::from_secs_f64(worked), Duration::from_secs_f64(since));
            (clock, simulated, longest) = (clock + since, simulated + far, longest.max(worked));
        }
        (simulated, longest)
    }

    #[test]
    fn what_can_be_computed_goes_at_the_pace_that_was_asked_for() {
        let mut pace = Pace::new(3.0);
        let (simulated, _) = second(&mut pace, 0.1);
        assert!((simulated - 3.0).abs() < 0.2, "{simulated}");
        assert!(!pace.is_behind());
    }

    #[test]
    fn what_cannot_goes_as_fast_as_it_can_in_short_slices() {
        let mut pace = Pace::new(50.0);
        let (simulated, longest) = second(&mut pace, 0.1);
        assert!((simulated - 10.0).abs() < 1.0, "{simulated}");
        assert!(longest < 0.2, "{longest}");
        assert!(pace.is_behind());
    }
}

//! Control of the pace: how far to advance in a slice of wall-clock time.

use std::time::Duration;

/// Longest duration of a slice, s: each gives a picture, and commands are taken between them.
const LONGEST: f64 = 0.015;
/// Longest delay that the next slice makes up for, s.
const LONGEST_DELAY: f64 = 0.1;
/// A slice on a device that draws as well waits for pictures besides, which makes it no use to have it as short as may be: it may take from
/// so long to so long, s, and goes farther or less far by this factor where it does not.
const BESIDE_PICTURES: [f64; 2] = [0.03, 0.04];
const SLICE_FACTOR: f64 = 1.25;
/// Weight of the newest slice in the mean cost, and in the pace reported.
const NEWEST: f64 = 0.2;

/// Keeps simulated time in step with the wall clock, as far as the computation is fast enough.
#[derive(Debug, Clone)]
pub(super) struct Pace {
    /// Requested pace, simulated seconds per second.
    pub requested: f64,
    /// Wall-clock seconds that a simulated second takes; none before the first slice.
    cost: Option<f64>,
    /// Largest advance of a slice on a device that also draws, s; none before the first.
    most: Option<f64>,
    /// Pace reached, simulated seconds per second.
    pub real: f64,
}

impl Pace {
    pub fn new(requested: f64) -> Self {
        Self { requested, cost: None, most: None, real: 0.0 }
    }

    /// The advance of the next slice, s, when the last one began so long ago. The first slice is a trial.
    pub fn next(&self, since: Duration) -> f64 {
        let wanted = self.requested * since.as_secs_f64().min(LONGEST_DELAY);
        match self.cost {
            Some(cost) => wanted.min(LONGEST / cost.max(1e-300)),
            None => 0.02 * wanted,
        }
    }

    /// The same on a device that also draws, after a slice that advanced so far, s, and worked so long; one without a step only waited.
    pub fn next_beside_pictures(&mut self, since: Duration, far: f64, worked: Duration, has_stepped: bool) -> f64 {
        let wanted = self.requested * since.as_secs_f64().min(LONGEST_DELAY);
        let most = self.most.get_or_insert(wanted);
        let [short, long] = BESIDE_PICTURES;
        let (worked, is_most) = (worked.as_secs_f64(), far > 0.9 * *most);
        if has_stepped && worked > long {
            *most /= SLICE_FACTOR;
        } else if is_most && (!has_stepped || worked < short) {
            *most *= SLICE_FACTOR;
        }
        wanted.min(*most)
    }

    /// Records a slice: its advance, s, its work `worked`, and with waiting `whole`.
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

    /// True where the requested pace is not reached.
    pub fn is_behind(&self) -> bool {
        self.real > 0.0 && self.real < 0.9 * self.requested && self.cost.is_some_and(|cost| cost * self.requested > 0.7)
    }

    /// Resets the pace on pause.
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

    /// Goes on for ten seconds of the wall clock where steps of so many simulated seconds cost so much work each, and each slice waits besides;
    /// gives how far it went, and the mean length of a slice.
    fn beside_pictures(requested: f64, step: f64, cost: f64, wait: f64) -> (f64, f64) {
        let mut pace = Pace::new(requested);
        let (mut clock, mut time, mut stepped, mut slices) = (0.0, 0.0, 0.0, 0.0);
        let (mut far, mut worked, mut has_stepped, mut since) = (0.0, 0.0, false, 0.016);
        while clock < 10.0 {
            let whole = Duration::from_secs_f64(since);
            far = pace.next_beside_pictures(whole, far, Duration::from_secs_f64(worked), has_stepped);
            time += far;
            let steps = ((time - stepped) / step).floor();
            (stepped, has_stepped) = (stepped + steps * step, steps > 0.0);
            worked = wait + steps * cost;
            since = worked.max(0.016);
            (clock, slices) = (clock + since, slices + 1.0);
        }
        (time, clock / slices)
    }

    #[test]
    fn beside_pictures_what_can_be_computed_keeps_its_pace() {
        let (time, slice) = beside_pictures(1.0, 0.005, 0.0002, 0.006);
        assert!((time - 10.0).abs() < 0.5 && slice < 0.02, "{time} {slice}");
        // Steps much longer than slices.
        let (time, slice) = beside_pictures(0.1, 0.05, 0.0002, 0.001);
        assert!((time - 1.0).abs() < 0.1 && slice < 0.02, "{time} {slice}");
    }

    #[test]
    fn pictures_that_take_long_do_not_bring_the_physics_to_a_stop() {
        // A million particles: steps of 1.2 ms, pictures of 22 ms.
        let (time, slice) = beside_pictures(10.0, 0.005, 0.0012, 0.022);
        assert!(time > 10.0 && slice < 0.045, "{time} {slice}");
        // Software in place of a GPU: a step at least every few pictures.
        let (time, _) = beside_pictures(1.0, 0.05, 0.02, 0.5);
        assert!(time > 0.4, "{time}");
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

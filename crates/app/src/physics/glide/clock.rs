//! Simulated time beside the wall clock.

use super::super::thread::PICTURES;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Longest wait that is not broken off, s.
const NAP: f64 = 0.004;
/// What is late by more than this is not made up for, s.
const MOST_OWED: f64 = 0.1;

/// Keeps a scene in step with the wall clock.
#[derive(Debug, Clone)]
pub(super) struct Clock {
    /// A time of the scene, s, when it is due, and simulated seconds in a second.
    from: f64,
    began: Instant,
    pace: f64,
    /// The last picture: of what time, s, and when.
    last: (f64, Instant),
    /// When the next is due.
    next: Instant,
    /// Waited since the last picture.
    waited: Duration,
}

impl Clock {
    /// The scene is at this time now, s, and goes on so fast.
    pub fn at(time: f64, pace: f64) -> Self {
        let now = Instant::now();
        Self { from: time, began: now, pace, last: (time, now), next: now, waited: Duration::ZERO }
    }

    /// If a picture is due, takes that of this time: gives how far the scene has gone since the last, s, how long it worked for that, and how
    /// long that took with what was waited.
    pub fn picture(&mut self, time: f64) -> Option<(f64, Duration, Duration)> {
        let now = Instant::now();
        if now < self.next {
            return None;
        }
        // One that is late does not make the next come sooner than it can be shown.
        let period = Duration::from_secs_f64(1.0 / PICTURES);
        self.next = (self.next + period).max(now + period / 2);
        let (before, when) = std::mem::replace(&mut self.last, (time, now));
        let (whole, waited) = (now.duration_since(when), std::mem::take(&mut self.waited));
        Some((time - before, whole.saturating_sub(waited), whole))
    }

    /// Waits until a time of the scene is due, or it is told to stop.
    pub fn wait_until(&mut self, time: f64, stop: &AtomicBool) {
        let began = Instant::now();
        loop {
            let now = Instant::now();
            let left = (time - self.from) / self.pace - now.duration_since(self.began).as_secs_f64();
            if left < -MOST_OWED {
                (self.from, self.began) = (time, now);
            }
            if left <= 0.0 || stop.load(Ordering::Relaxed) {
                break;
            }
            std::thread::sleep(Duration::from_secs_f64(left.min(NAP)));
        }
        self.waited += began.elapsed();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_goes_as_fast_as_it_is_asked_to() {
        let (mut clock, stop, began) = (Clock::at(3.0, 2.0), AtomicBool::new(false), Instant::now());
        let (mut pictures, mut far) = (0, 0.0);
        for step in 1..=100 {
            let time = 3.0 + 0.004 * f64::from(step);
            if let Some((gone, worked, whole)) = clock.picture(time) {
                assert!(worked <= whole);
                (pictures, far) = (pictures + 1, far + gone);
            }
            clock.wait_until(time, &stop);
        }
        let took = began.elapsed().as_secs_f64();
        // A machine may be slower than that.
        assert!(
            took >= 0.2 && pictures <= (took * PICTURES) as u32 + 2 && far <= 0.4 + 1e-12,
            "{took} {pictures} {far}"
        );
        // Of what it is late it makes up for little.
        std::thread::sleep(Duration::from_millis(300));
        clock.wait_until(3.404, &stop);
        let began = Instant::now();
        clock.wait_until(3.504, &stop);
        assert!(began.elapsed().as_secs_f64() > 0.04);
    }

    #[test]
    fn who_waits_is_told_to_stop() {
        let (mut clock, stop, began) = (Clock::at(0.0, 1e-9), AtomicBool::new(true), Instant::now());
        clock.wait_until(1.0, &stop);
        assert!(began.elapsed() < Duration::from_secs(10));
    }
}

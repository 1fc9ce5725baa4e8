//! Measurement of the pictures per second.

use crate::Window;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use web_time::Instant;

/// The first pictures of a scene, for which programs are still compiled, are not counted.
const WARM_UP: Duration = Duration::from_millis(1500);

/// The rate of pictures while a scene played.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement {
    /// Pictures in a second, each of a time of its own.
    pub pictures_per_s: f64,
    /// Longest time between two pictures, s.
    pub slowest_s: f64,
    /// Particles in the last picture.
    pub particles: usize,
    /// Simulated seconds in a second.
    pub pace: f64,
}

/// Measures while a scene plays.
pub(crate) struct Meter {
    seconds: Duration,
    result: Arc<Mutex<Option<Measurement>>>,
    /// When the scene was first shown.
    seen: Option<Instant>,
    /// When counting began, and the time of the scene then.
    began: Option<(Instant, f64)>,
    last: Option<(Instant, f64)>,
    pictures: u32,
    slowest: Duration,
}

impl Meter {
    pub fn new(seconds: f64, result: Arc<Mutex<Option<Measurement>>>) -> Self {
        let seconds = Duration::try_from_secs_f64(seconds).unwrap_or_default();
        Self { seconds, result, seen: None, began: None, last: None, pictures: 0, slowest: Duration::ZERO }
    }

    /// Counts a picture; true when enough were counted. A picture of the same time as the last does not count.
    pub fn tick(&mut self, window: &Window) -> bool {
        let now = Instant::now();
        let Some(snapshot) = window.snapshot() else { return window.fault().is_some() };
        let seen = *self.seen.get_or_insert(now);
        let time = snapshot.frame.time;
        if now.duration_since(seen) < WARM_UP || self.last.is_some_and(|(_, last)| last == time) {
            return false;
        }
        if let Some((last, _)) = self.last.replace((now, time)) {
            self.pictures += 1;
            self.slowest = self.slowest.max(now.duration_since(last));
        }
        let (began, from) = *self.began.get_or_insert((now, time));
        let past = now.duration_since(began);
        let enough = past >= self.seconds || !snapshot.playing && self.pictures > 0;
        if enough {
            let past = past.as_secs_f64().max(1e-9);
            let result = Measurement {
                pictures_per_s: f64::from(self.pictures) / past,
                slowest_s: self.slowest.as_secs_f64(),
                particles: snapshot.particles,
                pace: (time - from) / past,
            };
            *self.result.lock().unwrap_or_else(PoisonError::into_inner) = Some(result);
        }
        enough
    }
}

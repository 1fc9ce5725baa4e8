//! Instruments of the window: a ruler in the picture, and a stopwatch of simulated time.

mod ruler;
mod stopwatch;

pub use ruler::Ruler;
pub use stopwatch::Stopwatch;

/// The instruments that are taken.
#[derive(Debug, Default)]
pub struct Instruments {
    /// The ruler, where it lies in the picture.
    pub ruler: Option<Ruler>,
    /// The stopwatch, where it is shown.
    pub stopwatch: Option<Stopwatch>,
}

impl Instruments {
    /// Takes the ruler, or puts it away.
    pub fn toggle_ruler(&mut self) {
        self.ruler = if self.ruler.is_some() { None } else { Some(Ruler::default()) };
    }

    /// Takes the stopwatch, or puts it away.
    pub fn toggle_stopwatch(&mut self) {
        self.stopwatch = if self.stopwatch.is_some() { None } else { Some(Stopwatch::default()) };
    }
}

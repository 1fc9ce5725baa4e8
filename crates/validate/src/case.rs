//! Cases with known answers.

use crate::{Options, Row};

/// A case with a known answer.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// Name: the model and words, `flood/voronoi/stoker`.
    pub name: &'static str,
    /// What it tests and where the answer comes from, in a sentence.
    pub about: &'static str,
    /// True where it takes more than about ten seconds.
    pub slow: bool,
    /// Factor of the spacing at its reduced size, or, of dew, of the simulated time; 1 where it has none, as it takes
    /// little.
    pub reduced: f64,
    /// Runs it.
    pub run: fn(&Options) -> Vec<Row>,
}

impl Case {
    /// Runs it, its floods and its dew on the GPU where `options` names one.
    pub fn rows(&self, options: &Options) -> Vec<Row> {
        let factor = if options.reduced { self.reduced } else { 1.0 };
        let run = || crate::device::on_gpu(options.gpu.clone(), || (self.run)(options));
        crate::missed::mark(crate::device::coarser(factor, run))
    }
}

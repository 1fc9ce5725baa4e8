//! An estimate of the water that is still to come.

use super::SphSweFlood;

impl SphSweFlood {
    /// About how many particles inflows bring from `from` to `until`, s. What leaves meanwhile is not taken off.
    pub fn particles_to_come(&self, from: f64, until: f64) -> f64 {
        self.sources.iter().map(|source| source.discharge.integral(from, until)).sum::<f64>() / self.volume
    }
}

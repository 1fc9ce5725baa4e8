//! Gauges that are placed while a flood runs.

use crate::error::setup;
use crate::extent::span;
use crate::gauges::PointGauge;
use crate::sph_swe::SphSweFlood;
use corpuscle_model::ModelError;

impl SphSweFlood {
    /// Places a gauge at a point in model coordinates: depth, level and velocity are measured there from now on, in columns after all
    /// others.
    ///
    /// # Errors
    /// [`ModelError::Setup`] where another gauge has the name, or the position lies outside the terrain.
    pub fn place_gauge(&mut self, name: &str, at: [f64; 2]) -> Result<(), ModelError> {
        let terrain = &self.surroundings.terrain;
        if !terrain.bounds().contains(at[0], at[1]) {
            let spans = span(terrain);
            return Err(setup(format!("the gauge '{name}' lies outside the terrain, which spans {spans}")));
        }
        let known =
            self.points.iter().map(|point| &point.name).chain(self.state.overrides.gauges.iter().map(|(name, _)| name));
        if known.into_iter().any(|known| known == name) {
            return Err(setup(format!("there is a gauge '{name}' already: give the new one another name")));
        }
        self.state.overrides.gauges.push((name.into(), at));
        Ok(())
    }

    /// The gauges that were placed.
    pub(in crate::sph_swe) fn placed(&self) -> impl Iterator<Item = PointGauge> {
        self.state.overrides.gauges.iter().map(|(name, at)| PointGauge { name: name.clone(), at: *at })
    }
}

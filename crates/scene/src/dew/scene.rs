//! What dew adds to a scene.

use super::{Dew, Face, Faces, HumidityTransport, Mean, Scheme, Shape};
use crate::check::{Check, Checked};
use crate::{ModelScene, Run, Series};
use std::path::PathBuf;

impl ModelScene for Dew {
    const NAME: &'static str = "dew";

    fn check(&self, check: &Check) -> Checked {
        check.dew(self)
    }

    fn resolve_defaults(&mut self, _run: &Run) {
        let is_physical = self.scheme == Scheme::Physical;
        let (mean, humidity) = match self.scheme {
            Scheme::Physical => (Mean::Harmonic, HumidityTransport::MassFraction),
            Scheme::ParticleCondensation => (Mean::Arithmetic, HumidityTransport::RelativeHumidity),
        };
        self.transport.conductivity_mean.get_or_insert(mean);
        self.transport.humidity.get_or_insert(humidity);
        self.transport.latent_heat.get_or_insert(is_physical);
    }

    fn paths(&mut self) -> Vec<&mut PathBuf> {
        let mut paths = Vec::new();
        for solid in &mut self.solid {
            if let Shape::Mesh(mesh) = &mut solid.shape {
                paths.push(&mut mesh.path);
            }
            if let Series::File { csv, .. } = &mut solid.temperature_c {
                paths.push(csv);
            }
        }
        let Faces { x_min, x_max, y_min, y_max, z_min, z_max } = &mut self.faces;
        for face in [x_min, x_max, y_min, y_max, z_min, z_max] {
            if let Face::Inflow(inflow) = face {
                paths.extend(inflow.paths());
            }
        }
        paths
    }
}

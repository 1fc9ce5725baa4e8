//! No films: this build has no encoder.

use super::subject::Subject;
use crate::view_state::ViewState;
use corpuscle::Error;
use corpuscle::gpu::Gpu;
use corpuscle::model::ModelError;
use corpuscle::pictures::Moment;
use std::convert::Infallible;
use std::path::{Path, PathBuf};

/// A film, of which there is none.
pub(super) struct Filming {
    none: Infallible,
    pub next: f64,
}

impl Filming {
    /// Refuses.
    pub fn begin(_: &Gpu, _: &Subject, _: &Path, _: f64) -> Result<Self, Error> {
        Err(ModelError::Setup("this program was built without films".into()).into())
    }

    pub fn add_if_due(&mut self, _: &Subject, _: &ViewState) -> Result<(), Error> {
        match self.none {}
    }

    pub fn add(&mut self, _: &Moment<'_>, _: &ViewState) -> Result<(), Error> {
        match self.none {}
    }

    pub fn finish(self) -> Result<PathBuf, Error> {
        match self.none {}
    }
}

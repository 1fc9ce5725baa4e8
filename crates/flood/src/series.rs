//! Values over time from a scene.

use crate::error::setup;
use corpuscle_model::ModelError;
use corpuscle_scene::{Series, Table};
use std::path::Path;

/// The table of a series; `folder` is what relative paths refer to.
pub(crate) fn load(series: &Series, folder: &Path) -> Result<Table, ModelError> {
    series.load(folder).map_err(setup)
}

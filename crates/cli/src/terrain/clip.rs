//! `corpuscle terrain clip`.

use super::{check_is_new, write};
use crate::args::ClipOptions;
use crate::output::print_json;
use corpuscle::terrain::read_rasters;
use serde_json::json;

/// Cuts a box out of terrain files.
pub fn clip(options: &ClipOptions, as_json: bool) -> anyhow::Result<()> {
    check_is_new(&options.output)?;
    let raster =
        read_rasters(&options.files, options.crs.as_deref(), Some(&options.bbox)).map_err(corpuscle::Error::from)?;
    write(&options.output, &raster)?;
    if as_json {
        print_json(&json!({
            "file": options.output,
            "columns": raster.columns,
            "rows": raster.rows,
            "warnings": raster.warnings,
        }))?;
    }
    Ok(())
}

//! Raster files as one raster.

use crate::conversion::Conversion;
use crate::mosaic::merge;
use crate::raster::{outside, refuse_empty};
use crate::system::ReferenceSystem;
use crate::{Georeference, MapBox, Raster, TerrainError, read_raster, read_raster_part, survey};
use std::path::{Path, PathBuf};

/// Cells beyond a part that are read too, so that values interpolated at its sides use the cells beyond.
const MARGIN: f64 = 2.0;

/// Reads raster files as one raster, as [`merge`] says: all of them, or the cells that share area with `part`, given in
/// the first one's coordinates. `crs` is the reference system of those that name none: `EPSG:27700` or a PROJ string.
///
/// # Errors
/// As [`read_raster`] and [`merge`]; where no file is named, and where none of them has data in `part`.
pub fn read_rasters(paths: &[PathBuf], crs: Option<&str>, part: Option<&MapBox>) -> Result<Raster, TerrainError> {
    let first = paths.first().ok_or_else(|| TerrainError::unusable(Path::new(""), "no file is named"))?;
    let mut common = survey(first)?;
    choose_system(&mut common.georeference, crs, first)?;
    let mut warnings: Vec<(&Path, String)> = Vec::new();
    let mut rasters = Vec::new();
    for path in paths {
        let Some(mut raster) = read(path, crs, part, common.georeference.system.as_ref())? else { continue };
        let warning = choose_system(&mut raster.georeference, crs, path)?;
        warnings.extend(warning.into_iter().map(|warning| (path.as_path(), warning)));
        rasters.push((path.clone(), raster));
    }
    let mut raster = match (rasters.len(), part) {
        (0, Some(part)) => return Err(outside(first, part, &common.outline())),
        (1, _) => rasters.swap_remove(0).1,
        _ => merge(rasters)?,
    };
    if let Some(part) = part {
        raster = raster.cropped(part).ok_or_else(|| outside(first, part, &common.outline()))?;
        refuse_empty(first, &raster)?;
    }
    raster.warnings.extend(without_repeats(warnings));
    Ok(raster)
}

/// A file, or the cells of it in a part given in the system `common`, with a margin; none where it has none there.
fn read(
    path: &Path,
    crs: Option<&str>,
    part: Option<&MapBox>,
    common: Option<&ReferenceSystem>,
) -> Result<Option<Raster>, TerrainError> {
    let Some(part) = part else { return read_raster(path).map(Some) };
    let mut survey = survey(path)?;
    choose_system(&mut survey.georeference, crs, path)?;
    let part = Conversion::between(common, survey.georeference.system.as_ref())
        .and_then(|conversion| conversion.map_box(part))
        .map_err(|what| TerrainError::unusable(path, what))?;
    if !part.meets(&survey.outline()) {
        return Ok(None);
    }
    let [dx, dy] = survey.georeference.cell.map(|cell| MARGIN * cell);
    let MapBox { west, south, east, north } = part;
    read_raster_part(path, &MapBox { west: west - dx, south: south - dy, east: east + dx, north: north + dy }).map(Some)
}

/// Each warning once, not for each file.
fn without_repeats(warnings: Vec<(&Path, String)>) -> Vec<String> {
    let mut seen = Vec::new();
    let mut kept = Vec::new();
    for (path, warning) in warnings {
        let gist = warning.replace(&path.display().to_string(), "");
        if !seen.contains(&gist) {
            seen.push(gist);
            kept.push(warning);
        }
    }
    kept
}

/// Settles the reference system from what the file and the scene say; returns a warning, if any.
pub(crate) fn choose_system(
    georeference: &mut Georeference,
    crs: Option<&str>,
    path: &Path,
) -> Result<Vec<String>, TerrainError> {
    let named = crs.map(ReferenceSystem::parse).transpose()?;
    let file = path.display();
    let mut warnings = Vec::new();
    match (&georeference.system, named) {
        (Some(own), Some(named)) if own.name != named.name => warnings.push(format!(
            "{file} is in {}; the scene's crs = \"{}\" is for files that name none, and is not used.",
            own.name, named.name
        )),
        (None, Some(named)) => *georeference = georeference.clone().with_system(named),
        (None, None) => warnings.push(format!(
            "{file} names no reference system: its coordinates are taken as metres without a place on Earth. Name it \
             with `crs` in [terrain.file] if you know it."
        )),
        (Some(_), _) => {}
    }
    warnings.extend(georeference.system.as_ref().and_then(ReferenceSystem::warning));
    Ok(warnings)
}

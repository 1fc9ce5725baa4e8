//! Heights from a tile on the server.

use crate::FetchError;
use crate::glo30::{ROWS, TileName};
use crate::remote::RemoteFile;
use corpuscle_terrain::{Georeference, MapBox, Raster, Window};
use geotiff_reader::geokeys::GeoKeyDirectory;
use geotiff_reader::transform::GeoTransform;
use std::sync::Arc;
use tiff_reader::{Ifd, TiffFile};

/// TIFF tags (GeoTIFF 1.1, 7.1.1).
const PIXEL_SCALE: u16 = 33550;
const TIEPOINT: u16 = 33922;
const KEYS: u16 = 34735;
/// GeoTIFF key that says whether a tiepoint is the corner or the centre of a cell, and its value for the centre.
const RASTER_TYPE: u16 = 1025;
const POINT: u16 = 2;

/// Cells beyond a part that are read too.
const MARGIN: f64 = 1.0;

/// The heights of a tile in a part; none where none of its cells lies there.
pub(crate) fn read(
    name: TileName,
    url: &str,
    file: &Arc<RemoteFile>,
    part: &MapBox,
) -> Result<Option<Raster>, FetchError> {
    // The reader passes on only the text of a failed request; the source has the error.
    let failed = |error: tiff_reader::error::Error| {
        file.failure().unwrap_or_else(|| FetchError::no_tile(url, format!("it cannot be read: {error}")))
    };
    let tiff = TiffFile::from_source(file.clone()).map_err(failed)?;
    let image = tiff.ifd(0).map_err(failed)?;
    let place = place(name, image).map_err(|what| FetchError::no_tile(url, what))?;
    let Some(window) = window(&place, name, part) else { return Ok(None) };
    let ([column, row], [columns, rows]) = (window.first, window.size);
    let heights = tiff.read_band_window::<f32>(0, 0, row, column, rows, columns).map_err(failed)?;
    let values = heights.iter().map(|height| f64::from(*height)).collect();
    Ok(Some(Raster { columns, rows, values, georeference: place.from_cell(window.first), warnings: Vec::new() }))
}

/// Sea instead of a tile that does not exist: height 0.
pub(crate) fn sea(name: TileName, part: &MapBox) -> Option<Raster> {
    let place = name.place();
    let window = window(&place, name, part)?;
    let [columns, rows] = window.size;
    let georeference = place.from_cell(window.first);
    Some(Raster { columns, rows, values: vec![0.0; columns * rows], georeference, warnings: Vec::new() })
}

fn window(place: &Georeference, name: TileName, part: &MapBox) -> Option<Window> {
    let size = [name.columns(), ROWS];
    // A part that only touches the tile's side needs nothing of it.
    Window::within(place, size, part)?;
    let [dx, dy] = place.cell.map(|cell| MARGIN * cell);
    let MapBox { west, south, east, north } = *part;
    Window::within(place, size, &MapBox { west: west - dx, south: south - dy, east: east + dx, north: north + dy })
}

/// Georeference of the cells from the file, which must agree with its name.
fn place(name: TileName, image: &Ifd) -> Result<Georeference, String> {
    let size = [image.width() as usize, image.height() as usize];
    if size != [name.columns(), ROWS] {
        let [columns, rows] = size;
        return Err(format!("it has {columns} x {rows} cells instead of {} x {ROWS}", name.columns()));
    }
    let numbers = |tag: u16| image.tag(tag).and_then(|tag| tag.value.as_f64_vec());
    let (Some(scale), Some(tie)) = (numbers(PIXEL_SCALE), numbers(TIEPOINT)) else {
        return Err("it has no georeference".into());
    };
    let (Ok(scale), Ok(tie)) = (scale.try_into(), tie.try_into()) else {
        return Err("its georeference is invalid".into());
    };
    let keys = image.tag(KEYS).and_then(|tag| tag.value.as_u16_slice());
    let keys = keys.and_then(|keys| GeoKeyDirectory::parse(keys, &[], ""));
    let mut own = GeoTransform::from_tiepoint_and_scale(&tie, &scale);
    if keys.and_then(|keys| keys.get_short(RASTER_TYPE)) == Some(POINT) {
        own.origin_x -= 0.5 * own.pixel_width;
        own.origin_y -= 0.5 * own.pixel_height;
    }
    let expected = name.place();
    let off = [own.origin_x - expected.corner[0], own.origin_y - expected.corner[1]];
    let cell = [own.pixel_width, own.pixel_height.abs()];
    let fits = (0..2).all(|axis| {
        off[axis].abs() < 0.1 * expected.cell[axis] && (cell[axis] / expected.cell[axis] - 1.0).abs() < 1e-6
    });
    if fits {
        Ok(expected)
    } else {
        Err(format!(
            "its corner is at {}, {} with cells of {} x {} degrees",
            own.origin_x, own.origin_y, cell[0], cell[1]
        ))
    }
}

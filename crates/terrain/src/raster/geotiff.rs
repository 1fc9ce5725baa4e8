//! GeoTIFF, read with the `geotiff-reader` library.

use super::{MapBox, Raster, Survey, Values, Window, check_not_empty, check_size, in_memory, memory, outside};
use crate::system::{ReferenceSystem, height_unit};
use crate::{Georeference, TerrainError};
use geotiff_reader::geokeys::{self, GeoKey, GeoKeyDirectory, GeoKeyValue};
use geotiff_reader::transform::GeoTransform;
use geotiff_reader::{Error as ReaderError, GeoTiffFile, Result as ReaderResult};
use std::path::Path;
use tiff_reader::TiffSample;

/// No compression in use makes terrain this many times smaller (Deflate reaches 1032 and LZW 2700 on a constant; a
/// block left out of a sparse file takes 16 bytes): a header that claims more is broken.
const LARGEST_COMPRESSION: u64 = 20_000;

/// GDAL's own tag of metadata, XML: scale and offset of the samples among it.
const GDAL_METADATA: u16 = 42112;

/// Reads the first band of a GeoTIFF, whose first bytes say whether it is big-endian: all of it, or the cells in `part`. Heights become metres.
pub(super) fn read(path: &Path, big_endian: bool, part: Option<&MapBox>, kind: Values) -> Result<Raster, TerrainError> {
    let file = open(path)?;
    let size = [file.width() as usize, file.height() as usize];
    if part.is_none() {
        check_size(path, size)?;
    }
    check_compression(path, &file, big_endian)?;
    let format = check_bytes(path, &file)?;
    let mut whole = georeference(path, &file)?;
    let window = match part {
        Some(part) => Window::within(&whole, size, part).ok_or_else(|| outside(path, part, &whole.outline(size)))?,
        None => Window::whole(size),
    };
    check_size(path, window.size)?;
    let mut warnings = Vec::new();
    if file.band_count() > 1 {
        warnings.push(format!("{} has {} bands; the first is used.", path.display(), file.band_count()));
    }
    let mut values = values(path, &file, &format, &window)?;
    if let Some([scale, offset]) = scaling(&file) {
        values.iter_mut().for_each(|value| *value = *value * scale + offset);
        warnings.push(format!("{} gives its values times {scale} plus {offset}, as it says.", path.display()));
    }
    let unit = height_unit(file.geokeys());
    if unit != 1.0 && kind == Values::Heights {
        name_metres(&mut whole.keys);
        values.iter_mut().for_each(|value| *value *= unit);
        warnings.push(format!("{} gives its values in units of {unit} m; they were converted.", path.display()));
    }
    let [columns, rows] = window.size;
    Ok(Raster { columns, rows, values, georeference: whole.from_cell(window.first), warnings })
}

/// Scale and offset of the first band, where the file has them.
fn scaling(file: &GeoTiffFile) -> Option<[f64; 2]> {
    let image = file.tiff().ifd(file.base_ifd_index()).ok()?;
    scaling_in(image.tag(GDAL_METADATA)?.value.as_str()?)
}

/// The same by the text of GDAL's metadata, as `<Item name="SCALE" sample="0" role="scale">0.1</Item>`.
fn scaling_in(text: &str) -> Option<[f64; 2]> {
    let of = |role: &str| {
        text.split("<Item").skip(1).find_map(|item| {
            let (attributes, rest) = item.split_once('>')?;
            let is_first = !attributes.contains("sample=") || attributes.contains("sample=\"0\"");
            let is_meant = is_first && attributes.contains(&format!("role=\"{role}\""));
            let value: f64 = rest.split('<').next().filter(|_| is_meant)?.trim().parse().ok()?;
            value.is_finite().then_some(value)
        })
    };
    let (scale, offset) = (of("scale"), of("offset"));
    let found = [scale.unwrap_or(1.0), offset.unwrap_or(0.0)];
    (found != [1.0, 0.0]).then_some(found)
}

/// Has keys say that heights are in metres.
fn name_metres(keys: &mut GeoKeyDirectory) {
    // A vertical system that is one in feet has no key of its own in metres.
    keys.keys.retain(|key| key.id != geokeys::VERTICAL_CS_TYPE || !is_in_feet(&key.value));
    let metres = GeoKeyValue::Short(9001);
    match keys.keys.iter_mut().find(|key| key.id == geokeys::VERTICAL_UNITS) {
        Some(key) => key.value = metres,
        None => keys.keys.push(GeoKey { id: geokeys::VERTICAL_UNITS, value: metres }),
    }
}

fn is_in_feet(system: &GeoKeyValue) -> bool {
    matches!(system, GeoKeyValue::Short(6360 | 8228))
}

/// Refuses a file whose header says more than its bytes can hold; returns how it stores its samples.
pub(super) fn check_bytes(path: &Path, file: &GeoTiffFile) -> Result<SampleFormat, TerrainError> {
    let bytes = memory::length(path).map_err(|error| TerrainError::read(path, error))?;
    let format = SampleFormat::of(file).map_err(|error| refused(path, &error))?;
    let [columns, rows] = [file.width(), file.height()].map(u64::from);
    if (columns * rows).saturating_mul(u64::from(format.bits)) / 8 > bytes.saturating_mul(LARGEST_COMPRESSION) {
        let what = format!("its header says {columns} x {rows} cells, which its {bytes} bytes cannot hold");
        return Err(TerrainError::damaged(path, what));
    }
    Ok(format)
}

/// What a file says of itself.
pub(super) fn survey(path: &Path) -> Result<Survey, TerrainError> {
    let file = open(path)?;
    let samples = check_bytes(path, &file)?.in_words();
    Ok(Survey {
        columns: file.width() as usize,
        rows: file.height() as usize,
        georeference: georeference(path, &file)?,
        format: "GeoTIFF",
        samples,
        height_unit_m: height_unit(file.geokeys()),
    })
}

pub(super) fn open(path: &Path) -> Result<GeoTiffFile, TerrainError> {
    let file = match in_memory(path) {
        Some(bytes) => GeoTiffFile::from_bytes(bytes.to_vec()),
        None => GeoTiffFile::open(path),
    };
    let file = file.map_err(|error| match error {
        ReaderError::NotGeoTiff => nowhere(path),
        error => refused(path, &error),
    })?;
    check_not_empty(path, [file.width() as usize, file.height() as usize])?;
    Ok(file)
}

fn nowhere(path: &Path) -> TerrainError {
    TerrainError::unusable(path, "it says nowhere where it lies; add its corners with `gdal_edit.py -a_ullr`")
}

/// Where the whole of a file lies; refuses turned and mirrored rasters.
pub(super) fn georeference(path: &Path, file: &GeoTiffFile) -> Result<Georeference, TerrainError> {
    let transform: &GeoTransform = file.transform().ok_or_else(|| nowhere(path))?;
    if transform.skew_x != 0.0 || transform.skew_y != 0.0 || transform.pixel_width < 0.0 {
        let what = "it is turned or mirrored against north; straighten it with `gdalwarp`";
        return Err(TerrainError::unusable(path, what));
    }
    let height = transform.pixel_height;
    let north = if south_first(file) { f64::from(file.height()) * height } else { 0.0 };
    Ok(Georeference {
        corner: [transform.origin_x, transform.origin_y + north],
        cell: [transform.pixel_width, height.abs()],
        system: ReferenceSystem::from_keys(file.geokeys()).map_err(|what| TerrainError::unusable(path, what))?,
        keys: file.geokeys().clone(),
    })
}

/// True for a file whose first row is the south row.
pub(super) fn south_first(file: &GeoTiffFile) -> bool {
    file.transform().is_some_and(|transform| transform.pixel_height > 0.0)
}

/// What is wrong with a file that the library does not read.
pub(super) fn refused(path: &Path, error: &ReaderError) -> TerrainError {
    let what = error.to_string();
    // The library's own error type, which has the cause, is not part of its interface.
    if what.contains("unsupported") {
        return TerrainError::unusable(path, format!("{what}; convert it with `gdal_translate -co COMPRESS=DEFLATE`"));
    }
    TerrainError::damaged(path, what)
}

/// Refuses LERC in big-endian files, whose bytes the library (0.10) turns round although LERC's own order is fixed.
fn check_compression(path: &Path, file: &GeoTiffFile, big_endian: bool) -> Result<(), TerrainError> {
    const LERC: u16 = 34887;
    let image = file.tiff().ifd(file.base_ifd_index()).map_err(|error| refused(path, &error.into()))?;
    if image.compression() == LERC && big_endian {
        let what = "LERC in a big-endian file is not read; convert it with `gdal_translate -co COMPRESS=DEFLATE`";
        return Err(TerrainError::unusable(path, what));
    }
    Ok(())
}

/// How a file stores its samples.
pub(super) struct SampleFormat {
    /// TIFF code: 1 unsigned, 2 signed, 3 floating point.
    pub(super) code: u16,
    pub(super) bits: u16,
}

impl SampleFormat {
    pub(super) fn of(file: &GeoTiffFile) -> ReaderResult<Self> {
        let image = file.tiff().ifd(file.base_ifd_index())?;
        let first = |values: Vec<u16>| values.first().copied().unwrap_or(1);
        Ok(Self { code: first(image.sample_format()?), bits: first(image.bits_per_sample()?) })
    }

    fn in_words(&self) -> String {
        let kind = match self.code {
            1 => "unsigned integers",
            2 => "signed integers",
            3 => "floating point",
            _ => "of an unknown kind",
        };
        format!("{}-bit {kind}", self.bits)
    }
}

/// The values of the first band in a window, from the north row on, not-a-number where there are none.
fn values(path: &Path, file: &GeoTiffFile, format: &SampleFormat, window: &Window) -> Result<Vec<f64>, TerrainError> {
    let no_data: Option<f64> = file.nodata().and_then(|text| text.trim().parse().ok());
    // A mark that the sample type cannot hold marks no cell; one in single precision is compared as such.
    let exact = |value: f64| Some(value) == no_data;
    let band = Band { path, file, window };
    match (format.code, format.bits) {
        (1, 1..=8) => band.read(|v: u8| f64::from(v), exact),
        (1, 9..=16) => band.read(|v: u16| f64::from(v), exact),
        (1, 32) => band.read(|v: u32| f64::from(v), exact),
        (1, 64) => band.read(|v: u64| v as f64, exact),
        (2, 8) => band.read(|v: i8| f64::from(v), exact),
        (2, 16) => band.read(|v: i16| f64::from(v), exact),
        (2, 32) => band.read(|v: i32| f64::from(v), exact),
        (2, 64) => band.read(|v: i64| v as f64, exact),
        (3, 32) => band.read(|v: f32| f64::from(v), |value| Some(value as f32) == no_data.map(|v| v as f32)),
        (3, 64) => band.read(|v: f64| v, exact),
        (code, bits) => Err(TerrainError::unusable(
            path,
            format!(
                "its samples (TIFF sample format {code}, {bits} bits) are of a kind that cannot be read; convert it with \
                 `gdal_translate -ot Float32`"
            ),
        )),
    }
}

/// A window of the first band.
struct Band<'a> {
    path: &'a Path,
    file: &'a GeoTiffFile,
    window: &'a Window,
}

impl Band<'_> {
    /// Its samples, converted by `number`, without those for which `is_no_data` holds, from the north row on.
    fn read<T: TiffSample + Copy>(
        &self,
        number: impl Fn(T) -> f64,
        is_no_data: impl Fn(f64) -> bool,
    ) -> Result<Vec<f64>, TerrainError> {
        let Window { first: [column, row], size: [columns, rows] } = *self.window;
        let south_first = south_first(self.file);
        let row = if south_first { self.file.height() as usize - row - rows } else { row };
        let samples = self.file.read_band_window::<T>(0, row, column, rows, columns);
        let samples = samples.map_err(|error| refused(self.path, &error))?;
        let with_holes = |value: f64| if is_no_data(value) { f64::NAN } else { value };
        let mut values: Vec<f64> = samples.iter().map(|sample| with_holes(number(*sample))).collect();
        if south_first {
            turn_over(&mut values, columns);
        }
        Ok(values)
    }
}

/// Puts the last row first.
fn turn_over(values: &mut [f64], columns: usize) {
    let rows = values.len() / columns;
    for row in 0..rows / 2 {
        let (above, below) = values.split_at_mut((rows - 1 - row) * columns);
        above[row * columns..][..columns].swap_with_slice(&mut below[..columns]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scale_and_offset_are_those_of_the_first_band() {
        let item = |sample: &str, role: &str, value: &str| {
            format!("  <Item name=\"X\"{sample} role=\"{role}\">{value}</Item>\n")
        };
        let text = |items: &str| format!("<GDALMetadata>\n{items}</GDALMetadata>");
        let first = " sample=\"0\"";
        let both = item(first, "scale", "0.01") + &item(first, "offset", "-5");
        assert_eq!(scaling_in(&text(&both)), Some([0.01, -5.0]));
        assert_eq!(scaling_in(&text(&item("", "scale", "0.1"))), Some([0.1, 0.0]));
        for none in [
            item(" sample=\"1\"", "scale", "0.1"),
            item(first, "scale", "1"),
            item(first, "unittype", "m"),
            item(first, "scale", "inf"),
            String::new(),
        ] {
            assert_eq!(scaling_in(&text(&none)), None, "{none}");
        }
    }
}

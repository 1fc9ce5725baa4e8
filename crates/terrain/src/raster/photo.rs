//! Aerial photos: GeoTIFF files with colours.

use super::geotiff::{SampleFormat, georeference, open, refused, south_first};
use super::{Window, check_size, geotiff, memory};
use crate::{Georeference, Terrain, TerrainError};
use geotiff_reader::GeoTiffFile;
use proj4rs::Proj;
use std::path::{Path, PathBuf};
use tiff_reader::{ColorModel, ExtraSample, TiffSample};

/// An aerial photo with its position on Earth, a GeoTIFF.
pub struct Photo {
    path: PathBuf,
    file: GeoTiffFile,
    georeference: Georeference,
    system: Option<Proj>,
}

impl Photo {
    /// Opens a file, without reading its colours.
    ///
    /// # Errors
    /// [`TerrainError`] for a file that is no GeoTIFF, is damaged, or does not say where it lies.
    pub fn open(path: &Path) -> Result<Self, TerrainError> {
        memory::open(path).map_err(|error| TerrainError::read(path, error))?;
        let file = open(path)?;
        let georeference = georeference(path, &file)?;
        geotiff::check_bytes(path, &file)?;
        let system = georeference.system.as_ref().and_then(|system| system.projection());
        Ok(Self { path: path.to_owned(), file, georeference, system })
    }

    /// Numbers of columns and rows.
    pub fn size(&self) -> [usize; 2] {
        [self.file.width() as usize, self.file.height() as usize]
    }

    /// Column and row at a position of a terrain, m, whole at middles of pixels. Where either has no known position on Earth, their own
    /// coordinates are taken for the same. None where the photo's reference system does not reach.
    pub fn pixel(&self, terrain: &Terrain, position: [f64; 2]) -> Option<[f64; 2]> {
        let own = terrain.to_own(position);
        let frame = terrain.frame();
        let there = match &self.system {
            Some(system) if frame.is_known() => frame.own_to(system, own)?,
            _ => own,
        };
        Some(self.georeference.position(there))
    }

    /// Red, green, blue and opacity of the pixels of a window, row by row from the north.
    ///
    /// # Errors
    /// [`TerrainError`] for more pixels than can be used, colours of another kind, or a damaged file.
    pub fn read(&self, window: Window) -> Result<Vec<u8>, TerrainError> {
        check_size(&self.path, window.size)?;
        let format = SampleFormat::of(&self.file).map_err(|error| refused(&self.path, &error))?;
        match (format.code, format.bits) {
            (1, 1..=8) => self.colours(window, |sample: u8| sample),
            (1, 9..=16) => self.colours(window, |sample: u16| (sample >> 8) as u8),
            _ => Err(self.unusable("its colours are not whole numbers of 8 or 16 bits")),
        }
    }

    fn colours<T: TiffSample + Copy>(&self, window: Window, byte: impl Fn(T) -> u8) -> Result<Vec<u8>, TerrainError> {
        let Window { first: [column, row], size: [columns, rows] } = window;
        let flipped = south_first(&self.file);
        let first_row = if flipped { self.size()[1] - row - rows } else { row };
        let samples = self.file.read_decoded_window::<T>(first_row, column, rows, columns);
        let samples = samples.map_err(|error| refused(&self.path, &error))?;
        let channels = samples.len() / (columns * rows);
        let [colours, opacity] = self.channels()?;
        if channels < colours.max(1) {
            return Err(self.unusable("its colours are of a kind that cannot be read"));
        }
        let bytes: Vec<u8> = samples.iter().map(|sample| byte(*sample)).collect();
        let no_data: Option<u8> = self.file.nodata().and_then(|text| text.trim().parse().ok());
        let mut rgba = Vec::with_capacity(4 * columns * rows);
        for at in 0..rows {
            let at = if flipped { rows - 1 - at } else { at };
            for pixel in bytes[at * columns * channels..][..columns * channels].chunks_exact(channels) {
                let colour = if colours == 3 { [pixel[0], pixel[1], pixel[2]] } else { [pixel[0]; 3] };
                let is_empty = no_data.is_some_and(|no_data| colour == [no_data; 3]);
                let opaque = if opacity < channels { pixel[opacity] } else { u8::MAX };
                rgba.extend([colour[0], colour[1], colour[2], if is_empty { 0 } else { opaque }]);
            }
        }
        Ok(rgba)
    }

    /// How many channels are colours, and which is the opacity (beyond the last where none is).
    fn channels(&self) -> Result<[usize; 2], TerrainError> {
        let image = self.file.tiff().ifd(self.file.base_ifd_index());
        let model = image.and_then(|image| image.color_model());
        let model = model.map_err(|error| refused(&self.path, &error.into()))?;
        let (colours, extra) = match model {
            ColorModel::Grayscale { extra_samples, .. } => (1, extra_samples),
            ColorModel::Rgb { extra_samples } | ColorModel::Palette { extra_samples, .. } => (3, extra_samples),
            ColorModel::YCbCr { extra_samples, .. } => (3, extra_samples),
            _ => return Err(self.unusable("its colours are neither grey nor red, green and blue")),
        };
        let is_opacity =
            |extra: &ExtraSample| matches!(extra, ExtraSample::AssociatedAlpha | ExtraSample::UnassociatedAlpha);
        let opacity = extra.iter().position(is_opacity).map_or(usize::MAX, |extra| colours + extra);
        Ok([colours, opacity])
    }

    fn unusable(&self, what: &str) -> TerrainError {
        TerrainError::unusable(&self.path, format!("{what}; convert it with `gdal_translate -ot Byte -expand rgb`"))
    }
}

//! Rasters: GeoTIFF and ESRI ASCII.

use super::{none, on_file, path_of};
use crate::Target;
use corpuscle::gpu::Image;
use corpuscle::pictures::ground_picture;
use corpuscle_terrain::{
    Bounds, MapBox, Photo, Terrain, TerrainError, Window, read_raster, read_raster_part, read_rasters, summarize,
};
use flate2::write::GzEncoder;
use flate2::{Compression, Crc};
use std::io::Write;
use std::path::Path;

pub(super) const TARGETS: &[Target] = &[
    Target { name: "geotiff", about: "GeoTIFF", corpus: "geotiff", read: geotiff, more: none },
    Target { name: "photo", about: "aerial photos, GeoTIFF", corpus: "photo", read: photo, more: none },
    Target { name: "png", about: "pictures on the ground, PNG", corpus: "png", read: png, more: none },
    Target { name: "world-file", about: "world files of pictures", corpus: "world-file", read: world_file, more: none },
    Target { name: "ascii", about: "ESRI ASCII grids", corpus: "ascii", read: ascii, more: none },
    Target { name: "ascii-gz", about: "ESRI ASCII grids, compressed", corpus: "ascii-gz", read: ascii_gz, more: none },
];

/// Whole, in part, with others, in summary.
fn by_all(path: &Path) -> Result<String, String> {
    let part = MapBox::new([50.0, 50.0, 150.0, 250.0])?;
    let whole = read_raster(path).map(|raster| raster.warnings.len());
    let cut = read_raster_part(path, &part).map(|raster| raster.warnings.len());
    let several =
        read_rasters(&[path.to_owned(), path.to_owned()], None, Some(&part)).map(|raster| raster.warnings.len());
    let summary = summarize(path, None).map(|_| 0);
    let mut words = String::new();
    for answer in [whole, cut, several, summary] {
        words += &answer.map_err(|error| without(&error.to_string(), path))?.to_string();
    }
    Ok(words)
}

/// A message without the path, which differs from run to run.
fn without(message: &str, path: &Path) -> String {
    message.replace(&path.display().to_string(), "")
}

fn geotiff(bytes: &[u8]) -> Result<String, String> {
    on_file("a.tif", bytes, by_all)
}

fn photo(bytes: &[u8]) -> Result<String, String> {
    on_file("a.tif", bytes, |path| {
        let words = |error: TerrainError| without(&error.to_string(), path);
        let bounds = Bounds { x_min: 100.0, x_max: 340.0, y_min: 140.0, y_max: 300.0 };
        let terrain = Terrain::gridded(bounds, 20.0, |_, _| 0.0);
        let photo = Photo::open(path).map_err(words)?;
        let pixel = photo.pixel(&terrain, [200.0, 200.0]);
        let rgba = photo.read(Window::whole(photo.size())).map_err(words)?;
        Ok(format!("{pixel:?} {}", rgba.len()))
    })
}

fn png(bytes: &[u8]) -> Result<String, String> {
    // Sizes in messages would make every refusal a new one.
    let words = |text: String| -> String { text.chars().filter(|letter| !letter.is_ascii_digit()).collect() };
    on_file("png/a.png", &with_checksums(bytes), on_ground).map_err(words)
}

/// A PNG file with the checksums of its chunks set right: else hardly any that is changed would be read beyond the first.
fn with_checksums(bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let mut at = 8;
    while let Some(&[a, b, c, d]) = bytes.get(at..at + 4) {
        let end = at + 8 + u32::from_be_bytes([a, b, c, d]) as usize;
        let Some(chunk) = bytes.get(at + 4..end) else { break };
        let mut sum = Crc::new();
        sum.update(chunk);
        let Some(stored) = bytes.get_mut(end..end + 4) else { break };
        stored.copy_from_slice(&sum.sum().to_be_bytes());
        at = end + 4;
    }
    bytes
}

/// Of a picture of 2 x 2 pixels.
fn world_file(bytes: &[u8]) -> Result<String, String> {
    let picture = path_of("world-file/a.png");
    on_file("world-file/a.pgw", bytes, |_| {
        std::fs::write(&picture, include_bytes!("../../corpus/png/rgb.png")).expect("a temporary file can be written");
        on_ground(&picture)
    })
}

/// Laid on ground of 10 m x 10 m.
fn on_ground(path: &Path) -> Result<String, String> {
    let bounds = Bounds { x_min: 0.0, x_max: 10.0, y_min: 0.0, y_max: 10.0 };
    let terrain = Terrain::gridded(bounds, 1.0, |_, _| 0.0);
    let natural = Image { width: 8, height: 8, rgba: vec![9; 4 * 64] };
    let laid = ground_picture(path, &terrain, &natural).map_err(|error| without(&error.to_string(), path))?;
    assert_eq!(laid.rgba.len(), 4 * laid.width as usize * laid.height as usize);
    Ok("a picture".into())
}

fn ascii(bytes: &[u8]) -> Result<String, String> {
    on_file("a.asc", bytes, by_all)
}

/// Bytes that are not compressed are compressed first.
fn ascii_gz(bytes: &[u8]) -> Result<String, String> {
    if bytes.starts_with(&[0x1f, 0x8b]) {
        return on_file("a.asc.gz", bytes, by_all);
    }
    let mut writer = GzEncoder::new(Vec::new(), Compression::fast());
    writer.write_all(bytes).map_err(|error| error.to_string())?;
    on_file("a.asc.gz", &writer.finish().map_err(|error| error.to_string())?, by_all)
}

//! The ground of a scene.

use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The `[terrain]` table: exactly one of `[terrain.file]`, `[terrain.tiles]`, `[terrain.fetch]`,
/// `[terrain.valley]`, `[terrain.rough-hills]`, `[terrain.plane]`, `[terrain.bump]`, `[terrain.bowl]`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Terrain {
    /// A raster file: GeoTIFF or ESRI ASCII grid (also .gz).
    File(TerrainFile),
    /// Several raster files as one.
    Tiles(TerrainTiles),
    /// Copernicus GLO-30, fetched at first use.
    Fetch(TerrainFetch),
    /// A generated meandering valley.
    Valley(Valley),
    /// Generated random rough hills.
    RoughHills(RoughHills),
    /// An even plane.
    Plane(Plane),
    /// Gaussian bumps on a flat bed.
    Bump(Bump),
    /// A bowl whose bed is a paraboloid of revolution.
    Bowl(Bowl),
}

/// A raster file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TerrainFile {
    /// The file, relative to the scene's folder.
    pub path: PathBuf,
    /// The reference system where the file names none: `EPSG:27700` or a PROJ string. Left out: metres without a position
    /// on Earth, with a warning.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crs: Option<String>,
    /// What cells without data are.
    #[serde(default)]
    pub no_data: NoData,
}

/// Several raster files as one, on the grid of the finest of those in the first one's reference system.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TerrainTiles {
    /// The files, relative to the scene's folder. Where they overlap the one named first counts.
    pub paths: Vec<PathBuf>,
    /// The reference system of those that name none, as in [`TerrainFile::crs`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crs: Option<String>,
    /// What cells without data, and gaps between the files, are.
    #[serde(default)]
    pub no_data: NoData,
}

/// A box of the Copernicus digital elevation model GLO-30, fetched from the public server at first use.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TerrainFetch {
    /// The box `[west, south, east, north]`, longitudes and latitudes in degrees.
    pub bbox: [f64; 4],
    /// What cells without data are.
    #[serde(default)]
    pub no_data: NoData,
}

/// What cells without data are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NoData {
    /// Ground too high for water to climb.
    #[default]
    Wall,
    /// Filled smoothly from the cells round them.
    Fill,
}

/// Size of generated ground.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Extent {
    /// Extent eastwards, m.
    pub length_m: f64,
    /// Extent northwards, m.
    pub width_m: f64,
    /// Cell size, m.
    pub cell_m: f64,
}

impl Default for Extent {
    fn default() -> Self {
        Self { length_m: 2000.0, width_m: 1000.0, cell_m: 5.0 }
    }
}

/// A generated meandering valley falling from west to east, with a channel, a flood plain and rough slopes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Valley {
    /// Size of the ground.
    pub extent: Extent,
    /// Fall of the valley floor, m per m.
    pub slope: f64,
    /// Width of the channel, m.
    pub channel_width_m: f64,
    /// Depth of the channel below the flood plain, m.
    pub channel_depth_m: f64,
    /// Width of the flood plain, m.
    pub plain_width_m: f64,
    /// Swing of the meanders to each side, m.
    pub meander_m: f64,
    /// Length of one meander, m.
    pub meander_length_m: f64,
    /// Height of the hills beside the valley, m.
    pub hills_m: f64,
}

impl Default for Valley {
    fn default() -> Self {
        Self {
            extent: Extent::default(),
            slope: 0.004,
            channel_width_m: 40.0,
            channel_depth_m: 3.0,
            plain_width_m: 260.0,
            meander_m: 110.0,
            meander_length_m: 700.0,
            hills_m: 60.0,
        }
    }
}

/// Generated random rough hills: fractal noise.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RoughHills {
    /// Size of the ground.
    pub extent: Extent,
    /// Height from lowest to highest, m.
    pub relief_m: f64,
    /// Size of the largest hills, m.
    pub hill_size_m: f64,
    /// Each finer octave's height over the coarser one's.
    pub roughness: f64,
}

impl Default for RoughHills {
    fn default() -> Self {
        Self { extent: Extent::default(), relief_m: 20.0, hill_size_m: 100.0, roughness: 0.5 }
    }
}

/// An even plane.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Plane {
    /// Size of the ground.
    pub extent: Extent,
    /// Rise eastwards, m per m.
    pub slope_east: f64,
    /// Rise northwards, m per m.
    pub slope_north: f64,
    /// Height at the middle, m.
    pub height_m: f64,
}

/// Gaussian bumps on a flat bed: height exp(-r^2 / (2 width^2)).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Bump {
    /// Size of the ground.
    pub extent: Extent,
    /// Height of the bump, m.
    pub height_m: f64,
    /// Standard deviation of the bump, m.
    pub width_m: f64,
    /// Position of the top `[x, y]`. Left out: the middle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 2]>,
}

impl Default for Bump {
    fn default() -> Self {
        Self { extent: Extent::default(), height_m: 5.0, width_m: 10.0, at: None }
    }
}

/// A paraboloid of revolution: -depth (1 - r^2 / radius^2) about the middle (Thacker 1981).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Bowl {
    /// Size of the ground.
    pub extent: Extent,
    /// Depth of the middle below the height 0, m.
    pub depth_m: f64,
    /// Radius at which the bed reaches the height 0, m.
    pub radius_m: f64,
}

impl Default for Bowl {
    fn default() -> Self {
        Self { extent: Extent::default(), depth_m: 0.1, radius_m: 1.0 }
    }
}

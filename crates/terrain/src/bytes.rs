//! Terrain as bytes, for another part of the program that shares no memory.

use crate::frame::Frame;
use crate::surface::{Surface, SurfaceParts};
use crate::terrain::{Ground, Terrain};
use crate::{Bounds, Georeference, MapGrid, ReferenceSystem};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// All of a terrain but its heights, which follow as plain numbers.
#[derive(Serialize, Deserialize)]
struct Header {
    bounds: Bounds,
    /// Columns and rows of the map grid.
    size: [usize; 2],
    corner: [f64; 2],
    cell: [f64; 2],
    system: Option<ReferenceSystem>,
    valid: Option<Vec<bool>>,
    warnings: Vec<String>,
    surface: SurfaceParts,
}

impl Terrain {
    /// The terrain as bytes, for [`Terrain::from_bytes`] of the same build of the program; none for ground from a formula.
    pub fn to_bytes(&self) -> Option<Vec<u8>> {
        let Ground::Surface(surface) = &self.ground else { return None };
        let MapGrid { columns, rows, georeference, .. } = &self.map_grid;
        let header = Header {
            bounds: self.bounds,
            size: [*columns, *rows],
            corner: georeference.corner,
            cell: georeference.cell,
            system: georeference.system.clone(),
            valid: self.valid.clone(),
            warnings: self.warnings.clone(),
            surface: surface.parts(),
        };
        let mut bytes = postcard::to_stdvec(&header).ok()?;
        bytes.extend_from_slice(surface.height_bytes());
        Some(bytes)
    }

    /// The terrain of [`Terrain::to_bytes`]: the same heights, slopes and coordinates, to the bit. Of the keys of a GeoTIFF it
    /// has those of the reference system only.
    ///
    /// # Errors
    /// A text, where the bytes are no terrain.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, String> {
        let (header, heights) = postcard::take_from_bytes::<Header>(bytes).map_err(|error| error.to_string())?;
        let Header { bounds, size: [columns, rows], corner, cell, system, valid, warnings, surface } = header;
        let cells = columns.checked_mul(rows).filter(|cells| *cells > 0).ok_or("a terrain without cells")?;
        if valid.as_ref().is_some_and(|valid| valid.len() != cells) {
            return Err("a terrain with another number of cells than it says".into());
        }
        let plain = Georeference::plain(corner, cell);
        let georeference = match system {
            Some(system) => plain.with_system(system),
            None => plain,
        };
        let frame = Frame::of_grid(&georeference, [columns, rows])?;
        let surface = Surface::of_parts(surface, heights)?;
        let map_grid = MapGrid { columns, rows, georeference, frame: Arc::new(frame) };
        Ok(Self { bounds, ground: Ground::Surface(surface), map_grid, valid, warnings })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read_rasters;
    use corpuscle_scene::NoData;
    use std::path::Path;

    /// Terrain of an ESRI ASCII grid with a hole, in this reference system.
    fn terrain(crs: Option<&str>, [x, y, cell]: [f64; 3]) -> Terrain {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("ground.asc");
        let mut text =
            format!("ncols 30\nnrows 20\nxllcorner {x}\nyllcorner {y}\ncellsize {cell}\nNODATA_value -9999\n");
        for index in 0..600 {
            let height = if index == 33 { -9999.0 } else { 0.1 * f64::from(index * index % 97) };
            text += &format!("{height} ");
        }
        std::fs::write(&path, text).unwrap();
        Terrain::from_raster(read_rasters(&[path], crs, None).unwrap(), Path::new("ground.asc"), NoData::default())
            .unwrap()
    }

    #[test]
    fn what_comes_back_is_the_same_to_the_bit() {
        let grids = [[250.0, 4000.0, 7.5], [10.0, 47.0, 0.001]];
        for (crs, grid) in [None, Some("EPSG:32632"), Some("EPSG:4326")].into_iter().zip([grids[0], grids[0], grids[1]])
        {
            let terrain = terrain(crs, grid);
            let back = Terrain::from_bytes(&terrain.to_bytes().unwrap()).unwrap();
            assert_eq!(back.bounds, terrain.bounds);
            assert_eq!((&back.valid, &back.warnings), (&terrain.valid, &terrain.warnings));
            assert_eq!(back.map_grid.georeference.system, terrain.map_grid.georeference.system);
            let [width, height] = terrain.bounds.size();
            for step in 0..500 {
                let part = f64::from(step) / 499.0;
                let x = terrain.bounds.x_min + part * width;
                let y = terrain.bounds.y_min + (17.3 * part).fract() * height;
                assert_eq!(back.height_and_slope(x, y), terrain.height_and_slope(x, y));
                assert_eq!(back.to_own([x, y]).map(f64::to_bits), terrain.to_own([x, y]).map(f64::to_bits));
                assert_eq!(back.to_lon_lat([x, y]).ok(), terrain.to_lon_lat([x, y]).ok());
                assert_eq!(back.map_grid.position(x, y), terrain.map_grid.position(x, y));
            }
        }
    }

    #[test]
    fn a_formula_has_no_bytes_and_other_bytes_are_no_terrain() {
        let bounds = Bounds { x_min: 0.0, x_max: 1.0, y_min: 0.0, y_max: 1.0 };
        assert!(Terrain::analytic(bounds, 0.1, |_, _| (0.0, [0.0; 2])).to_bytes().is_none());
        let bytes = terrain(None, [0.0, 0.0, 1.0]).to_bytes().unwrap();
        for cut in [0, 1, 40, bytes.len() / 2, bytes.len() - 1] {
            assert!(Terrain::from_bytes(&bytes[..cut]).is_err(), "{cut}");
        }
        assert!(Terrain::from_bytes(&[bytes, vec![0]].concat()).is_err());
    }
}

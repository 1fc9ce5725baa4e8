//! The files of Copernicus GLO-30: their names, and where their cells lie (readme of the public bucket,
//! copernicus-dem-30m.s3.amazonaws.com/readme.html).

use corpuscle_terrain::{Georeference, MapBox};
use std::fmt;

/// Rows of a tile, one arc second high.
pub(crate) const ROWS: usize = 3600;

/// Most cells of a download: the most that a terrain may have.
const MOST_CELLS: f64 = 1e8;

/// A file of one degree by one degree, named after its south-west corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct TileName {
    /// Latitude of the south side, degrees.
    pub south: i32,
    /// Longitude of the west side, degrees.
    pub west: i32,
}

impl fmt::Display for TileName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (north_south, east_west) = (if self.south < 0 { 'S' } else { 'N' }, if self.west < 0 { 'W' } else { 'E' });
        let (latitude, longitude) = (self.south.abs(), self.west.abs());
        write!(f, "Copernicus_DSM_COG_10_{north_south}{latitude:02}_00_{east_west}{longitude:03}_00_DEM")
    }
}

impl TileName {
    /// The tiles that have cells in a box, from the north-west on.
    pub fn within(part: &MapBox) -> Result<Vec<Self>, String> {
        let MapBox { west, south, east, north } = *part;
        if west < -180.0 || east > 180.0 || south < -90.0 || north > 90.0 {
            return Err(format!(
                "{west},{south},{east},{north} is not in longitude and latitude: -180,-90,180,90 is the whole Earth; the \
                 order is west,south,east,north"
            ));
        }
        let cells = (east - west) * (north - south) * (ROWS * ROWS) as f64;
        if cells > MOST_CELLS {
            return Err(format!(
                "it has about {:.0} million cells, and at most {:.0} million can be used; take a smaller one",
                cells / 1e6,
                MOST_CELLS / 1e6
            ));
        }
        // Rows are centred on whole arc seconds, the north side of a tile being its own and the south side not: its
        // cells reach half a second further north than its name says. Columns likewise to the west.
        let tiles = |south: i32| {
            let half = 0.5 * Self { south, west: 0 }.cell_width();
            let from = (west + half).floor() as i32;
            let to = (east + half).ceil() as i32;
            (from.max(-180)..to.min(180)).map(move |west| Self { south, west })
        };
        let half = 0.5 / ROWS as f64;
        let (from, to) = ((south - half).floor() as i32, (north - half).ceil() as i32);
        Ok((from.max(-90)..to.min(90)).rev().flat_map(tiles).collect())
    }

    /// Columns of a tile: cells get wider towards the poles.
    pub fn columns(self) -> usize {
        // The latitude of the side nearer to the equator.
        match if self.south < 0 { -self.south - 1 } else { self.south } {
            0..50 => 3600,
            50..60 => 2400,
            60..70 => 1800,
            70..80 => 1200,
            80..85 => 720,
            _ => 360,
        }
    }

    fn cell_width(self) -> f64 {
        1.0 / self.columns() as f64
    }

    /// Georeference of its cells: the centre of the north-west one is on the whole degrees.
    pub fn place(self) -> Georeference {
        let cell = [self.cell_width(), 1.0 / ROWS as f64];
        let corner = [f64::from(self.west) - 0.5 * cell[0], f64::from(self.south + 1) + 0.5 * cell[1]];
        Georeference::degrees(corner, cell)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(sides: [f64; 4]) -> Vec<String> {
        let tiles = TileName::within(&MapBox::new(sides).unwrap()).unwrap();
        tiles.iter().map(|tile| tile.to_string().replace("Copernicus_DSM_COG_10_", "").replace("_00", "")).collect()
    }

    #[test]
    fn tiles_are_called_as_in_the_bucket() {
        let name = |south, west| TileName { south, west }.to_string();
        assert_eq!(name(41, -92), "Copernicus_DSM_COG_10_N41_00_W092_00_DEM");
        assert_eq!(name(-14, -172), "Copernicus_DSM_COG_10_S14_00_W172_00_DEM");
        assert_eq!(name(0, 6), "Copernicus_DSM_COG_10_N00_00_E006_00_DEM");
    }

    #[test]
    fn a_box_takes_the_tiles_in_which_it_has_cells() {
        assert_eq!(names([-91.6, 41.6, -91.5, 41.7]), ["N41_W092_DEM"]);
        assert_eq!(names([6.9, 49.9, 7.1, 50.1]), ["N50_E006_DEM", "N50_E007_DEM", "N49_E006_DEM", "N49_E007_DEM"]);
        assert_eq!(names([-0.1, -0.1, 0.1, 0.1]), ["N00_W001_DEM", "N00_E000_DEM", "S01_W001_DEM", "S01_E000_DEM"]);
        // The last half second before a whole degree belongs to the neighbours.
        assert_eq!(names([6.5, 45.0, 6.6, 45.1]), ["N45_E006_DEM", "N44_E006_DEM"]);
        assert_eq!(names([6.5, 45.0002, 6.6, 46.0]), ["N45_E006_DEM"]);
        assert_eq!(names([6.5, 45.5, 6.9999, 45.6]), ["N45_E006_DEM", "N45_E007_DEM"]);
    }

    #[test]
    fn cells_get_wider_towards_the_poles() {
        let columns = |south| TileName { south, west: 0 }.columns();
        assert_eq!([49, 50, 59, 60, 70, 80, 85, 89].map(columns), [3600, 2400, 2400, 1800, 1200, 720, 360, 360]);
        assert_eq!([-1, -50, -51, -61, -90].map(columns), [3600, 3600, 2400, 1800, 360]);
    }

    #[test]
    fn cells_are_centred_on_whole_seconds() {
        let place = TileName { south: -14, west: -172 }.place();
        // As GDAL gives it for this tile.
        assert!(
            (place.corner[0] + 172.000_138_888_888_9).abs() < 1e-12
                && (place.corner[1] + 12.999_861_111_111_11).abs() < 1e-12
        );
    }

    #[test]
    fn boxes_beyond_the_earth_or_too_large_are_refused() {
        let refused = |sides| TileName::within(&MapBox::new(sides).unwrap()).unwrap_err();
        assert!(refused([512_300.0, 204_100.0, 512_400.0, 204_200.0]).contains("longitude and latitude"));
        assert!(refused([0.0, 0.0, 9.0, 9.0]).contains("1050 million"));
    }
}

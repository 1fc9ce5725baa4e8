//! Checks of `[terrain]`.

use super::{Check, Checked};
use crate::{Bowl, Bump, Extent, RoughHills, Terrain, Valley};

/// More cells than this do not fit in the memory of usual machines.
const MOST_CELLS: f64 = 1e9;

impl Check {
    pub(crate) fn terrain(&self, terrain: &Terrain) -> Checked {
        match terrain {
            Terrain::File(file) => self.require("terrain.file.path", !file.path.as_os_str().is_empty(), || {
                "must name a GeoTIFF or ESRI ASCII file".into()
            }),
            Terrain::Tiles(tiles) => {
                let named = !tiles.paths.is_empty() && tiles.paths.iter().all(|path| !path.as_os_str().is_empty());
                self.require("terrain.tiles.paths", named, || "must name GeoTIFF or ESRI ASCII files".into())
            }
            Terrain::Fetch(fetch) => self.fetched_box(fetch.bbox),
            Terrain::Valley(valley) => self.valley(valley),
            Terrain::RoughHills(hills) => self.rough_hills(hills),
            Terrain::Plane(plane) => self.extent("terrain.plane.extent", &plane.extent),
            Terrain::Bump(bump) => self.bump(bump),
            Terrain::Bowl(bowl) => self.bowl(bowl),
        }
    }

    fn fetched_box(&self, [west, south, east, north]: [f64; 4]) -> Checked {
        let on_earth = -180.0 <= west && east <= 180.0 && -90.0 <= south && north <= 90.0;
        self.require("terrain.fetch.bbox", on_earth && west < east && south < north, || {
            "must be [west, south, east, north] in degrees of longitude and latitude, west less than east and south less \
             than north"
                .into()
        })
    }

    fn extent(&self, key: &str, extent: &Extent) -> Checked {
        self.above(&format!("{key}.length_m"), extent.length_m, 0.0)?;
        self.above(&format!("{key}.width_m"), extent.width_m, 0.0)?;
        let cell_key = format!("{key}.cell_m");
        self.above(&cell_key, extent.cell_m, 0.0)?;
        let shorter = extent.length_m.min(extent.width_m);
        self.require(&cell_key, extent.cell_m <= shorter, || {
            format!("must be at most the shorter side of the ground, {shorter} m")
        })?;
        let cells = extent.length_m / extent.cell_m * (extent.width_m / extent.cell_m);
        self.require(&cell_key, cells <= MOST_CELLS, || {
            format!("would make {cells:.1e} cells; at most {MOST_CELLS:.0e} are possible, so take larger cells")
        })
    }

    fn valley(&self, valley: &Valley) -> Checked {
        self.extent("terrain.valley.extent", &valley.extent)?;
        self.at_least("terrain.valley.slope", valley.slope, 0.0)?;
        self.above("terrain.valley.channel_width_m", valley.channel_width_m, 0.0)?;
        self.at_least("terrain.valley.channel_depth_m", valley.channel_depth_m, 0.0)?;
        self.at_least("terrain.valley.plain_width_m", valley.plain_width_m, 0.0)?;
        self.at_least("terrain.valley.meander_m", valley.meander_m, 0.0)?;
        self.above("terrain.valley.meander_length_m", valley.meander_length_m, 0.0)?;
        self.at_least("terrain.valley.hills_m", valley.hills_m, 0.0)
    }

    fn rough_hills(&self, hills: &RoughHills) -> Checked {
        self.extent("terrain.rough-hills.extent", &hills.extent)?;
        self.at_least("terrain.rough-hills.relief_m", hills.relief_m, 0.0)?;
        self.above("terrain.rough-hills.hill_size_m", hills.hill_size_m, 0.0)?;
        self.require("terrain.rough-hills.roughness", (0.0..=1.0).contains(&hills.roughness), || {
            "must be from 0 to 1".into()
        })
    }

    fn bump(&self, bump: &Bump) -> Checked {
        self.extent("terrain.bump.extent", &bump.extent)?;
        self.above("terrain.bump.width_m", bump.width_m, 0.0)
    }

    fn bowl(&self, bowl: &Bowl) -> Checked {
        self.extent("terrain.bowl.extent", &bowl.extent)?;
        self.above("terrain.bowl.depth_m", bowl.depth_m, 0.0)?;
        self.above("terrain.bowl.radius_m", bowl.radius_m, 0.0)
    }
}

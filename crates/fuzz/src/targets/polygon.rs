//! Polygons: shapefile, GeoJSON, CSV.

use super::{none, on_file};
use crate::Target;
use corpuscle_flood::obstacle_shapes;
use corpuscle_output::compare_extent;
use corpuscle_scene::{Flood, Obstacle};
use corpuscle_terrain::{Bounds, Terrain};
use std::path::Path;
use std::sync::LazyLock;

pub(super) const TARGETS: &[Target] = &[
    Target { name: "shapefile", about: "shapefiles", corpus: "shapefile", read: shapefile, more: none },
    Target {
        name: "geojson",
        about: "GeoJSON, as obstacles and as an observed extent",
        corpus: "geojson",
        read: geojson,
        more: none,
    },
    Target { name: "polygons-csv", about: "polygons in CSV", corpus: "polygons-csv", read: csv, more: none },
];

static GROUND: LazyLock<Terrain> = LazyLock::new(|| {
    let bounds = Bounds { x_min: 0.0, x_max: 100.0, y_min: 0.0, y_max: 100.0 };
    Terrain::gridded(bounds, 10.0, |x, y| 0.01 * x + 0.02 * y)
});

fn obstacles(path: &Path) -> Result<String, String> {
    let obstacle = Obstacle { name: "houses".into(), file: Some(path.to_owned()), ..Obstacle::default() };
    let flood = Flood { obstacle: vec![obstacle], ..Flood::default() };
    let shapes = obstacle_shapes(&flood, &GROUND, Path::new(""), 10.0);
    let shapes = shapes.map_err(|error| error.to_string().replace(&path.display().to_string(), ""))?;
    Ok(if shapes.is_empty() { "none" } else { "polygons" }.into())
}

fn shapefile(bytes: &[u8]) -> Result<String, String> {
    on_file("a.shp", bytes, obstacles)
}

fn csv(bytes: &[u8]) -> Result<String, String> {
    on_file("a.csv", bytes, obstacles)
}

fn geojson(bytes: &[u8]) -> Result<String, String> {
    on_file("a.geojson", bytes, |path| {
        let words = obstacles(path)?;
        let depth = vec![1.0; GROUND.map_grid().columns * GROUND.map_grid().rows];
        let scores = compare_extent(path, &GROUND, &depth);
        scores.map_err(|error| error.to_string().replace(&path.display().to_string(), ""))?;
        Ok(words)
    })
}

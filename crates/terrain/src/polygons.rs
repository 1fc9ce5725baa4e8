//! Polygons from GeoJSON.

use crate::Terrain;
use geojson::{GeoJson, GeometryValue};

/// Rings of positions; those that an odd number of them hold are inside.
pub type Polygon = Vec<Vec<[f64; 2]>>;

/// The polygons of a GeoJSON text, as written there; other geometries are ignored.
///
/// # Errors
/// What is wrong with a text that is no GeoJSON.
pub fn polygons_of_geojson(text: &str) -> Result<Vec<Polygon>, String> {
    let geojson: GeoJson = text.parse().map_err(|error: geojson::Error| error.to_string())?;
    let mut polygons = Vec::new();
    match &geojson {
        GeoJson::Geometry(geometry) => collect(&geometry.value, &mut polygons),
        GeoJson::Feature(feature) => {
            feature.geometry.iter().for_each(|geometry| collect(&geometry.value, &mut polygons));
        }
        GeoJson::FeatureCollection(collection) => {
            let geometries = collection.features.iter().filter_map(|feature| feature.geometry.as_ref());
            geometries.for_each(|geometry| collect(&geometry.value, &mut polygons));
        }
    }
    Ok(polygons)
}

fn collect(geometry: &GeometryValue, polygons: &mut Vec<Polygon>) {
    let polygon = |rings: &geojson::PolygonType| -> Polygon {
        let point = |position: &geojson::Position| Some([*position.as_slice().first()?, *position.as_slice().get(1)?]);
        rings.iter().map(|ring| ring.iter().filter_map(point).collect()).collect()
    };
    match geometry {
        GeometryValue::Polygon { coordinates } => polygons.push(polygon(coordinates)),
        GeometryValue::MultiPolygon { coordinates } => polygons.extend(coordinates.iter().map(polygon)),
        GeometryValue::GeometryCollection { geometries } => {
            geometries.iter().for_each(|geometry| collect(&geometry.value, polygons));
        }
        _ => {}
    }
}

impl Terrain {
    /// Brings polygons of GeoJSON to the terrain's own coordinates. They are in longitude and latitude as RFC 7946 requires; numbers that
    /// cannot be those, and any numbers on a terrain without reference system, are the terrain's own already.
    pub fn polygons_to_own(&self, mut polygons: Vec<Polygon>) -> Vec<Polygon> {
        let could_be_degrees = |[x, y]: &[f64; 2]| (-180.0..=180.0).contains(x) && (-90.0..=90.0).contains(y);
        if polygons.iter().flatten().flatten().all(could_be_degrees) {
            for position in polygons.iter_mut().flatten().flatten() {
                *position = self.from_lon_lat(*position).map_or(*position, |model| self.to_own(model));
            }
        }
        polygons
    }
}

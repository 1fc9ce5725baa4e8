//! Obstacles of a scene.

use super::clip::{ring_within, surroundings};
use super::{Outline, Outlines, shapefile};
use crate::extent::{check_inside, is_beside};
use corpuscle_model::ModelError;
use corpuscle_scene::{Circle, Flood, Obstacle, read_bytes, read_text};
use corpuscle_terrain::{Bounds, Polygon, Terrain, polygons_of_geojson};
use std::f64::consts::TAU;
use std::path::Path;

/// Corners of a circle.
const ROUND: usize = 360;

/// Opens the outlines of a scene's obstacles for particles that reach at most `reach` m.
///
/// # Errors
/// [`ModelError::Setup`] for a file that holds no polygon, or one that lies outside the terrain or where its projection does not reach.
pub(crate) fn open(flood: &Flood, terrain: &Terrain, folder: &Path, reach: f64) -> Result<Outlines, ModelError> {
    let mut outlines = Vec::new();
    let far = surroundings(terrain, reach);
    for (number, obstacle) in flood.obstacle.iter().enumerate() {
        let subject = format!("the obstacle '{}'", obstacle.name);
        let areas: Vec<Polygon> = polygons(obstacle, terrain, folder)?
            .into_iter()
            .map(|rings| rings.into_iter().filter(|ring| ring.len() >= 3).collect())
            .collect();
        // Of the buildings of a town some may stand beyond the terrain, but not all.
        let overlaps = |rings: &Polygon| rings.first().map(|outer| check_overlap(&subject, outer, terrain));
        let on_terrain = areas.iter().any(|rings| overlaps(rings).is_some_and(|checked| checked.is_ok()));
        for rings in areas {
            match overlaps(&rings) {
                Some(Err(error)) if !on_terrain => return Err(error),
                Some(Ok(())) => {}
                _ => continue,
            }
            rings.iter().try_for_each(|ring| check_known(&subject, ring))?;
            let rings = rings.into_iter().map(|ring| ring_within(ring, far)).filter(|ring| ring.len() >= 3);
            let rings: Polygon = rings.map(|ring| going_on_beyond(ring, terrain.bounds(), reach)).collect();
            if !rings.is_empty() {
                outlines.push(Outline { obstacle: number, rings });
            }
        }
    }
    Ok(Outlines::new(outlines, reach))
}

/// The polygons of an obstacle, in model coordinates.
pub(crate) fn polygons(obstacle: &Obstacle, terrain: &Terrain, folder: &Path) -> Result<Vec<Polygon>, ModelError> {
    let to_model = |ring: Vec<[f64; 2]>| ring.into_iter().map(|position| terrain.to_model(position)).collect();
    if let Some(polygon) = &obstacle.polygon {
        return Ok(vec![vec![to_model(polygon.clone())]]);
    }
    if let Some(circle) = obstacle.circle {
        check_inside(&format!("the middle of the obstacle '{}'", obstacle.name), &[circle.centre], terrain)?;
        return Ok(vec![vec![round(circle, terrain)]]);
    }
    let Some(file) = &obstacle.file else { return Ok(Vec::new()) };
    let path = folder.join(file);
    let refused =
        |what: String| ModelError::Setup(format!("{} (obstacle '{}'): {what}", path.display(), obstacle.name));
    let polygons = read(&path, terrain).map_err(refused)?;
    if polygons.is_empty() {
        return Err(refused("holds no polygon; give areas, not points or lines".into()));
    }
    Ok(polygons.into_iter().map(|rings| rings.into_iter().map(to_model).collect()).collect())
}

fn round(circle: Circle, terrain: &Terrain) -> Vec<[f64; 2]> {
    let [x, y] = terrain.to_model(circle.centre);
    // The polygon's sides touch the circle from outside: what is not in it is not in the circle.
    let radius = circle.radius_m / (0.5 * TAU / ROUND as f64).cos();
    let corner = |k: usize| {
        let (sin, cos) = (TAU * k as f64 / ROUND as f64).sin_cos();
        [x + radius * cos, y + radius * sin]
    };
    (0..ROUND).map(corner).collect()
}

/// Extends a ring with a side along an edge of the terrain beyond it, so that this side is no wall to the water.
fn going_on_beyond(mut ring: Vec<[f64; 2]>, bounds: Bounds, reach: f64) -> Vec<[f64; 2]> {
    let near = 1e-6 * reach;
    let edges =
        [(0, bounds.x_min, -reach), (0, bounds.x_max, reach), (1, bounds.y_min, -reach), (1, bounds.y_max, reach)];
    for (axis, edge, outward) in edges {
        let before = std::mem::take(&mut ring);
        for (k, &corner) in before.iter().enumerate() {
            let next = before[(k + 1) % before.len()];
            ring.push(corner);
            if [corner, next].iter().all(|end| (end[axis] - edge).abs() <= near) {
                for mut end in [corner, next] {
                    end[axis] += outward;
                    ring.push(end);
                }
            }
        }
    }
    ring
}

/// Refuses corners without a position.
fn check_known(subject: &str, ring: &[[f64; 2]]) -> Result<(), ModelError> {
    let unknown = |corner: &[f64; 2]| !corner.iter().all(|along| along.is_finite());
    match ring.iter().position(unknown) {
        Some(corner) => Err(ModelError::Setup(format!(
            "{subject} has a corner, number {}, so far from the terrain that it has no position there; cut it off",
            corner + 1
        ))),
        None => Ok(()),
    }
}

pub(crate) fn check_overlap(subject: &str, ring: &[[f64; 2]], terrain: &Terrain) -> Result<(), ModelError> {
    check_known(subject, ring)?;
    if is_beside(ring, terrain.bounds(), 0.0) {
        let [x, y] = ring[0];
        let what = format!(
            "{subject} lies outside the terrain: its first corner is at ({x}, {y}) m in the model's coordinates"
        );
        return Err(ModelError::Setup(what));
    }
    Ok(())
}

fn extension(path: &Path) -> String {
    path.extension().map(|extension| extension.to_string_lossy().to_lowercase()).unwrap_or_default()
}

fn read(path: &Path, terrain: &Terrain) -> Result<Vec<Polygon>, String> {
    match extension(path).as_str() {
        "geojson" | "json" => geojson(path, terrain),
        "shp" => shapefile::polygons(&read_bytes(path).map_err(|error| error.to_string())?),
        "csv" => csv(path),
        other => Err(format!("'.{other}' is no format of polygons here; give .geojson, .shp or .csv")),
    }
}

fn geojson(path: &Path, terrain: &Terrain) -> Result<Vec<Polygon>, String> {
    let text = read_text(path).map_err(|error| error.to_string())?;
    Ok(terrain.polygons_to_own(polygons_of_geojson(&text)?))
}

/// Corners in columns x and y; where there is a column `name`, each name is a polygon.
fn csv(path: &Path) -> Result<Vec<Polygon>, String> {
    let bytes = read_bytes(path).map_err(|error| error.to_string())?;
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(bytes.as_slice());
    let headers = reader.headers().map_err(|error| error.to_string())?.clone();
    let column = |name: &str| headers.iter().position(|header| header.eq_ignore_ascii_case(name));
    let (Some(x), Some(y)) = (column("x"), column("y")) else {
        return Err(format!(
            "needs columns x and y; its first line is '{}'",
            headers.iter().collect::<Vec<_>>().join(", ")
        ));
    };
    let name = column("name");
    let mut rings: Vec<(String, Vec<[f64; 2]>)> = Vec::new();
    for (row, record) in reader.records().enumerate() {
        let record = record.map_err(|error| error.to_string())?;
        let number = |column: usize| {
            let text = record.get(column).unwrap_or_default();
            let value: Result<f64, _> = text.parse();
            value
                .ok()
                .filter(|value| value.is_finite())
                .ok_or_else(|| format!("line {}: '{text}' is no number", row + 2))
        };
        let corner = [number(x)?, number(y)?];
        let of = name.and_then(|column| record.get(column)).unwrap_or_default().to_owned();
        match rings.last_mut() {
            Some((last, ring)) if *last == of => ring.push(corner),
            _ => rings.push((of, vec![corner])),
        }
    }
    Ok(rings.into_iter().map(|(_, ring)| vec![ring]).collect())
}

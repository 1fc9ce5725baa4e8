//! The reports of runs, one for each model.

mod dew;
mod ensemble;
mod facts;
mod figures;
mod gas;
mod gauges;
mod moments;
mod page;
mod parts;
mod plain;
mod snapshots;
mod validation;

use crate::maps::read_map;
use crate::picture::{Ground, MapMark, MarkKind, Window};
use crate::whole::write_bytes;
use crate::{GaugeTable, OutputError, Summary};
use corpuscle_scene::{Circle, Flood, FloodScene, Obstacle, Scene, read_text};
use corpuscle_terrain::Terrain;
use figures::{FIELDS, FieldKind, Figures};
use snapshots::Snapshot;

pub use dew::DewReport;
pub use ensemble::{EnsembleMap, EnsembleReport, EnsembleTable};
pub use gas::{GasReport, gas_key};
pub use plain::PlainReport;
use std::f64::consts::TAU;
use std::fs;
use std::path::{Path, PathBuf};
pub use validation::{ValidatedCase, ValidatedMeasure, ValidationReport};

/// Width and height of a chart of a model, CSS pixels.
const CHART: [f64; 2] = [482.0, 310.0];

/// The report of a flood.
#[derive(Debug)]
pub struct Report {
    folder: PathBuf,
    scene: Scene,
    flood: FloodScene,
    scene_text: String,
    summary: Summary,
    gauges: GaugeTable,
    /// The terrain in the window.
    ground: Ground,
    /// The part of the terrain that maps show.
    window: Window,
    whole: Whole,
    /// Area of each cell, m2, for areas by class.
    cell_areas: Vec<f64>,
    marks: Vec<MapMark>,
    fields: Vec<Field>,
    snapshots: Vec<Snapshot>,
}

/// The terrain as a whole.
#[derive(Debug)]
struct Whole {
    /// Columns and rows of its map grid.
    grid: [usize; 2],
    /// Size of a cell `[east, north]`, m.
    cell: [f64; 2],
    /// Lowest and highest elevation, m.
    heights: [f64; 2],
}

impl Whole {
    fn of(terrain: &Terrain) -> Self {
        let grid = terrain.map_grid();
        Self { grid: [grid.columns, grid.rows], cell: grid.cell_size(), heights: terrain.height_range() }
    }

    /// The window round the cells with a value and the marked positions except obstacles.
    fn window(&self, field: Option<&Field>, marks: &[MapMark], terrain: &Terrain) -> Window {
        let [columns, _] = self.grid;
        let values = field.map_or(&[][..], |field| &field.values).iter().enumerate();
        let wet = values.filter(|(_, value)| !value.is_nan());
        let cells = wet.map(|(cell, _)| [(cell % columns) as f64, (cell / columns) as f64]);
        let inside = marks.iter().filter(|mark| mark.kind != MarkKind::Obstacle);
        let marked = inside.flat_map(|mark| &mark.points);
        let marked = marked.map(|point| terrain.map_grid().georeference.position(*point));
        Window::round(self.grid, self.cell, cells.chain(marked))
    }
}

/// A field of the whole run.
#[derive(Debug)]
struct Field {
    kind: &'static FieldKind,
    /// A value for each cell of the map grid; not-a-number where there is nothing.
    values: Vec<f32>,
}

impl Report {
    /// Reads the folder of a run that has ended. `scene` is its scene.toml and `terrain` that scene's terrain.
    ///
    /// Maps that are not there are left out of the report.
    ///
    /// # Errors
    /// [`OutputError::Read`] or [`OutputError::Content`], naming the file.
    pub fn read(folder: &Path, scene: &Scene, terrain: &Terrain) -> Result<Self, OutputError> {
        let scene_path = folder.join("scene.toml");
        let scene_text = read_text(&scene_path).map_err(OutputError::read(&scene_path))?;
        let no_flood = || OutputError::content(&scene_path, "it is not the scene of a flood");
        let flood = scene.flood().ok_or_else(no_flood)?;
        let grid = terrain.map_grid();
        let cells = grid.columns * grid.rows;
        let maps = folder.join("maps");
        let mut fields = Vec::new();
        for kind in &FIELDS {
            let path = maps.join(format!("{}.tif", kind.name));
            if path.exists() {
                fields.push(Field { kind, values: read_map(&path, cells)? });
            }
        }
        let (whole, marks) = (Whole::of(terrain), marks(&flood.flood, terrain));
        let window = whole.window(fields.iter().find(|field| field.kind.name == "max_depth"), &marks, terrain);
        Ok(Self {
            folder: folder.to_owned(),
            scene: scene.clone(),
            flood: flood.clone(),
            scene_text,
            summary: Summary::read(folder)?,
            gauges: GaugeTable::read(&folder.join("gauges.csv"))?,
            ground: Ground::of(terrain, &window),
            window,
            whole,
            cell_areas: (0..cells).map(|cell| grid.cell_area(cell % grid.columns, cell / grid.columns)).collect(),
            marks,
            fields,
            snapshots: snapshots::read(&maps, cells)?,
        })
    }

    /// Writes `pictures/*.png` and `report.html` into the folder. The same folder always gives the same bytes.
    ///
    /// # Errors
    /// [`OutputError::Write`]; [`OutputError::Content`] for a picture that cannot be drawn.
    pub fn write(&self) -> Result<(), OutputError> {
        let pictures = self.folder.join("pictures");
        fs::create_dir_all(&pictures).map_err(OutputError::write(&pictures))?;
        let drawing = |what: String| OutputError::content(&pictures, what);
        let figures = Figures::draw(self).map_err(drawing)?;
        for (name, png) in figures.pngs().map_err(drawing)? {
            write_bytes(&pictures.join(format!("{name}.png")), &png)?;
        }
        write_bytes(&self.folder.join("report.html"), page::html(self, &figures).as_bytes())
    }

    /// The values of a field that maps show.
    fn shown(&self, values: &[f32]) -> Vec<f32> {
        self.window.crop(values, self.whole.grid[0])
    }

    fn field(&self, name: &str) -> Option<&Field> {
        self.fields.iter().find(|field| field.kind.name == name)
    }

    /// The scene's title, or the folder's name.
    fn title(&self) -> String {
        title_or_folder(&self.scene, &self.folder)
    }

    fn folder_name(&self) -> String {
        folder_name(&self.folder)
    }

    /// Area where a field has a value, m2.
    fn area_of(&self, field: &Field, wanted: impl Fn(f32) -> bool) -> f64 {
        let cells = field.values.iter().zip(&self.cell_areas);
        cells.filter(|(value, _)| wanted(**value)).fold(0.0, |sum, (_, area)| sum + area)
    }
}

/// A scene's title, or the name of its run's folder.
fn title_or_folder(scene: &Scene, folder: &Path) -> String {
    match scene.title.trim() {
        "" => folder_name(folder),
        title => title.to_owned(),
    }
}

fn folder_name(folder: &Path) -> String {
    folder.file_name().map_or_else(|| "run".into(), |name| name.to_string_lossy().into_owned())
}

/// Gauges, inflows, sections and obstacles of the scene, in the terrain's own coordinates.
fn marks(flood: &Flood, terrain: &Terrain) -> Vec<MapMark> {
    let sections = flood.section.iter().map(|section| MapMark {
        kind: MarkKind::Section,
        name: section.name.clone(),
        points: section.line.clone(),
    });
    let inflows = flood.inflow.iter().map(|inflow| MapMark {
        kind: MarkKind::Inflow,
        name: inflow.name.clone(),
        points: inflow.line.clone().unwrap_or_else(|| inflow.at.into_iter().collect()),
    });
    let gauges = flood.gauge.iter().map(|gauge| {
        let from_lon_lat = gauge.lon_lat.and_then(|position| terrain.from_lon_lat(position).ok());
        let at = gauge.at.or(from_lon_lat.map(|model| terrain.to_own(model)));
        MapMark { kind: MarkKind::Gauge, name: gauge.name.clone(), points: at.into_iter().collect() }
    });
    let obstacles = flood.obstacle.iter().map(|obstacle| MapMark {
        kind: MarkKind::Obstacle,
        name: obstacle.name.clone(),
        points: corners(obstacle, terrain),
    });
    // An obstacle from a file has no corners here: it shows as ground that stays dry.
    let drawn = obstacles.filter(|obstacle| !obstacle.points.is_empty());
    sections.chain(inflows).chain(gauges).chain(drawn).collect()
}

/// The corners of an obstacle in the terrain's own coordinates; of a line there and back.
fn corners(obstacle: &Obstacle, terrain: &Terrain) -> Vec<[f64; 2]> {
    let line = obstacle.line.as_ref().map(|line| line.iter().chain(line.iter().rev().skip(1)).copied().collect());
    let circle = obstacle.circle.map(|circle| round(circle, terrain));
    obstacle.polygon.clone().or(circle).or(line).unwrap_or_default()
}

/// A circle as a polygon in the terrain's own coordinates.
fn round(circle: Circle, terrain: &Terrain) -> Vec<[f64; 2]> {
    let [x, y] = terrain.to_model(circle.centre);
    let at = |corner: u32| {
        let (sin, cos) = (TAU * f64::from(corner) / 48.0).sin_cos();
        terrain.to_own([x + circle.radius_m * cos, y + circle.radius_m * sin])
    };
    (0..48).map(at).collect()
}

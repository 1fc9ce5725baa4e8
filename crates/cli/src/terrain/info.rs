//! `corpuscle terrain info`.

use crate::args::InfoOptions;
use crate::output::{number, print, print_json};
use corpuscle::terrain::{MapBox, ReferenceSystem, Summary, summarize};
use serde::Serialize;
use std::path::PathBuf;

/// Description of a terrain file, for JSON.
#[derive(Debug, Serialize)]
struct Info {
    file: PathBuf,
    format: &'static str,
    samples: String,
    columns: usize,
    rows: usize,
    /// In the file's own unit.
    cell: [f64; 2],
    cell_m: [f64; 2],
    size_m: [f64; 2],
    /// `west, south, east, north` in the file's own coordinates.
    bounds: [f64; 4],
    bounds_lon_lat: Option<[f64; 4]>,
    reference_system: Option<String>,
    /// Of eastings and northings: `m`, `degree`, or metres in the unit.
    unit: String,
    height_unit_m: f64,
    lowest_m: Option<f64>,
    highest_m: Option<f64>,
    no_data_share: f64,
    warnings: Vec<String>,
}

/// Prints the description of terrain files.
pub fn info(options: &InfoOptions, as_json: bool) -> anyhow::Result<()> {
    let mut infos = Vec::new();
    for file in &options.files {
        let summary = summarize(file, options.crs.as_deref()).map_err(corpuscle::Error::from)?;
        infos.push(Info::new(file.clone(), summary));
    }
    if as_json {
        return print_json(&infos);
    }
    print(&infos.iter().map(Info::text).collect::<Vec<_>>().join("\n"))
}

fn sides(part: &MapBox) -> [f64; 4] {
    [part.west, part.south, part.east, part.north]
}

fn unit(system: Option<&ReferenceSystem>) -> String {
    match system {
        Some(system) if system.geographic => "degree".into(),
        Some(system) if system.metres_per_unit != 1.0 => format!("{} m", system.metres_per_unit),
        _ => "m".into(),
    }
}

impl Info {
    fn new(file: PathBuf, summary: Summary) -> Self {
        let survey = &summary.survey;
        let (columns, rows, system) = (survey.columns, survey.rows, survey.georeference.system.as_ref());
        Self {
            file,
            format: survey.format,
            samples: survey.samples.clone(),
            columns,
            rows,
            cell: survey.georeference.cell,
            cell_m: summary.cell_m,
            size_m: [summary.cell_m[0] * columns as f64, summary.cell_m[1] * rows as f64],
            bounds: sides(&survey.outline()),
            bounds_lon_lat: summary.lon_lat.as_ref().map(sides),
            reference_system: system.map(|system| system.name.clone()),
            unit: unit(system),
            height_unit_m: survey.height_unit_m,
            lowest_m: summary.heights_m.map(|heights| heights[0]),
            highest_m: summary.heights_m.map(|heights| heights[1]),
            no_data_share: summary.no_data as f64 / (columns * rows) as f64,
            warnings: summary.warnings,
        }
    }

    /// The description as text.
    fn text(&self) -> String {
        let listed = |numbers: &[f64]| numbers.iter().map(|value| coordinate(*value)).collect::<Vec<_>>().join(", ");
        let ([dx, dy], [width, height], [dx_m, dy_m]) =
            (self.cell.map(number), self.size_m.map(number), self.cell_m.map(number));
        let mut lines = vec![
            format!("{} ({}, {})", self.file.display(), self.format, self.samples),
            format!("cells      {} x {} of {dx} x {dy} {} ({dx_m} x {dy_m} m)", self.columns, self.rows, self.unit),
            format!("size       {width} x {height} m"),
            format!("system     {}", self.reference_system.as_deref().unwrap_or("none named")),
            format!("bounds     {} (west, south, east, north)", listed(&self.bounds)),
        ];
        if let Some(bounds) = self.bounds_lon_lat {
            lines.push(format!("lon lat    {}", listed(&bounds)));
        }
        lines.push(match (self.lowest_m, self.highest_m) {
            (Some(lowest), Some(highest)) => format!("heights    {} to {} m", number(lowest), number(highest)),
            _ => "heights    none".into(),
        });
        lines.push(format!("no data    {} % of the cells", number(100.0 * self.no_data_share)));
        lines.extend(self.warnings.iter().map(|warning| format!("note: {warning}")));
        lines.join("\n") + "\n"
    }
}

/// A coordinate to a millimetre, or a ten-millionth of a degree.
fn coordinate(value: f64) -> String {
    let text = if value.abs() <= 360.0 { format!("{value:.7}") } else { format!("{value:.3}") };
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

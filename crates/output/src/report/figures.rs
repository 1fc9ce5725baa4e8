//! The figures of the report of a flood.

use super::snapshots::Snapshot;
use super::{Report, gauges};
use crate::picture::{
    Chart, Classes, Figure, Layer, MapFigure, Ramp, Size, beside, data_url, ground_image, heading, legend, stack,
    svg_to_png, time,
};

use rayon::prelude::*;

/// A field of the report.
#[derive(Debug)]
pub(super) struct FieldKind {
    /// Name of the file.
    pub name: &'static str,
    /// Heading.
    pub title: &'static str,
    /// Title of the legend.
    pub legend: &'static str,
    /// Its explanation.
    pub about: &'static str,
    /// Its colours.
    pub ramp: Ramp,
    /// True to list the area in each class.
    pub areas: bool,
}

/// The fields, in the order of the report.
pub(super) const FIELDS: [FieldKind; 5] = [
    FieldKind {
        name: "max_depth",
        title: "Maximum depth",
        legend: "Maximum depth, m",
        about: "The largest depth at each position during the run.",
        ramp: Ramp::Depth,
        areas: true,
    },
    FieldKind {
        name: "arrival_s",
        title: "Arrival of the water",
        legend: "Arrival after the start",
        about: "When each position first became wet. Dark is early.",
        ramp: Ramp::Arrival,
        areas: false,
    },
    FieldKind {
        name: "max_speed",
        title: "Maximum speed",
        legend: "Maximum speed, m/s",
        about: "The largest speed of the water, in any direction.",
        ramp: Ramp::Speed,
        areas: false,
    },
    FieldKind {
        name: "hazard",
        title: "Flood hazard rating",
        legend: "UK hazard rating: depth × (speed + 0.5)",
        about: "Below 0.75: caution. To 1.25: danger for some, such as children. To 2: danger for most. Above: danger \
                for all. Debris factor 0.",
        ramp: Ramp::Hazard,
        areas: true,
    },
    FieldKind {
        name: "duration_s",
        title: "Duration of flooding",
        legend: "Duration of flooding",
        about: "How long each position was wet during the run.",
        ramp: Ramp::Duration,
        areas: true,
    },
];

/// Name of the relief on a page that shows it several times.
pub(super) const RELIEF: &str = "relief";

/// All figures of a report.
pub(super) struct Figures {
    relief_url: String,
    /// Maps of the fields: on the page, and for a file of their own.
    pub fields: Vec<FieldFigure>,
    /// Maps of the depth over time.
    pub snapshots: Vec<Figure>,
    snapshots_file: Option<Figure>,
    /// Charts of depth and speed, one figure for each gauge.
    pub hydrographs: Vec<Figure>,
    /// Discharge, volumes.
    pub charts: Vec<(&'static str, Figure)>,
}

/// The map of one field.
pub(super) struct FieldFigure {
    /// Which field.
    pub kind: &'static FieldKind,
    /// Its classes.
    pub classes: Classes,
    /// For the page; it refers to the page's relief.
    pub on_page: Figure,
    file: Figure,
}

impl Figures {
    /// Draws everything.
    pub(super) fn draw(report: &Report) -> Result<Self, String> {
        let relief_url = data_url(&ground_image(&report.ground)?);
        let numbers = (0..report.fields.len()).into_par_iter();
        let fields: Vec<FieldFigure> =
            numbers.map(|number| draw_field(report, number, &relief_url)).collect::<Result<_, String>>()?;
        let (snapshots, snapshots_file) = draw_snapshots(report, &fields, &relief_url)?;
        let all = gauges::series(report);
        let span = [0.0, report.gauges.times.last().copied().unwrap_or(report.summary.simulated_time_s)];
        let hydrographs = gauges::hydrographs(&all, span, 322.0);
        let wide = [1000.0, 250.0];
        let charts = [
            ("discharge", gauges::together(&all, "m³/s", "Discharge", span, wide)),
            ("volume", gauges::together(&gauges::changing_volumes(&all), "m³", "Volume of water", span, wide)),
        ];
        let drawn = |(name, chart): (&'static str, Option<Chart>)| Some((name, chart?.figure()));
        Ok(Self {
            relief_url,
            fields,
            snapshots,
            snapshots_file,
            hydrographs: hydrographs.iter().map(|pair| stack(&pair.each_ref().map(Chart::figure), 2.0)).collect(),
            charts: charts.into_iter().filter_map(drawn).collect(),
        })
    }

    /// What must stand on the page before any map.
    pub(super) fn relief_definition(&self) -> String {
        relief_definition(&self.relief_url)
    }

    /// The pictures that stand in files of their own: name and PNG.
    pub(super) fn pngs(&self) -> Result<Vec<(&'static str, Vec<u8>)>, String> {
        let mut all: Vec<(&'static str, Figure)> =
            self.fields.iter().map(|field| (field.kind.name, field.file.clone())).collect();
        all.extend(self.snapshots_file.clone().map(|figure| ("snapshots", figure)));
        if !self.hydrographs.is_empty() {
            all.push(("gauges", beside(&self.hydrographs, 3, [17.0, 14.0])));
        }
        all.extend(self.charts.iter().cloned());
        all.into_par_iter().map(|(name, figure)| Ok((name, svg_to_png(&figure.with_margin(16.0))?))).collect()
    }
}

/// What must stand on a page before any map: the relief, once, from its URL.
pub(super) fn relief_definition(url: &str) -> String {
    format!(
        "<svg width=\"0\" height=\"0\" style=\"position:absolute\" aria-hidden=\"true\"><defs><image id=\"{RELIEF}\" \
         width=\"1\" height=\"1\" preserveAspectRatio=\"none\" href=\"{url}\"/></defs></svg>\n"
    )
}

/// One field's map: the first over the whole width of the page, the others over half of it.
fn draw_field(report: &Report, number: usize, relief_url: &str) -> Result<FieldFigure, String> {
    let field = &report.fields[number];
    let classes = Classes::of(field.kind.ramp, field.kind.legend, &field.values);
    let url = data_url(&Layer::image(&report.ground, &report.shown(&field.values), &classes, 1)?);
    let layer = Layer { url, classes };
    let title = report.title();
    let reference = format!("#{RELIEF}");
    let map = MapFigure {
        ground: &report.ground,
        relief_url: &reference,
        layer: Some(&layer),
        marks: &report.marks,
        size: if number == 0 { Size::Full } else { Size::Compact },
        heading: None,
        title: field.kind.title,
    };
    let on_page = map.figure();
    let file = MapFigure { relief_url, size: Size::Full, heading: Some([field.kind.title, &title]), ..map }.figure();
    Ok(FieldFigure { kind: field.kind, classes: layer.classes, on_page, file })
}

/// Depth over time, in the classes of the maximum depth.
fn draw_snapshots(
    report: &Report,
    fields: &[FieldFigure],
    relief_url: &str,
) -> Result<(Vec<Figure>, Option<Figure>), String> {
    let values = || report.snapshots.iter().flat_map(|snapshot| snapshot.depth.iter().copied());
    let of_maximum = fields.iter().find(|field| field.kind.name == "max_depth");
    let classes = match of_maximum {
        Some(field) => Classes { title: "Depth, m".into(), ..field.classes.clone() },
        None => Classes::of(Ramp::Depth, "Depth, m", &values().collect::<Vec<f32>>()),
    };
    let reference = format!("#{RELIEF}");
    let draw = |snapshot: &Snapshot| -> Result<(Figure, Figure), String> {
        let url = data_url(&Layer::image(&report.ground, &report.shown(&snapshot.depth), &classes, 2)?);
        let layer = Layer { url, classes: classes.clone() };
        let caption = time(snapshot.time);
        let map = MapFigure {
            ground: &report.ground,
            relief_url: &reference,
            layer: Some(&layer),
            marks: &report.marks,
            size: Size::Thumb,
            heading: None,
            title: &caption,
        };
        Ok((map.figure(), MapFigure { relief_url, ..map }.figure()))
    };
    let drawn: Vec<(Figure, Figure)> = report.snapshots.par_iter().map(draw).collect::<Result<_, String>>()?;
    let (on_page, in_file): (Vec<Figure>, Vec<Figure>) = drawn.into_iter().unzip();
    let heading = heading("Depth over time", &report.title());
    let file =
        (!in_file.is_empty()).then(|| stack(&[heading, beside(&in_file, 3, [12.0, 8.0]), legend(&classes)], 0.0));
    Ok((on_page, file))
}

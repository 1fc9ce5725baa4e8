//! Plots of gauges, charts and speeds while a scene runs.

mod draw;
mod history;
mod speeds;

use crate::icons::{self, Icon};
use crate::physics::Opened;
use crate::snapshot::Snapshot;
use corpuscle::model::Chart;
use corpuscle::models;
use corpuscle::scene::Scene;
use egui::{ComboBox, RichText, Role, Ui, WidgetInfo, vec2};
use history::History;
use speeds::Speeds;
use std::fmt::Write;

/// The content of a plot.
#[derive(Debug, Clone, PartialEq)]
enum Kind {
    /// The speeds of a set of balls now, over Maxwell's curve.
    Speeds(usize),
    /// A gauge over time.
    Gauge(usize),
    /// A chart of the model, by its name.
    Chart(String),
}

/// The plots of the open scene.
pub struct Plots {
    gauges: Vec<String>,
    history: History,
    speeds: Speeds,
    /// Dimensions of a gas; none for other models.
    dimensions: Option<usize>,
    /// Names of the sets of balls.
    sets: Vec<String>,
    /// The content of each plot, from the left.
    chosen: Vec<Kind>,
    /// Unit of time, empty in reduced units.
    time_unit: &'static str,
}

/// Width in points below which there is one plot.
const NARROW: f32 = 560.0;

impl Plots {
    /// The plots of a scene that was opened.
    pub fn new(opened: &Opened) -> Self {
        let gas = opened.scene.gas();
        let by_name = |beginning: &&str| opened.gauges.iter().position(|gauge| gauge.starts_with(*beginning));
        let mut first: Vec<usize> = first_of(&opened.scene).iter().filter_map(by_name).collect();
        first.extend(0..opened.gauges.len());
        first.dedup();
        let mut chosen: Vec<Kind> = gas.iter().filter(|_| opened.history.is_none()).map(|_| Kind::Speeds(0)).collect();
        let room = 2 - chosen.len();
        chosen.extend(first.into_iter().take(room).map(Kind::Gauge));
        Self {
            gauges: opened.gauges.clone(),
            history: opened.history.clone().map_or_else(History::default, History::whole),
            speeds: Speeds::new(gas.map_or(2, |gas| gas.dimensions())),
            dimensions: gas.map(|gas| gas.dimensions()),
            sets: Vec::new(),
            chosen,
            time_unit: time_unit(&opened.scene),
        }
    }

    /// Adds a snapshot.
    pub fn take(&mut self, snapshot: &Snapshot) {
        self.rename(&snapshot.measures.names);
        self.history.take(snapshot.measures.time, &snapshot.measures.gauges);
        if self.dimensions.is_some() {
            self.speeds.take(&snapshot.frame);
            if self.sets.is_empty() {
                self.sets = snapshot.frame.sets.iter().map(|set| set.name.clone()).collect();
            }
        }
    }

    /// Adds gauges that were placed while the scene runs.
    fn rename(&mut self, names: &[String]) {
        if names.is_empty() || self.gauges == names {
            return;
        }
        let before: Vec<Option<usize>> =
            names.iter().map(|name| self.gauges.iter().position(|gauge| gauge == name)).collect();
        self.history.rename(&before);
        for kind in &mut self.chosen {
            if let Kind::Gauge(index) = kind {
                *index = before.iter().position(|before| *before == Some(*index)).unwrap_or(0);
            }
        }
        self.gauges = names.to_vec();
    }

    /// Drops the speeds counted so far: they have changed.
    pub fn forget_speeds(&mut self) {
        self.speeds.forget();
    }

    /// Shows the plots side by side; returns a table to be saved: its name and its text.
    pub fn ui(&mut self, ui: &mut Ui, snapshot: &Snapshot) -> Option<(String, String)> {
        let gap = 18.0;
        // A phone has room for one.
        let shown = if ui.available_width() < NARROW { 1 } else { self.chosen.len() };
        let width = (ui.available_width() - gap * (shown.max(1) - 1) as f32) / shown.max(1) as f32;
        let size = vec2(width, ui.available_height());
        let mut saved = None;
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = gap;
            for slot in 0..shown.min(self.chosen.len()) {
                ui.allocate_ui_with_layout(size, egui::Layout::top_down(egui::Align::Min), |ui| {
                    ui.set_width(width);
                    if let Some(table) = self.slot(ui, slot, snapshot) {
                        saved = Some(table);
                    }
                });
            }
        });
        saved
    }

    fn name(&self, kind: &Kind) -> String {
        match kind {
            Kind::Speeds(set) if self.sets.len() > 1 => {
                format!("Speeds now: {}", self.sets.get(*set).map_or("", String::as_str))
            }
            Kind::Speeds(_) => "Speeds now, and Maxwell's law".into(),
            Kind::Gauge(index) => {
                let header = self.gauges.get(*index).map_or("", String::as_str);
                header.replace('_', " ").replacen('.', ": ", 1)
            }
            Kind::Chart(name) => name.replace('_', " "),
        }
    }

    /// All contents to choose from.
    fn kinds(&self, snapshot: &Snapshot) -> Vec<Kind> {
        let speeds = (0..self.sets.len()).map(Kind::Speeds);
        let gauges = (0..self.gauges.len()).map(Kind::Gauge);
        let charts = snapshot.measures.charts.iter().map(|chart| Kind::Chart(chart.name.clone()));
        speeds.chain(gauges).chain(charts).collect()
    }

    fn slot(&mut self, ui: &mut Ui, slot: usize, snapshot: &Snapshot) -> Option<(String, String)> {
        let mut kind = self.chosen[slot].clone();
        let mut save = false;
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 6.0;
            let shown =
                ComboBox::from_id_salt(("plot", slot)).selected_text(self.name(&kind)).width(250.0).height(420.0);
            let shown = shown.show_ui(ui, |ui| {
                for other in self.kinds(snapshot) {
                    let name = self.name(&other);
                    ui.selectable_value(&mut kind, other, name);
                }
            });
            let name = format!("Plot {}", slot + 1);
            shown.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, &name));
            save = icons::sized(ui, Icon::Save, &format!("Save plot {} as a table", slot + 1), "CSV", 24.0, false)
                .clicked();
        });
        self.chosen[slot] = kind.clone();
        let chart = self.chart(&kind, snapshot);
        match &chart {
            Some(chart) => draw::chart(ui, ("chart", slot), chart),
            None => {
                ui.label(RichText::new("No measurements yet.").weak());
            }
        }
        chart.filter(|_| save).map(|chart| (chart.name.clone(), table(&chart)))
    }

    /// The content of a plot as a chart.
    fn chart(&self, kind: &Kind, snapshot: &Snapshot) -> Option<Chart> {
        match kind {
            Kind::Speeds(set) => self.speeds.chart(*set),
            Kind::Gauge(index) => self.history.chart(*index, self.gauges.get(*index)?, self.time_unit),
            Kind::Chart(name) => snapshot.measures.charts.iter().find(|chart| chart.name == *name).cloned(),
        }
    }
}

/// Gauges that are plotted before the others, by the beginning of their headers.
fn first_of(scene: &Scene) -> &'static [&'static str] {
    models::of(scene).map_or(&[], |kind| kind.first_gauges())
}

fn time_unit(scene: &Scene) -> &'static str {
    if models::of(scene).is_ok_and(|kind| kind.has_si_units(scene)) { "s" } else { "" }
}

/// The numbers of a chart: one row for each point.
fn table(chart: &Chart) -> String {
    let axis = |label: &str, unit: &str| if unit.is_empty() { label.to_owned() } else { format!("{label} ({unit})") };
    let heads = [axis(&chart.x.label, &chart.x.unit), axis(&chart.y.label, &chart.y.unit)];
    let quoted = |text: &str| if text.contains(',') { format!("\"{text}\"") } else { text.to_owned() };
    let mut text = format!("series,{},{}\n", quoted(&heads[0]), quoted(&heads[1]));
    for series in &chart.series {
        for [x, y] in &series.points {
            let _ = writeln!(text, "{},{x},{y}", quoted(&series.name));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle::Simulation;
    use corpuscle::model::{ChartAxis, ChartSeries};
    use corpuscle::scene::builtin;
    use std::path::Path;

    #[test]
    fn what_is_shown_first_is_measured() {
        for name in ["gas/maxwell", "flood/lake-at-rest", "dew/lens"] {
            let scene = Scene::parse(builtin(name).unwrap().text, name, &[]).unwrap();
            let simulation = Simulation::open(scene, Path::new("")).unwrap();
            let columns: Vec<_> = simulation.model().gauge_columns().iter().map(|column| column.header()).collect();
            for first in first_of(simulation.scene()) {
                assert!(columns.iter().any(|column| column.starts_with(first)), "{name} {first}: {columns:?}");
            }
        }
    }

    #[test]
    fn a_table_names_its_series_and_its_units() {
        let axis = |label: &str, unit: &str| ChartAxis { label: label.into(), unit: unit.into(), logarithmic: false };
        let series = ChartSeries { name: "gas, light".into(), points: vec![[1.0, 2.5]], ..ChartSeries::default() };
        let chart = Chart { x: axis("Time", "s"), y: axis("Energy", ""), series: vec![series], ..Chart::default() };
        assert_eq!(table(&chart), "series,Time (s),Energy\n\"gas, light\",1,2.5\n");
    }
}

//! Parameters of the open scene: from the scene's own keys, each with its range, its unit and its value as written.

mod dew;
mod flood;
mod gas;

use crate::icons::{self, Icon};
use crate::physics::Change;
use corpuscle::scene::{ModelScene, Scene};
use egui::{Align, ComboBox, DragValue, Layout, RichText, Slider, Ui, WidgetInfo};
use toml::{Table, Value};

/// A value of the scene that can be changed.
pub struct Parameter {
    /// Its key, as on the command line.
    pub path: String,
    /// What it is called here.
    pub name: String,
    /// What it means.
    pub hint: &'static str,
    /// Its unit; empty for a number.
    pub unit: &'static str,
    /// What it is changed with.
    pub control: Control,
    /// Changes it while the scene goes on; none where a restart takes it.
    pub live: Option<fn(&str, f64) -> Change>,
}

/// What a value is changed with.
pub enum Control {
    /// A number in a range.
    Number {
        /// The smallest and the largest.
        range: [f64; 2],
        /// True where a step is a factor.
        logarithmic: bool,
    },
    /// A whole number in a range.
    Whole([f64; 2]),
    /// One of several: what they are called, and as they are written in the scene.
    Choice(&'static [(&'static str, &'static str)]),
}

/// Parameters under a heading.
pub struct Group {
    /// The heading.
    pub name: String,
    /// The parameters.
    pub parameters: Vec<Parameter>,
}

/// Groups as they are put together; what the scene does not have is left out.
struct Builder<'a> {
    document: &'a Table,
    groups: Vec<Group>,
}

impl Builder<'_> {
    fn group(&mut self, name: impl Into<String>) -> &mut Self {
        self.groups.push(Group { name: name.into(), parameters: Vec::new() });
        self
    }

    fn add(
        &mut self,
        path: impl Into<String>,
        name: &str,
        unit: &'static str,
        hint: &'static str,
        control: Control,
    ) -> &mut Self {
        let path = path.into();
        let fits = match &control {
            Control::Choice(_) => value_at(self.document, &path).is_some(),
            Control::Number { .. } | Control::Whole(_) => value_at(self.document, &path).and_then(as_number).is_some(),
        };
        if let Some(group) = self.groups.last_mut().filter(|_| fits) {
            group.parameters.push(Parameter { path, name: name.into(), hint, unit, control, live: None });
        }
        self
    }

    fn number(
        &mut self,
        path: impl Into<String>,
        name: &str,
        unit: &'static str,
        range: [f64; 2],
        hint: &'static str,
    ) -> &mut Self {
        self.add(path, name, unit, hint, Control::Number { range, logarithmic: false })
    }

    /// A number above 0 from a tenth of what it is to ten times as much.
    fn scaled(&mut self, path: impl Into<String>, name: &str, unit: &'static str, hint: &'static str) -> &mut Self {
        self.between(path, name, unit, [0.1, 10.0], hint)
    }

    /// A number above 0 in a range that is told in parts of what it is.
    fn between(
        &mut self,
        path: impl Into<String>,
        name: &str,
        unit: &'static str,
        parts: [f64; 2],
        hint: &'static str,
    ) -> &mut Self {
        let path = path.into();
        match value_at(self.document, &path).and_then(as_number).filter(|value| *value > 0.0) {
            Some(value) => {
                let range = parts.map(|part| part * value);
                self.add(path, name, unit, hint, Control::Number { range, logarithmic: true })
            }
            None => self,
        }
    }

    /// The last one changes while the scene goes on.
    fn live(&mut self, path: &str, change: fn(&str, f64) -> Change) -> &mut Self {
        let last = self.groups.last_mut().and_then(|group| group.parameters.last_mut());
        if let Some(last) = last.filter(|last| last.path == path) {
            last.live = Some(change);
        }
        self
    }
}

/// What can be changed in a scene as it is written.
fn groups(scene: &Scene, document: &Table) -> Vec<Group> {
    let mut builder = Builder { document, groups: Vec::new() };
    match &scene.model {
        ModelScene::Gas(gas) => gas::parameters(&mut builder, gas),
        ModelScene::Flood(flood) => flood::parameters(&mut builder, &flood.flood),
        ModelScene::Dew(dew) => dew::parameters(&mut builder, dew),
    }
    let whole = Control::Whole([0.0, 99.0]);
    builder.group("Run").scaled("run.until_s", "End", "s", "When the scene ends").add(
        "seed",
        "Seed",
        "",
        "Another seed, another start by chance",
        whole,
    );
    builder.groups.retain(|group| !group.parameters.is_empty());
    builder.groups
}

/// The parameters of the open scene.
pub struct Parameters {
    groups: Vec<Group>,
    /// The scene as written, without changes.
    written: Table,
    /// Changes: paths of values, and the values as they are written.
    changes: Vec<(String, String)>,
    /// Changes that the scene goes on with; the others wait for a restart.
    applied: Vec<(String, String)>,
}

/// What was done to the parameters.
pub enum Changed {
    /// A value changes while the scene goes on.
    Live(Change),
    /// The scene is to be started again with the changes.
    Restart,
}

impl Parameters {
    /// Those of a scene whose text gives `written` without, and `scene` with the changes.
    pub fn new(written: &Scene, changes: Vec<(String, String)>) -> Self {
        let mut whole = written.clone();
        whole.resolve_defaults();
        let written: Table = whole.to_toml().ok().and_then(|text| text.parse().ok()).unwrap_or_default();
        Self { groups: groups(&whole, &written), written, applied: changes.clone(), changes }
    }

    /// None.
    pub fn none() -> Self {
        Self { groups: Vec::new(), written: Table::new(), changes: Vec::new(), applied: Vec::new() }
    }

    /// All changes.
    pub fn changes(&self) -> &[(String, String)] {
        &self.changes
    }

    /// True where changes wait for a restart.
    pub fn waits(&self) -> bool {
        self.changes != self.applied
    }

    /// Shows them; gives what is to be done.
    pub fn ui(&mut self, ui: &mut Ui) -> Vec<Changed> {
        let mut done = Vec::new();
        let groups = std::mem::take(&mut self.groups);
        for group in &groups {
            ui.add_space(8.0);
            ui.label(RichText::new(&group.name).text_style(egui::TextStyle::Name(crate::style::STRONG.into())));
            for parameter in &group.parameters {
                if let Some(value) = self.row(ui, parameter) {
                    let number = value.parse::<f64>().ok();
                    self.set(&parameter.path, value.clone());
                    if let (Some(live), Some(number)) = (parameter.live, number) {
                        let change = self.change_of(&parameter.path);
                        set(&mut self.applied, &parameter.path, change);
                        done.push(Changed::Live(live(&parameter.path, number)));
                    }
                }
            }
        }
        self.groups = groups;
        done
    }

    /// What is said at the end of the list, where changes wait.
    pub fn waiting(&mut self, ui: &mut Ui) -> Option<Changed> {
        if !self.waits() {
            return None;
        }
        let mut restart = false;
        ui.horizontal(|ui| {
            let accent = ui.visuals().selection.bg_fill;
            let text = RichText::new("Restart with changes").color(ui.visuals().selection.stroke.color);
            restart = ui.add(egui::Button::new(text).fill(accent)).on_hover_text("R").clicked();
            if ui.button("Undo").on_hover_text("Back to what the scene goes on with").clicked() {
                self.changes = self.applied.clone();
            }
        });
        restart.then_some(Changed::Restart)
    }

    fn change_of(&self, path: &str) -> Option<String> {
        self.changes.iter().find(|(changed, _)| changed == path).map(|(_, value)| value.clone())
    }

    fn set(&mut self, path: &str, value: String) {
        let written = value_at(&self.written, path).map(ToString::to_string);
        let same = written.as_deref() == Some(&value)
            || written.and_then(|written| written.parse::<f64>().ok()).is_some_and(|w| value.parse() == Ok(w));
        set(&mut self.changes, path, (!same).then_some(value));
    }

    /// The value now, as it is written in a scene.
    fn value(&self, path: &str) -> Option<Value> {
        match self.change_of(path) {
            Some(value) => format!("v = {value}").parse::<Table>().ok()?.remove("v"),
            None => value_at(&self.written, path).cloned(),
        }
    }

    /// One parameter; gives its value where it was changed.
    fn row(&self, ui: &mut Ui, parameter: &Parameter) -> Option<String> {
        let value = self.value(&parameter.path)?;
        let changed = self.change_of(&parameter.path).is_some();
        let mut new = None;
        let when = if parameter.live.is_some() { "changes at once" } else { "changes on restart" };
        let hint = format!("{}\n{} ({when})", parameter.hint, parameter.path);
        ui.horizontal(|ui| {
            ui.label(&parameter.name).on_hover_text(&hint);
            let note = if parameter.live.is_some() { "live" } else { "" };
            ui.label(RichText::new(note).small().color(crate::style::accent(ui.visuals())));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let name = format!("Reset {}", parameter.name);
                if changed && icons::sized(ui, Icon::Undo, &name, "as written", 20.0, false).clicked() {
                    new = value_at(&self.written, &parameter.path).map(ToString::to_string);
                }
            });
        });
        let told = format!("{}, {}", parameter.name, parameter.unit);
        match &parameter.control {
            Control::Choice(choices) => {
                let now = value.to_string();
                let name = choices.iter().find(|(_, written)| *written == now).map_or("other", |(name, _)| *name);
                let combo =
                    ComboBox::from_id_salt(&parameter.path).selected_text(name).width(ui.available_width() - 4.0);
                let shown = combo.show_ui(ui, |ui| {
                    for (name, written) in *choices {
                        if ui.selectable_label(now == *written, *name).clicked() {
                            new = Some((*written).to_owned());
                        }
                    }
                });
                shown.response.widget_info(|| WidgetInfo::labeled(egui::Role::ComboBox, true, &parameter.name));
            }
            Control::Number { range, logarithmic } => {
                let mut number = as_number(&value)?;
                if slider(ui, &mut number, *range, *logarithmic, false, parameter.unit, &told) {
                    new = Some(written(number));
                }
            }
            Control::Whole(range) => {
                let mut number = as_number(&value)?;
                if slider(ui, &mut number, *range, range[1] > 1000.0, true, parameter.unit, &told) {
                    new = Some(format!("{number:.0}"));
                }
            }
        }
        new
    }
}

/// Width of a number beside its slider, points.
const VALUE: f32 = 92.0;

/// A slider with its number beside it; true where it was changed.
fn slider(
    ui: &mut Ui,
    number: &mut f64,
    range: [f64; 2],
    logarithmic: bool,
    whole: bool,
    unit: &str,
    name: &str,
) -> bool {
    let before = *number;
    let range = [range[0].min(before), range[1].max(before)];
    ui.horizontal(|ui| {
        ui.spacing_mut().slider_width = (ui.available_width() - VALUE - 12.0).max(60.0);
        let mut slider = Slider::new(number, range[0]..=range[1]).logarithmic(logarithmic).show_value(false);
        if whole {
            slider = slider.integer();
        }
        let response = ui.add(slider);
        response.widget_info(|| WidgetInfo::slider(true, before, name));
        if response.changed() && !whole {
            *number = rounded(*number, range);
        }
        let speed = (range[1] - range[0]) / 400.0;
        let mut typed = DragValue::new(number).range(range[0]..=range[1]).speed(speed);
        if whole {
            typed = typed.fixed_decimals(0);
        } else {
            typed = typed.custom_formatter(|number, _| corpuscle_drawing::text::short_number(number));
        }
        if !unit.is_empty() {
            typed = typed.suffix(format!(" {unit}"));
        }
        let typed = ui.add_sized([VALUE, 24.0], typed);
        typed.widget_info(|| WidgetInfo { label: Some(name.into()), ..WidgetInfo::drag_value(true, before) });
    });
    *number != before
}

/// A number with the figures that a slider tells apart.
fn rounded(number: f64, range: [f64; 2]) -> f64 {
    let step = 10_f64.powf((number.abs().max(1e-3 * (range[1] - range[0]))).log10().floor() - 2.0);
    let rounded = (number / step).round() * step;
    // Without the digits that binary numbers leave behind.
    format!("{rounded:.12e}").parse().unwrap_or(rounded)
}

/// A number as it is written in a scene: never taken for a whole one.
fn written(number: f64) -> String {
    Value::Float(number).to_string()
}

fn set(changes: &mut Vec<(String, String)>, path: &str, value: Option<String>) {
    let at = changes.iter().position(|(changed, _)| changed == path);
    match (at, value) {
        (Some(at), Some(value)) => changes[at].1 = value,
        (Some(at), None) => {
            changes.remove(at);
        }
        (None, Some(value)) => changes.push((path.to_owned(), value)),
        (None, None) => {}
    }
}

fn as_number(value: &Value) -> Option<f64> {
    match value {
        Value::Integer(number) => Some(*number as f64),
        Value::Float(number) => Some(*number),
        _ => None,
    }
}

/// The value at a path as on the command line: rows of lists are counted from 0.
fn value_at<'a>(document: &'a Table, path: &str) -> Option<&'a Value> {
    let mut words = path.split('.');
    let mut value = document.get(words.next()?)?;
    for word in words {
        value = match value {
            Value::Table(table) => table.get(word)?,
            Value::Array(rows) => rows.get(word.parse::<usize>().ok()?)?,
            _ => return None,
        };
    }
    Some(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Source;
    use corpuscle::scene::BUILTIN;

    /// Every value that is offered can be set through its path, to the ends of its range or another choice.
    #[test]
    fn every_parameter_of_every_scene_can_be_changed() {
        let mut refused = Vec::new();
        for builtin in BUILTIN {
            let scene = Scene::parse(builtin.text, builtin.name, &[]).unwrap();
            let parameters = Parameters::new(&scene, Vec::new());
            let all: Vec<_> = parameters.groups.iter().flat_map(|group| &group.parameters).collect();
            assert!(all.len() >= 4, "{}: {}", builtin.name, all.len());
            for parameter in all {
                let values = match &parameter.control {
                    Control::Number { range, .. } => range.map(written).to_vec(),
                    Control::Whole(range) => range.map(|number| format!("{number:.0}")).to_vec(),
                    Control::Choice(choices) => choices.iter().map(|(_, written)| (*written).to_owned()).collect(),
                };
                for value in values {
                    let changes = vec![(parameter.path.clone(), value.clone())];
                    let changed = Source { changes, ..Source::from(*builtin) }.scene();
                    if let Err(error) = changed {
                        refused.push(format!("{} {} = {value}: {error}", builtin.name, parameter.path));
                    }
                }
            }
        }
        assert!(refused.is_empty(), "{}", refused.join("\n"));
    }

    #[test]
    fn a_change_that_is_taken_back_is_none() {
        let builtin = corpuscle::scene::builtin("gas/maxwell").unwrap();
        let mut parameters = Parameters::new(&Scene::parse(builtin.text, builtin.name, &[]).unwrap(), Vec::new());
        parameters.set("gas.restitution", "0.9".into());
        assert_eq!(parameters.changes(), [("gas.restitution".to_owned(), "0.9".to_owned())]);
        assert!(parameters.waits());
        parameters.set("gas.restitution", "1.0".into());
        assert!(parameters.changes().is_empty() && !parameters.waits());
    }

    #[test]
    fn sliders_give_round_numbers() {
        assert_eq!(rounded(0.123_456, [0.0, 1.0]), 0.123);
        assert_eq!(rounded(12_345.6, [0.0, 1e5]), 12_300.0);
        assert_eq!(rounded(0.0, [0.0, 1.0]), 0.0);
    }
}

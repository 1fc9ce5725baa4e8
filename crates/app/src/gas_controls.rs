//! The live controls of a gas.

use crate::physics::Change;
use crate::snapshot::Snapshot;
use corpuscle::GasLiveChange as LiveChange;
use corpuscle::scene::{Axis, Gas, Wall};
use corpuscle_drawing::text::short_number;
use egui::{Button, RichText, Slider, SliderClamping, Ui, WidgetInfo};

/// Factor on the energy of a gas when it is heated once.
const WARMER: f64 = 1.15;
/// Fraction of the balls of a set that are added or removed at once.
const PART: f64 = 0.1;

/// Largest packing fraction to which a piston can be dragged, in two and three dimensions; the model accepts a little more.
const PRESSED: [f64; 2] = [0.57, 0.42];

/// What controls hold.
#[derive(Debug, Clone, Default)]
pub struct GasControls {
    /// True once the partition is lifted.
    pub lifted: bool,
    /// The temperature that is held, if any.
    temperature: Option<f64>,
    /// Pistons that are held, and their target positions.
    pistons: Vec<([usize; 2], f64)>,
}

/// An action of the user.
pub enum GasAction {
    /// Changes all speeds.
    Heated(Change),
    /// Lifts the partition.
    Lifted(Change),
    /// Any other change.
    Changed(Change),
}

/// Shows the controls of a gas; returns the action of the user.
pub fn ui(ui: &mut Ui, gas: &Gas, controls: &mut GasControls, snapshot: Option<&Snapshot>) -> Option<GasAction> {
    ui.add_space(8.0);
    ui.label(RichText::new("Controls").text_style(egui::TextStyle::Name(crate::style::STRONG.into())));
    let mut action = heat(ui);
    if let Some(snapshot) = snapshot {
        action = action.or(hold(ui, controls, snapshot));
        action = action.or(balls(ui, snapshot));
        for axis in Axis::ALL.into_iter().take(gas.dimensions()) {
            for (end, wall) in gas.walls.along(axis).into_iter().enumerate() {
                if matches!(wall, Wall::Piston { .. }) {
                    action = action.or(piston(ui, [axis.index(), end], gas, controls, snapshot));
                }
            }
        }
    }
    if gas.partition.is_some() {
        ui.add_enabled_ui(!controls.lifted, |ui| {
            let name = if controls.lifted { "The partition is lifted" } else { "Lift the partition" };
            if wide(ui, name, "") {
                controls.lifted = true;
                action = Some(GasAction::Lifted(live(LiveChange::LiftPartition)));
            }
        });
    }
    action
}

fn heat(ui: &mut Ui) -> Option<GasAction> {
    let heat = |factor: f64| GasAction::Heated(live(LiveChange::Heat(factor)));
    let hint = "Scales all velocities: 13 % less energy, booked as outflow of energy.";
    let cooler = ("Cool", hint);
    let hint = "Scales all velocities: 15 % more energy, booked as inflow of energy.";
    match pair(ui, cooler, ("Heat", hint)) {
        [true, _] => Some(heat(1.0 / WARMER)),
        [_, true] => Some(heat(WARMER)),
        _ => None,
    }
}

/// Holds the current temperature, or releases it.
fn hold(ui: &mut Ui, controls: &mut GasControls, snapshot: &Snapshot) -> Option<GasAction> {
    let now = gauge(snapshot, &["gas.temperature", "gas.temperature_K"])?;
    let name = match controls.temperature {
        Some(held) => format!("Release the temperature: {}", short_number(held)),
        None => "Hold the temperature".into(),
    };
    let hint = "Scales all velocities repeatedly, so that the temperature stays. The energy is booked.";
    if !wide(ui, &name, hint) {
        return None;
    }
    controls.temperature = if controls.temperature.is_some() { None } else { Some(now).filter(|now| *now > 0.0) };
    Some(GasAction::Heated(live(LiveChange::HoldTemperature(controls.temperature))))
}

/// Removes balls from a set, or adds some.
fn balls(ui: &mut Ui, snapshot: &Snapshot) -> Option<GasAction> {
    let mut action = None;
    let alone = snapshot.frame.sets.len() == 1;
    for (number, set) in snapshot.frame.sets.iter().enumerate() {
        let count = ((PART * set.len() as f64).round() as usize).max(1);
        let what = if alone { String::new() } else { format!(" of {}", set.name) };
        let out = (format!("Remove {count}{what}"), "Removes balls at random. Their number and energy are booked.");
        let come = (
            format!("Add {count}{what}"),
            "Adds balls at free positions, at the temperature of the gas. Their number and energy are booked.",
        );
        match pair(ui, (&out.0, out.1), (&come.0, come.1)) {
            [true, _] => action = Some(LiveChange::RemoveBalls { set: number, count }),
            [_, true] => action = Some(LiveChange::AddBalls { set: number, count }),
            _ => {}
        }
    }
    action.map(|change| GasAction::Heated(live(change)))
}

/// Drags a piston, and releases it.
fn piston(
    ui: &mut Ui,
    wall: [usize; 2],
    gas: &Gas,
    controls: &mut GasControls,
    snapshot: &Snapshot,
) -> Option<GasAction> {
    let container = snapshot.container?;
    let [axis, end] = wall;
    let now = [container.from, container.to][end][axis];
    let other = [container.from, container.to][1 - end][axis];
    let held = controls.pistons.iter().position(|(held, _)| *held == wall);
    let before = held.map_or(now, |held| controls.pistons[held].1);
    let mut to = before;
    let name = format!("Piston {}_{}", ["x", "y", "z"][axis], ["min", "max"][end]);
    // From the largest packing fraction to twice the length of the box.
    let full = PRESSED[usize::from(gas.dimensions() > 2)];
    let least = (now - other).abs() * gauge(snapshot, &["gas.packing"])? / full;
    let most = 2.0 * gas.size.get(axis).copied().unwrap_or(1.0);
    let range = if end == 1 { [other + least, other + most] } else { [other - most, other - least] };
    ui.label(&name)
        .on_hover_text("Drag: the piston moves there slowly and is held until you release it. Its work is booked.");
    let mut action = None;
    ui.horizontal(|ui| {
        ui.spacing_mut().slider_width = (ui.available_width() - 150.0).max(60.0);
        // The position of a piston that nobody drags is not rounded: that would be a drag.
        let slider = Slider::new(&mut to, range[0]..=range[1]).max_decimals(3).clamping(SliderClamping::Edits);
        let response = ui.add(slider);
        response.widget_info(|| WidgetInfo::slider(true, before, &name));
        if response.changed() && to != before {
            controls.pistons.retain(|(held, _)| *held != wall);
            controls.pistons.push((wall, to));
            action = Some(GasAction::Changed(live(LiveChange::DragPiston { wall, to })));
        }
        if held.is_some() && ui.button("Release").clicked() {
            controls.pistons.retain(|(held, _)| *held != wall);
            action = Some(GasAction::Changed(live(LiveChange::LetPistonGo { wall })));
        }
    });
    action
}

/// Last value of a gauge with one of these names.
fn gauge(snapshot: &Snapshot, names: &[&str]) -> Option<f64> {
    let at = snapshot.measures.names.iter().position(|name| names.contains(&name.as_str()))?;
    snapshot.measures.gauges.get(at).copied()
}

/// Shows a button over the whole width; true where it was clicked.
fn wide(ui: &mut Ui, name: &str, hint: &str) -> bool {
    // Leave room for the scroll bar.
    let size = [ui.available_width() - 4.0, 28.0];
    let response = ui.add_sized(size, Button::new(name));
    let clicked = response.clicked();
    if !hint.is_empty() {
        response.on_hover_text(hint);
    }
    clicked
}

/// Shows two buttons side by side, each with its hint; returns which were clicked.
fn pair(ui: &mut Ui, left: (&str, &str), right: (&str, &str)) -> [bool; 2] {
    ui.horizontal(|ui| {
        let size = [0.5 * (ui.available_width() - 12.0), 28.0];
        [left, right].map(|(name, hint)| ui.add_sized(size, Button::new(name)).on_hover_text(hint).clicked())
    })
    .inner
}

fn live(change: LiveChange) -> Change {
    Change::Model(vec![change.into()])
}

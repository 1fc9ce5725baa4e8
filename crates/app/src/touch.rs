//! What a hand does to a gas while it goes on.

use crate::physics::Change;
use crate::snapshot::Snapshot;
use corpuscle::GasLiveChange as LiveChange;
use corpuscle::scene::{Axis, Gas, Wall};
use corpuscle_drawing::text::short_number;
use egui::{Button, RichText, Slider, Ui, WidgetInfo};

/// How many times its energy a gas has after it was heated once.
const WARMER: f64 = 1.15;
/// Part of the balls of a set that come or go at once.
const PART: f64 = 0.1;

/// Packing to which a piston is dragged at most, in two and three dimensions; the gas itself bears a little more.
const PRESSED: [f64; 2] = [0.57, 0.42];

/// What hands hold.
#[derive(Debug, Clone, Default)]
pub struct Hands {
    /// True once the partition is gone.
    pub lifted: bool,
    /// The temperature that is held.
    temperature: Option<f64>,
    /// Pistons that are held, and where they are to be.
    pistons: Vec<([usize; 2], f64)>,
}

/// What was done.
pub enum Touched {
    /// Speeds changed at once.
    Heated(Change),
    /// The partition was lifted.
    Lifted(Change),
    /// Something else.
    Changed(Change),
}

/// Buttons for a gas.
pub fn ui(ui: &mut Ui, gas: &Gas, hands: &mut Hands, snapshot: Option<&Snapshot>) -> Option<Touched> {
    ui.add_space(8.0);
    ui.label(RichText::new("By hand").text_style(egui::TextStyle::Name(crate::style::STRONG.into())));
    let mut touched = heat(ui);
    if let Some(snapshot) = snapshot {
        touched = touched.or(hold(ui, hands, snapshot));
        touched = touched.or(balls(ui, snapshot));
        for axis in Axis::ALL.into_iter().take(gas.dimensions()) {
            for (end, wall) in gas.walls.along(axis).into_iter().enumerate() {
                if matches!(wall, Wall::Piston { .. }) {
                    touched = touched.or(piston(ui, [axis.index(), end], gas, hands, snapshot));
                }
            }
        }
    }
    if gas.partition.is_some() {
        ui.add_enabled_ui(!hands.lifted, |ui| {
            let name = if hands.lifted { "The partition is lifted" } else { "Lift the partition" };
            if wide(ui, name, "") {
                hands.lifted = true;
                touched = Some(Touched::Lifted(live(LiveChange::LiftPartition)));
            }
        });
    }
    touched
}

fn heat(ui: &mut Ui) -> Option<Touched> {
    let heat = |factor: f64| Touched::Heated(live(LiveChange::Heat(factor)));
    let hint = "All velocities shrink: 13 % less energy. What is taken away is booked as outflow of energy.";
    let cooler = ("Cool", hint);
    let hint = "All velocities grow: 15 % more energy. What is given is booked as inflow of energy.";
    match pair(ui, cooler, ("Heat", hint)) {
        [true, _] => Some(heat(1.0 / WARMER)),
        [_, true] => Some(heat(WARMER)),
        _ => None,
    }
}

/// Holds the temperature that there is, or no longer.
fn hold(ui: &mut Ui, hands: &mut Hands, snapshot: &Snapshot) -> Option<Touched> {
    let now = gauge(snapshot, &["gas.temperature", "gas.temperature_K"])?;
    let name = match hands.temperature {
        Some(held) => format!("Hold the temperature no longer: {}", short_number(held)),
        None => "Hold the temperature".into(),
    };
    let hint = "All velocities are scaled again and again, so that the temperature stays. What that gives and takes is booked.";
    if !wide(ui, &name, hint) {
        return None;
    }
    hands.temperature = if hands.temperature.is_some() { None } else { Some(now).filter(|now| *now > 0.0) };
    Some(Touched::Heated(live(LiveChange::HoldTemperature(hands.temperature))))
}

/// Takes balls out of a set, or puts some in.
fn balls(ui: &mut Ui, snapshot: &Snapshot) -> Option<Touched> {
    let mut touched = None;
    let alone = snapshot.frame.sets.len() == 1;
    for (number, set) in snapshot.frame.sets.iter().enumerate() {
        let count = ((PART * set.len() as f64).round() as usize).max(1);
        let what = if alone { String::new() } else { format!(" of {}", set.name) };
        let out = (format!("Take {count} out{what}"), "Balls go at random. Their number and their energy are booked.");
        let come = (
            format!("Add {count}{what}"),
            "Balls come at free places, as warm as the gas. Number and energy are booked.",
        );
        match pair(ui, (&out.0, out.1), (&come.0, come.1)) {
            [true, _] => touched = Some(LiveChange::RemoveBalls { set: number, count }),
            [_, true] => touched = Some(LiveChange::AddBalls { set: number, count }),
            _ => {}
        }
    }
    touched.map(|change| Touched::Heated(live(change)))
}

/// Drags a piston, and lets it go.
fn piston(ui: &mut Ui, wall: [usize; 2], gas: &Gas, hands: &mut Hands, snapshot: &Snapshot) -> Option<Touched> {
    let container = snapshot.container?;
    let [axis, end] = wall;
    let now = [container.from, container.to][end][axis];
    let other = [container.from, container.to][1 - end][axis];
    let held = hands.pistons.iter().position(|(held, _)| *held == wall);
    let before = held.map_or(now, |held| hands.pistons[held].1);
    let mut to = before;
    let name = format!("Piston {}_{}", ["x", "y", "z"][axis], ["min", "max"][end]);
    // From where the balls still have some room to twice the length of the box.
    let full = PRESSED[usize::from(gas.dimensions() > 2)];
    let least = (now - other).abs() * gauge(snapshot, &["gas.packing"])? / full;
    let most = 2.0 * gas.size.get(axis).copied().unwrap_or(1.0);
    let range = if end == 1 { [other + least, other + most] } else { [other - most, other - least] };
    ui.label(&name)
        .on_hover_text("Drag it: it goes there slowly, and is held there until you let it go. Its work is booked.");
    let mut touched = None;
    ui.horizontal(|ui| {
        ui.spacing_mut().slider_width = (ui.available_width() - 150.0).max(60.0);
        let response = ui.add(Slider::new(&mut to, range[0]..=range[1]).max_decimals(3));
        response.widget_info(|| WidgetInfo::slider(true, before, &name));
        if response.changed() && to != before {
            hands.pistons.retain(|(held, _)| *held != wall);
            hands.pistons.push((wall, to));
            touched = Some(Touched::Changed(live(LiveChange::DragPiston { wall, to })));
        }
        if held.is_some() && ui.button("Let go").clicked() {
            hands.pistons.retain(|(held, _)| *held != wall);
            touched = Some(Touched::Changed(live(LiveChange::LetPistonGo { wall })));
        }
    });
    touched
}

/// What a gauge of one of these names was measured at last.
fn gauge(snapshot: &Snapshot, names: &[&str]) -> Option<f64> {
    let at = snapshot.measures.names.iter().position(|name| names.contains(&name.as_str()))?;
    snapshot.measures.gauges.get(at).copied()
}

/// A button over the whole width; true where it was clicked.
fn wide(ui: &mut Ui, name: &str, hint: &str) -> bool {
    // Clear of the bar that scrolls.
    let size = [ui.available_width() - 4.0, 28.0];
    let response = ui.add_sized(size, Button::new(name));
    let clicked = response.clicked();
    if !hint.is_empty() {
        response.on_hover_text(hint);
    }
    clicked
}

/// Two buttons beside each other, each with its hint; which were clicked.
fn pair(ui: &mut Ui, left: (&str, &str), right: (&str, &str)) -> [bool; 2] {
    ui.horizontal(|ui| {
        let size = [0.5 * (ui.available_width() - 12.0), 28.0];
        [left, right].map(|(name, hint)| ui.add_sized(size, Button::new(name)).on_hover_text(hint).clicked())
    })
    .inner
}

fn live(change: LiveChange) -> Change {
    Box::new(move |simulation| simulation.change_live(change))
}

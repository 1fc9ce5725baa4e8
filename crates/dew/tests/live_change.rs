//! Live changes of dew: what is changed while it runs.

mod common;

use common::advance;
use corpuscle_dew::humid_air::ZERO_CELSIUS;
use corpuscle_dew::{Dew, LiveChange, SourceChange, open};
use corpuscle_model::Model;
use corpuscle_scene::Scene;
use std::path::Path;

/// Warm damp air flows past a cold pane.
const PANE: &str = r#"
run.until_s = 5
[dew]
size_m = [0.012, 0.012, 0.018]
spacing_m = 0.003
air = { temperature_c = 30.0, relative_humidity = 0.6 }
drops = { contact_angle_deg = 80.0, friction = 4e-5, smallest_radius_m = 1e-4 }
[dew.faces]
x_max = { inflow = { velocity_m_per_s = [-0.05, 0.0, 0.0] } }
y_min = "periodic"
y_max = "periodic"
z_min = "outflow"
[[dew.solid]]
name = "pane"
shape = { box = { size_m = [0.006, 0.012, 0.018] } }
position_m = [0.0, 0.006, 0.009]
material = "glass"
temperature_c = 25.0
held = true
[[dew.fan]]
position_m = [0.009, 0.006, 0.009]
size_m = [0.003, 0.012, 0.006]
velocity_m_per_s = [0.0, 0.0, -0.1]
"#;

/// The same without holding the pane's temperature, in a closed box without a fan.
fn closed() -> String {
    let open = "x_max = { inflow = { velocity_m_per_s = [-0.05, 0.0, 0.0] } }";
    let text = PANE.replace("held = true", "").replace("z_min = \"outflow\"", "").replace(open, "");
    text[..text.find("[[dew.fan]]").unwrap()].to_owned()
}

fn scene(text: &str) -> Dew {
    let mut scene = Scene::parse(text, "test", &[]).unwrap();
    scene.resolve_defaults();
    let dew = scene.dew().unwrap();
    open(dew, 1, Path::new(".")).unwrap()
}

/// Both ledgers balance; gives inflow and outflow of energy, J.
fn energy(dew: &Dew) -> [f64; 2] {
    for balance in dew.ledger().balances {
        assert!(balance.relative_error().abs() < 1e-10, "{balance:?}: {:e}", balance.relative_error());
    }
    let energy = &dew.ledger().balances[1];
    [energy.inflow, energy.outflow]
}

fn after(text: &str, changes: &[LiveChange], time: f64) -> Dew {
    let mut dew = scene(text);
    advance(&mut dew, 0.2);
    changes.iter().for_each(|change| change.change(&mut dew).unwrap());
    advance(&mut dew, time);
    energy(&dew);
    dew
}

fn water_on(dew: &Dew) -> f64 {
    dew.water_on_body(0)
}

#[test]
fn a_pane_that_is_cooled_live_fogs() {
    let cooled = LiveChange::SolidTemperature { solid: 0, celsius: 5.0 };
    let (left, cold) = (after(PANE, &[], 0.8), after(PANE, &[cooled], 0.8));
    assert!(water_on(&left) == 0.0 && water_on(&cold) > 1e-9, "{} {}", water_on(&left), water_on(&cold));
    assert!(cold.temperatures().iter().all(|temperature| (temperature - ZERO_CELSIUS - 5.0).abs() < 1e-9));
}

#[test]
fn a_pane_that_is_free_is_given_its_heat() {
    let text = closed();
    let mut dew = scene(&text);
    advance(&mut dew, 0.2);
    let before = energy(&dew);
    LiveChange::SolidTemperature { solid: 0, celsius: 60.0 }.change(&mut dew).unwrap();
    let given = energy(&dew)[0] - before[0];
    // Half of the box is in the room: 3 mm x 12 mm x 18 mm of glass, and no more of it than its particles fill.
    let glass: f64 = (0..dew.solids().particles.len()).map(|i| dew.solids().heat_capacity(i)).sum();
    assert!((given / (35.0 * glass) - 1.0).abs() < 0.01, "{given} {}", 35.0 * glass);
    advance(&mut dew, 0.5);
    LiveChange::SolidTemperature { solid: 0, celsius: 0.0 }.change(&mut dew).unwrap();
    let taken = energy(&dew)[1];
    assert!(taken > 1.5 * given, "{taken} {given}");
    advance(&mut dew, 0.8);
    energy(&dew);
}

#[test]
fn air_comes_in_as_it_is_changed_live() {
    let face = [0, 1];
    let cold = LiveChange::SolidTemperature { solid: 0, celsius: 15.0 };
    let of = |changes: &[LiveChange]| {
        let all: Vec<LiveChange> = [cold].into_iter().chain(changes.iter().copied()).collect();
        after(PANE, &all, 1.5)
    };
    let vapour = |dew: &Dew| dew.ledger().balances[0].inflow;
    let (left, damp) = (of(&[]), of(&[LiveChange::InletHumidity { face, relative: 0.95 }]));
    assert!(vapour(&damp) > 1.3 * vapour(&left), "{} {}", vapour(&damp), vapour(&left));
    assert!(water_on(&damp) > 1.2 * water_on(&left), "{} {}", water_on(&damp), water_on(&left));
    let warmth = |dew: &Dew| dew.air().iter().map(|air| air.temperature).fold(0.0, f64::max) - ZERO_CELSIUS;
    let warm = of(&[LiveChange::InletTemperature { face, celsius: 50.0 }]);
    assert!(warmth(&left) < 31.0 && warmth(&warm) > 45.0, "{} {}", warmth(&left), warmth(&warm));
    // As much vapour comes in as before.
    assert!((vapour(&warm) / vapour(&left) - 1.0).abs() < 0.02, "{} {}", vapour(&warm), vapour(&left));
    let windy = of(&[LiveChange::Wind { face, axis: 0, velocity: -0.1 }]);
    let more = vapour(&windy) / vapour(&left);
    assert!(more > 1.7 && more < 2.0, "{more}");
}

#[test]
fn a_fan_drives_as_it_is_changed_live() {
    // The fastest downwards where the fan is.
    let downwards = |dew: &Dew| {
        let within = |position: [f64; 3]| position[0] > 0.0075 && (0.006..0.012).contains(&position[2]);
        let here = dew.air().iter().filter(|air| within(air.position));
        here.map(|air| -air.velocity[2]).fold(f64::NEG_INFINITY, f64::max)
    };
    let of = |velocity: f64| downwards(&after(PANE, &[LiveChange::FanVelocity { fan: 0, axis: 2, velocity }], 0.6));
    // Cooled air sinks at up to 0.06 m/s there.
    let (off, slow, fast) = (of(0.0), of(-0.15), of(-0.4));
    assert!(fast > 1.5 * slow && slow > 1.5 * off, "{fast} {slow} {off}");
}

#[test]
fn drops_run_to_where_gravity_points() {
    let fall = |changes: &[LiveChange]| {
        let text = PANE.replace(
            "friction = 4e-5, smallest_radius_m = 1e-4",
            "friction = 1e-7, smallest_radius_m = 3e-5, sites_per_m2 = 1e7",
        );
        let cold = LiveChange::SolidTemperature { solid: 0, celsius: 0.0 };
        let all: Vec<LiveChange> =
            [cold, LiveChange::TimeFactor(20.0)].into_iter().chain(changes.iter().copied()).collect();
        let dew = after(&text, &all, 1.5);
        let frame = dew.frame();
        let drops = frame.sets.iter().find(|set| set.name == "drops").unwrap();
        assert!(!drops.velocity.is_empty());
        let sum = |axis: usize| drops.velocity.iter().map(|velocity| velocity[axis]).sum::<f64>();
        [sum(1), sum(2)]
    };
    let tilted =
        [LiveChange::Gravity { axis: 2, acceleration: 0.0 }, LiveChange::Gravity { axis: 1, acceleration: 9.81 }];
    let (upright, tilted) = (fall(&[]), fall(&tilted));
    assert!(upright[1] < 0.0 && upright[1].abs() > 10.0 * upright[0].abs(), "{upright:?}");
    assert!(tilted[0] > 0.0 && tilted[0].abs() > 10.0 * tilted[1].abs(), "{tilted:?}");
}

#[test]
fn accelerated_time_condenses_faster() {
    let cold = LiveChange::SolidTemperature { solid: 0, celsius: 5.0 };
    let (left, faster) = (after(PANE, &[cold], 0.5), after(PANE, &[cold, LiveChange::TimeFactor(10.0)], 0.5));
    let times = water_on(&faster) / water_on(&left);
    assert!(times > 2.0 && times < 12.0, "{times}");
}

#[test]
fn dew_that_was_changed_goes_on_from_its_checkpoint_to_the_same_bits() {
    let mut dew = scene(PANE);
    advance(&mut dew, 0.2);
    let untouched = dew.save();
    for change in [
        LiveChange::SolidTemperature { solid: 0, celsius: 5.0 },
        LiveChange::InletHumidity { face: [0, 1], relative: 0.9 },
        LiveChange::Wind { face: [0, 1], axis: 0, velocity: -0.15 },
        LiveChange::FanVelocity { fan: 0, axis: 2, velocity: 0.2 },
        LiveChange::Gravity { axis: 1, acceleration: 3.0 },
        LiveChange::TimeFactor(4.0),
    ] {
        change.change(&mut dew).unwrap();
    }
    advance(&mut dew, 0.3);
    let mut again = scene(PANE);
    again.restore(&dew.save()).unwrap();
    advance(&mut dew, 0.5);
    advance(&mut again, 0.5);
    assert!(dew.save() == again.save());
    // And back to before anything was changed.
    dew.restore(&untouched).unwrap();
    let mut left = scene(PANE);
    left.restore(&untouched).unwrap();
    advance(&mut dew, 0.4);
    advance(&mut left, 0.4);
    assert!(dew.save() == left.save());
}

#[test]
fn what_cannot_be_is_refused_and_changes_nothing() {
    let mut dew = scene(PANE);
    let state = dew.save();
    let refused = [
        (LiveChange::SolidTemperature { solid: 1, celsius: 5.0 }, "solid 1"),
        (LiveChange::SolidTemperature { solid: 0, celsius: f64::NAN }, "temperature"),
        (LiveChange::InletTemperature { face: [1, 0], celsius: 5.0 }, "no air comes in"),
        (LiveChange::InletHumidity { face: [9, 9], relative: 0.5 }, "no air comes in"),
        (LiveChange::InletHumidity { face: [0, 1], relative: 1.5 }, "humidity"),
        (LiveChange::Wind { face: [0, 1], axis: 0, velocity: 0.1 }, "into the box"),
        (LiveChange::Wind { face: [0, 1], axis: 3, velocity: 0.1 }, "axis 3"),
        (LiveChange::FanVelocity { fan: 1, axis: 0, velocity: 0.1 }, "fan 1"),
        (LiveChange::Gravity { axis: 0, acceleration: f64::INFINITY }, "gravity"),
        (LiveChange::TimeFactor(0.5), "time factor"),
    ];
    for (change, word) in refused {
        let told = change.change(&mut dew).unwrap_err().to_string();
        assert!(told.contains(word), "{told}");
    }
    assert!(dew.save() == state);
    assert!(LiveChange::TimeFactor(2.0).change(&mut 5_u8).is_err());
}

/// The pane, free, with a heater over time, a wall and something outside, and radiation.
fn heated() -> String {
    closed()
        + "heater = { power_w_per_m2 = [[0, 100], [0.5, 200]] }\nradiation = { emissivity = 0.9, surroundings_c = 25 }\n\
           outside = { side = \"x_min\", temperature_c = 0, h_w_per_m2_k = 25, emissivity = 0.9, layers = [{ material = \"steel\", thickness_m = 0.001 }] }\n"
}

/// Heat that the pane gets from its heater, from outside and by radiation from 0.2 s to 0.4 s, J, after changes at 0.2 s; it is the same where the run goes on from a
/// checkpoint at 0.3 s.
fn supplied(changes: &[SourceChange]) -> [f64; 3] {
    let text = heated().replace("position_m = [0.0,", "position_m = [0.003,");
    let mut dew = scene(&text);
    advance(&mut dew, 0.2);
    let before = dew.heat_supplied(0);
    changes.iter().for_each(|&change| LiveChange::Source(change).change(&mut dew).unwrap());
    advance(&mut dew, 0.3);
    let mut resumed = scene(&text);
    resumed.restore(&dew.save()).unwrap();
    advance(&mut dew, 0.4);
    advance(&mut resumed, 0.4);
    energy(&dew);
    assert_eq!(dew.save(), resumed.save());
    let after = dew.heat_supplied(0);
    [0, 1, 2].map(|kind| after[kind] - before[kind])
}

#[test]
fn heaters_the_outside_and_surroundings_are_changed_live() {
    let solid = 0;
    let left = supplied(&[]);
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 0.02;
    let off = SourceChange::HeaterTimes { solid, times: 0.0 };
    let twice = SourceChange::HeaterTimes { solid, times: 2.0 };
    // So many times what the scene says, whatever it was before.
    let doubled = supplied(&[off, twice])[0];
    assert!((doubled / left[0] - 2.0).abs() < 1e-4, "{doubled} {}", left[0]);
    assert_eq!(supplied(&[twice, off])[0], 0.0);
    // The mean of 100 W/m2 at first and 200 W/m2 at 0.5 s, from 0.2 s to 0.4 s, is 160 W/m2.
    let constant = supplied(&[SourceChange::HeaterPower { solid, power: 160.0 }])[0];
    assert!(near(constant, left[0]), "{constant} {}", left[0]);
    let calm = supplied(&[SourceChange::OutsideTransfer { solid, coefficient: 0.0 }])[1];
    assert!(calm < 0.0 && calm > 0.3 * left[1], "what still radiates: {calm} of {}", left[1]);
    let mild = supplied(&[SourceChange::OutsideTemperature { solid, celsius: 24.0 }])[1];
    assert!(
        mild.abs() < 0.1 * left[1].abs(),
        "the sky, of which the scene tells nothing, is as warm as the air: {mild} {}",
        left[1]
    );
    let clear = supplied(&[SourceChange::OutsideSurroundings { solid, celsius: -100.0 }])[1];
    assert!(clear < 1.2 * left[1], "{clear} {}", left[1]);
    let hot = supplied(&[SourceChange::Surroundings { solid, celsius: 300.0 }])[2];
    assert!(hot > 10.0 * left[2].abs(), "{hot} {}", left[2]);
}

#[test]
fn sources_that_are_not_there_are_refused() {
    let mut dew = scene(PANE);
    let mut refused = |change: SourceChange, words: &str| {
        let error = LiveChange::Source(change).change(&mut dew).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    };
    refused(SourceChange::HeaterPower { solid: 0, power: 1.0 }, "no heater");
    refused(SourceChange::HeaterTimes { solid: 7, times: 1.0 }, "no heater");
    refused(SourceChange::OutsideTemperature { solid: 0, celsius: 1.0 }, "outside");
    refused(SourceChange::Surroundings { solid: 0, celsius: 1.0 }, "radiate");
    refused(SourceChange::HeaterPower { solid: 0, power: f64::NAN }, "power of a heater");
    refused(SourceChange::Surroundings { solid: 0, celsius: -300.0 }, "from -273.15");
}

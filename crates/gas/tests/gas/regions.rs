//! Regions of measurement, the centre of mass, and the collisions of the followed ball.

use crate::common::advance;
use corpuscle_gas::{Amount, Gas, Region, Setup, Side, Species};
use corpuscle_model::Model;

fn gauge<const D: usize>(gas: &Gas<D>, name: &str) -> f64 {
    let column = gas.gauge_columns().iter().position(|column| column.header() == name);
    gas.gauge_row()[column.unwrap_or_else(|| panic!("there is no {name}"))]
}

fn region<const D: usize>(name: &str, from: [f64; D], to: [f64; D]) -> Region<D> {
    Region { name: name.into(), from, to }
}

/// Two kinds of balls in a box, periodic or walled, cut into four regions beside one that is the whole.
fn cut(periodic: bool, method: corpuscle_gas::Method) -> Gas<2> {
    let mut setup = Setup::<2>::new([20.0, 15.0]).measured(0.0, 0.1).seed(5);
    setup.method = method;
    if periodic {
        setup = setup.periodic();
    }
    let heavy = Species { mass: 5.0, radius: 0.8, ..Species::new("heavy", Amount::Count(15)) };
    setup = setup.species(heavy).species(Species::new("light", Amount::Count(120)));
    let [x, y] = [7.3, 4.1];
    setup.regions = vec![
        region("a", [0.0, 0.0], [x, y]),
        region("b", [x, 0.0], [20.0, y]),
        region("c", [0.0, y], [x, 15.0]),
        region("d", [x, y], [20.0, 15.0]),
        region("all", [0.0, 0.0], [20.0, 15.0]),
    ];
    setup.build().unwrap()
}

#[test]
fn regions_share_out_what_the_whole_has() {
    for (periodic, method) in [
        (true, corpuscle_gas::Method::EventDriven),
        (false, corpuscle_gas::Method::EventDriven),
        (true, corpuscle_gas::Method::List),
    ] {
        let mut gas = cut(periodic, method);
        for time in [0.33, 2.0, 7.77, 30.0] {
            advance(&mut gas, time);
            let parts = |quantity: &str| -> f64 {
                let areas = [7.3 * 4.1, 12.7 * 4.1, 7.3 * 10.9, 12.7 * 10.9];
                let weighted = ["a", "b", "c", "d"].iter().zip(areas).map(|(name, area)| {
                    gauge(&gas, &format!("{name}.{quantity}")) * if quantity == "number" { 1.0 } else { area / 300.0 }
                });
                weighted.sum()
            };
            assert_eq!((parts("number"), gauge(&gas, "all.number")), (135.0, 135.0));
            assert!((parts("flow_x") - gauge(&gas, "all.flow_x")).abs() < 1e-12);
            let (whole, virial) = (gauge(&gas, "all.pressure"), gauge(&gas, "gas.pressure_virial"));
            // Relative to the flow in each part there is less; in the whole of a periodic box there is none.
            assert!(
                parts("pressure") <= whole * (1.0 + 1e-12) && parts("pressure") > 0.9 * whole,
                "{} {whole}",
                parts("pressure")
            );
            // Between walls the balls may move as a whole, which is no pressure.
            assert!((whole / virial - 1.0).abs() < 0.02, "at {time}: {whole} {virial}");
            if periodic {
                assert!((whole / virial - 1.0).abs() < 1e-9, "at {time}: {whole} {virial}");
                assert!((gauge(&gas, "all.temperature") / gas.temperature() - 1.0).abs() < 1e-12);
            }
        }
    }
}

/// In gravity the pressure of a layer carries the weight above its middle and what presses on the lid.
#[test]
fn the_pressure_of_layers_carries_what_lies_above() {
    let layers = 10;
    let (width, height, gravity) = (30.0, 40.0, 0.1);
    let thick = height / layers as f64;
    let mut setup = Setup::<2>::new([width, height]).measured(0.0, 0.5).seed(2);
    setup.gravity = [0.0, -gravity];
    setup.sides[0] = [Side::Periodic, Side::Periodic];
    setup = setup.species(Species::new("gas", Amount::Count(400)));
    let layer = |number: usize| {
        region(&format!("layer{number}"), [0.0, number as f64 * thick], [width, (number + 1) as f64 * thick])
    };
    setup.regions = (0..layers).map(layer).collect();
    let mut gas = setup.build().unwrap();
    let (rows, start) = (400, 60.0);
    let mut differences = vec![Vec::new(); layers];
    for row in 0..rows {
        // A row's pressure is the mean over five units of time.
        advance(&mut gas, start + 6.0 * row as f64);
        let numbers: Vec<f64> = (0..layers).map(|layer| gauge(&gas, &format!("layer{layer}.number"))).collect();
        for layer in 1..layers - 1 {
            let above = numbers[layer + 1..].iter().sum::<f64>() + 0.5 * numbers[layer];
            let carried = gauge(&gas, "y_max.pressure") + above * gravity / width;
            differences[layer].push(gauge(&gas, &format!("layer{layer}.pressure")) / carried - 1.0);
        }
    }
    for (layer, rows) in differences.iter().enumerate().filter(|(_, rows)| !rows.is_empty()) {
        let count = rows.len() as f64;
        let mean = rows.iter().sum::<f64>() / count;
        let error = (rows.iter().map(|row| (row - mean).powi(2)).sum::<f64>() / (count - 1.0) / count).sqrt();
        // Within a layer the density bends the pressure by less than a hundredth.
        assert!(mean.abs() < 3.5 * error + 0.01 && error < 0.02, "layer {layer}: {mean} with an error of {error}");
    }
    let (bottom, top) = (gauge(&gas, "layer1.pressure"), gauge(&gas, "layer8.pressure"));
    assert!(bottom > 2.0 * top, "{bottom} {top}");
}

#[test]
fn a_gas_that_moves_as_a_whole_flows_through_every_region() {
    let wind = Species { velocity: [3.0, -1.0, 0.5], ..Species::new("gas", Amount::Count(300)) };
    let mut setup = Setup::<3>::new([10.0; 3]).periodic().measured(0.0, 0.1).species(wind);
    setup.regions = vec![region("all", [0.0; 3], [10.0; 3]), region("half", [0.0; 3], [5.0, 10.0, 10.0])];
    let mut gas = setup.build().unwrap();
    let before = gas.centre_of_mass();
    advance(&mut gas, 10.0);
    for (axis, velocity) in [("x", 3.0), ("y", -1.0), ("z", 0.5)] {
        assert!((gauge(&gas, &format!("all.flow_{axis}")) - 0.3 * velocity).abs() < 1e-12);
        assert!((gauge(&gas, &format!("half.flow_{axis}")) - 0.3 * velocity).abs() < 0.15, "{axis}");
    }
    let moved = gas.centre_of_mass();
    for (axis, velocity) in [3.0, -1.0, 0.5].into_iter().enumerate() {
        assert!((moved[axis] - before[axis] - 10.0 * velocity).abs() < 1e-9);
    }
    assert!((gauge(&gas, "gas.centre_y") - moved[1]).abs() == 0.0);
    // Pressure and temperature are those of the motion relative to the flow.
    assert!((gauge(&gas, "all.temperature") - 1.0).abs() < 1e-9);
    // Carnahan & Starling (J. Chem. Phys. 51, 1969, 635); the wind's own momentum would add 1.0 to 0.59.
    let packing: f64 = 0.3 * std::f64::consts::PI / 6.0;
    let expected = 0.3 * (1.0 + packing + packing.powi(2) - packing.powi(3)) / (1.0 - packing).powi(3);
    let pressure = gauge(&gas, "all.pressure");
    assert!((pressure / expected - 1.0).abs() < 0.2, "{pressure} {expected}");
}

#[test]
fn collisions_of_the_followed_ball_are_counted_and_kept() {
    let mut setup = Setup::<2>::new([5.0, 6.0]).species(Species::new("pair", Amount::Count(2)));
    setup.follow = Some(1);
    setup.regions = vec![region("left", [0.0, 0.0], [2.5, 6.0])];
    let mut gas = setup.build().unwrap();
    advance(&mut gas, 400.0);
    assert!(gas.collisions() > 5, "{}", gas.collisions());
    assert_eq!(gauge(&gas, "ball 1.collisions"), gas.collisions() as f64);
    let saved = gas.save();
    advance(&mut gas, 800.0);
    let expected = gas.gauge_row();
    gas.restore(&saved).unwrap();
    advance(&mut gas, 800.0);
    let bits = |row: &[f64]| row.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&gas.gauge_row()), bits(&expected));
}

/// Balls of one name may have different masses.
#[test]
fn energies_of_the_kinds_add_up() {
    let mut setup = Setup::<2>::new([20.0, 20.0]).species(Species::new("light", Amount::Count(50)));
    for (number, mass) in [2.0, 30.0, 400.0].into_iter().enumerate() {
        let position = [3.0 + 6.0 * number as f64, 10.0];
        let ball = corpuscle_gas::Ball { name: "given".into(), position, velocity: [1.0, 0.0], radius: 1.0, mass };
        setup.balls.push(ball);
    }
    let mut gas = setup.build().unwrap();
    assert!((gauge(&gas, "given.kinetic_energy") - 216.0).abs() < 1e-9);
    advance(&mut gas, 5.0);
    let sum = gauge(&gas, "given.kinetic_energy") + gauge(&gas, "light.kinetic_energy");
    assert!((sum / gas.kinetic_energy() - 1.0).abs() < 1e-12);
}

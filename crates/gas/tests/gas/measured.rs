//! What is measured against what is known. The tight comparisons are in the validation cases; these take seconds.

use crate::common::{advance, scatter};
use corpuscle_gas::{Amount, Setup, Side, Species, Speeds};
use corpuscle_model::Model;

#[test]
fn pressure_and_collision_rate_of_a_fluid_are_those_known() {
    // Kolafa's equation and Enskog's rate at packing 0.3: Z = 3.98426, 10.102 collisions.
    let mut gas = Setup::<3>::fluid(2000, 0.3).measured(2.0, 0.1).build().unwrap();
    advance(&mut gas, 62.0);
    let (z, rate) = (gas.compressibility(), gas.collision_rate());
    // Some systematic error is left to a box of this size.
    assert!((z.mean - 3.98426).abs() < 3.0 * z.error + 0.01 && z.error < 0.01, "{z:?}");
    assert!((rate.mean / 10.102 - 1.0).abs() < 0.01, "{rate:?}");
    // Mean free path: mean speed over rate.
    let mean_speed = (8.0 / std::f64::consts::PI).sqrt();
    assert!((gas.mean_free_path().mean * rate.mean / mean_speed - 1.0).abs() < 0.01);
    // g at contact is (Z - 1) / (4 packing).
    let contact = gas.pair_distribution().into_iter().find(|row| row[0] > 1.0).unwrap();
    assert!((contact[1] / (2.98426 / 1.2) - 1.0).abs() < 0.1, "{contact:?}");
    let inside = gas.pair_distribution().into_iter().filter(|row| row[0] < 0.97).all(|row| row[1] == 0.0);
    assert!(inside);
}

/// Balls of one name that differ in mass, in a box that repeats along one axis only.
#[test]
fn temperatures_are_those_of_all_balls_whatever_their_masses() {
    for masses in [[1.0, 100.0], [100.0, 1.0]] {
        let mut setup = Setup::<2>::new([20.0, 20.0]).measured(0.0, 0.5);
        for (number, mass) in masses.into_iter().enumerate() {
            let along = 1.0 / f64::sqrt(mass);
            setup = setup.ball([5.0 + 10.0 * number as f64, 10.0], [0.0, along], 0.5, mass);
        }
        let gas = setup.build().unwrap();
        let column = |gauge: &str| {
            gas.gauge_columns()
                .iter()
                .position(|column| column.gauge == gauge && column.quantity == "temperature")
                .unwrap()
        };
        let row = gas.gauge_row();
        let columns = gas.gauge_columns();
        let own = &columns.iter().find(|column| column.quantity == "mean_square_displacement").unwrap().gauge;
        assert!((row[column("gas")] - 0.5).abs() < 1e-12 && (row[column(own)] - 0.5).abs() < 1e-12, "{own} {row:?}");
    }
    let mut setup = Setup::<2>::new([20.0, 20.0]).side(0, 0, Side::Periodic).side(0, 1, Side::Periodic);
    setup = setup.ball([5.0, 10.0], [0.0, 1.0], 0.5, 1.0);
    // Its motion between the walls is heat: of two directions one is free.
    let temperature = setup.build().unwrap().temperature();
    assert!((temperature - 1.0).abs() < 1e-12, "{temperature}");
}

/// Flights that gravity bends: a ball flies as far between collisions as its mean speed over its collision rate, and none flies less far than nothing.
#[test]
fn paths_bent_by_gravity_are_as_long_as_the_mean_speed_says() {
    let mut setup = Setup::<2>::new([60.0, 60.0]).measured(40.0, 0.5);
    setup.gravity = [0.0, -0.1];
    let mut gas = setup.species(Species::new("gas", Amount::Count(300))).build().unwrap();
    let path = gas.gauge_columns().iter().position(|column| column.quantity == "mean_free_path").unwrap();
    let mut temperature = 0.0;
    for time in 1..=400 {
        advance(&mut gas, f64::from(time));
        let row = gas.gauge_row()[path];
        assert!(row.is_nan() || row > 0.0, "{row} at {time}");
        temperature += if time > 40 { gas.temperature() / 360.0 } else { 0.0 };
    }
    // Of Maxwell's speeds in the plane.
    let mean_speed = (0.5 * std::f64::consts::PI * temperature).sqrt();
    let found = gas.mean_free_path().mean * gas.collision_rate().mean;
    assert!((found / mean_speed - 1.0).abs() < 0.01, "{found} {mean_speed}");
}

#[test]
fn virial_and_walls_tell_the_same_pressure() {
    let mut setup = Setup::<2>::new([60.0, 60.0]).measured(20.0, 1.0);
    setup = setup.species(Species::new("gas", Amount::Count(400)));
    let mut gas = setup.build().unwrap();
    advance(&mut gas, 300.0);
    let (virial, walls) = (gas.pressure_virial(), gas.pressure_walls());
    let left = gas.pressure_on(0, 0);
    let error = (virial.error.powi(2) + walls.error.powi(2)).sqrt();
    assert!(error / walls.mean < 0.02, "{virial:?} {walls:?}");
    assert!((virial.mean - walls.mean).abs() < 3.0 * error, "{virial:?} {walls:?}");
    assert!((left.mean - walls.mean).abs() < 4.0 * left.error);
}

#[test]
fn equal_speeds_become_maxwells() {
    let mut setup = Setup::<2>::fluid(2000, 0.2).seed(1);
    setup.species[0].speeds = Speeds::Equal;
    let mut gas = setup.build().unwrap();
    assert!(gas.maxwell_p_value() < 1e-6);
    // 25 collisions a ball.
    advance(&mut gas, 20.0);
    assert!(gas.maxwell_p_value() > 0.01, "{}", gas.maxwell_p_value());
}

#[test]
fn mixing_ends_at_full_entropy() {
    let half = |name: &str, from: f64| Species {
        region: Some([[from, 0.0], [from + 30.0, 30.0]]),
        radius: 0.2,
        ..Species::new(name, Amount::Count(400))
    };
    let mut gas = Setup::<2>::new([60.0, 30.0]).species(half("red", 0.0)).species(half("blue", 30.0)).build().unwrap();
    let full = 800.0 * std::f64::consts::LN_2;
    assert!(gas.mixing_entropy() < 0.01 * full);
    advance(&mut gas, 1500.0);
    assert!((gas.mixing_entropy() / full - 1.0).abs() < 0.03, "{} of {full}", gas.mixing_entropy());
}

#[test]
fn diffusion_is_told_for_each_species() {
    // Self-diffusion at packing 0.3 for many balls is 0.1945; a few hundred have a few percent less.
    let mut gas = Setup::<3>::fluid(500, 0.3).measured(1.0, 0.2).build().unwrap();
    advance(&mut gas, 21.0);
    let diffusion = gas.diffusion(0);
    assert!((0.14..0.23).contains(&diffusion.mean) && diffusion.error < 0.02, "{diffusion:?}");
}

/// A fluid in a periodic box that moves as a whole five times as fast as its balls do: what is measured is that of the fluid at rest.
#[test]
fn a_fluid_that_moves_as_a_whole_has_the_measures_of_one_at_rest() {
    let mut setup = Setup::<3>::fluid(500, 0.3).measured(1.0, 0.2);
    setup.species[0].velocity = [8.0, -3.0, 1.0];
    let mut gas = setup.build().unwrap();
    advance(&mut gas, 21.0);
    assert!((gas.temperature() - 1.0).abs() < 1e-9, "{}", gas.temperature());
    let (z, diffusion) = (gas.compressibility(), gas.diffusion(0));
    assert!((z.mean - 3.98426).abs() < 3.0 * z.error + 0.03, "{z:?}");
    assert!((0.14..0.23).contains(&diffusion.mean) && diffusion.error < 0.02, "{diffusion:?}");
    assert!(gas.maxwell_p_value() > 1e-4, "{}", gas.maxwell_p_value());
    // How far a ball flies depends on who looks.
    assert!(gas.mean_free_path().mean.is_nan());
    let chart = gas.charts().into_iter().find(|chart| chart.name.starts_with("velocity_histogram")).unwrap();
    let mean = |points: &[[f64; 2]]| {
        let weight: f64 = points.iter().map(|point| point[1]).sum();
        points.iter().map(|point| point[0] * point[1]).sum::<f64>() / weight
    };
    assert!(mean(&chart.series[0].points).abs() < 0.1, "{}", mean(&chart.series[0].points));
}

/// Viscosity and thermal conductivity at packing 0.3 after Enskog, as in the validation case.
const VISCOSITY: f64 = 0.7324;
const CONDUCTIVITY: f64 = 3.0869;

#[test]
fn viscosity_and_conductivity_are_told_where_nothing_else_changes_momentum() {
    let mut setup = Setup::<3>::fluid(200, 0.3).seed(2).measured(2.0, 0.25);
    setup.measure.lag_collisions = 10.0;
    let mut gas = setup.build().unwrap();
    advance(&mut gas, 1202.0);
    let (viscosity, conductivity) = (gas.viscosity(), gas.conductivity());
    assert!((viscosity.mean - VISCOSITY).abs() < 3.0 * viscosity.error, "{viscosity:?}");
    assert!((conductivity.mean - CONDUCTIVITY).abs() < 3.0 * conductivity.error, "{conductivity:?}");
    assert!(viscosity.error < 0.05 * VISCOSITY && conductivity.error < 0.05 * CONDUCTIVITY);
    let mut walled = Setup::<3>::new([6.0; 3]).species(Species::new("balls", Amount::Count(50)));
    walled.seed = 1;
    let mut walled = walled.measured(0.0, 0.1).build().unwrap();
    advance(&mut walled, 20.0);
    assert!(
        walled.viscosity().mean.is_nan()
            && walled.gauge_columns().iter().all(|column| !column.quantity.contains("viscosity"))
    );
}

#[test]
fn charts_gauges_and_path_are_given() {
    let mut setup = Setup::<2>::new([20.0, 20.0]).side(1, 1, Side::Piston { mass: 50.0, pressure: 0.5, velocity: 0.0 });
    scatter(&mut setup, 60, 0.3, 1.0, 1);
    setup.follow = Some(0);
    let mut gas = setup.measured(1.0, 0.5).build().unwrap();
    advance(&mut gas, 20.0);
    let names: Vec<String> = gas.charts().into_iter().map(|chart| chart.name).collect();
    for name in
        ["speed_histogram", "velocity_histogram", "density_profile", "pair_distribution", "mean_square_displacement"]
    {
        assert!(names.iter().any(|chart| chart == name), "{names:?} lack {name}");
    }
    let columns = gas.gauge_columns();
    let row = gas.gauge_row();
    assert_eq!(columns.len(), row.len());
    for quantity in ["temperature", "pressure_virial", "pressure_walls", "mean_free_path", "work", "diffusion"] {
        let at = columns.iter().position(|column| column.quantity == quantity).unwrap();
        assert!(row[at].is_finite(), "{quantity} is {}", row[at]);
    }
    let path = &gas.paths()[0];
    assert!(path.times.len() > 3 && path.times.windows(2).all(|pair| pair[0] <= pair[1]));
    assert_eq!(*path.times.last().unwrap(), 20.0);
    // Straight from bend to bend, at the ball's speed: every density integrates to one.
    let speeds =
        gas.charts().into_iter().find(|chart| chart.name == "speed_histogram").unwrap().series.remove(0).points;
    let width = speeds[1][0] - speeds[0][0];
    assert!((speeds.iter().map(|point| point[1] * width).sum::<f64>() - 1.0).abs() < 1e-9);
    let errors: Vec<f64> = gas.ledger().balances.iter().map(|balance| balance.relative_error().abs()).collect();
    assert!(errors.iter().all(|error| *error < 1e-10), "{errors:?}");
}

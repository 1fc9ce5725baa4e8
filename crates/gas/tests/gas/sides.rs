//! Walls that move, give way, heat, divide.

use crate::common::{advance, deepest, scatter};
use corpuscle_gas::{Method, Partition, Setup, Side};

#[test]
fn a_moving_wall_reflects_at_twice_its_speed_less_the_balls() {
    let wall = Side::Moving { velocity: -0.75, until: None };
    let mut gas = Setup::<2>::new([10.0, 6.0]).side(0, 1, wall).ball([5.0, 2.0], [1.3, 0.5], 0.5, 2.0).build().unwrap();
    advance(&mut gas, 3.0);
    assert_eq!(gas.states()[0].1, [2.0 * -0.75 - 1.3, 0.5]);
    // Met where ball and wall are at one time: 5.5 + 1.3 t = 10 - 0.75 t.
    let met = 4.5 / 2.05;
    let position = 5.0 + 1.3 * met - 2.8 * (3.0 - met);
    assert!((gas.states()[0].0[0] - position).abs() < 1e-12);
    assert!((gas.work() - 0.5 * 2.0 * (2.8_f64.powi(2) - 1.3_f64.powi(2))).abs() < 1e-12);
}

#[test]
fn piston_and_ball_share_energy_and_momentum() {
    let piston = Side::Piston { mass: 5.0, pressure: 0.0, velocity: -0.4 };
    let mut gas =
        Setup::<2>::new([10.0, 4.0]).side(0, 1, piston).ball([5.0, 2.0], [1.0, 0.0], 0.5, 2.0).build().unwrap();
    let motion = |gas: &corpuscle_gas::Gas<2>| (gas.states()[0].1[0], gas.wall(0, 1).unwrap()[1]);
    let (v, w) = motion(&gas);
    advance(&mut gas, 4.0);
    let (v2, w2) = motion(&gas);
    assert!(v2 < 0.0);
    assert!((2.0 * v + 5.0 * w - 2.0 * v2 - 5.0 * w2).abs() < 1e-14);
    assert!((2.0 * v * v + 5.0 * w * w - 2.0 * v2 * v2 - 5.0 * w2 * w2).abs() < 1e-14);
}

#[test]
fn a_piston_finds_its_balance_and_energy_is_kept() {
    let (pressure, mass) = (2.0, 40.0);
    let mut setup = Setup::<2>::new([40.0, 10.0]).side(0, 1, Side::Piston { mass, pressure, velocity: 0.0 });
    scatter(&mut setup, 120, 0.2, 1.5, 2);
    let mut gas = setup.clone().build().unwrap();
    // Of the gas, of the piston, and in the outside pressure.
    let total = |gas: &corpuscle_gas::Gas<2>| {
        let [position, speed] = gas.wall(0, 1).unwrap();
        gas.energy() + 0.5 * mass * speed * speed + pressure * 10.0 * position
    };
    let (start, energy) = (total(&gas), gas.energy());
    for step in 1..=40 {
        advance(&mut gas, f64::from(step));
        assert!((total(&gas) / start - 1.0).abs() < 1e-11);
        assert!((gas.energy() - energy - gas.work()).abs() < 1e-12 * energy);
        assert!(deepest(&setup, &gas, [false; 2]) < 1e-9);
    }
    let moved = (gas.wall(0, 1).unwrap()[0] - 40.0).abs();
    assert!(gas.collisions() > 300 && moved > 0.05, "{} {moved}", gas.collisions());
}

#[test]
fn work_of_moving_walls_is_the_energy_gained() {
    let mut setup = Setup::<2>::new([30.0, 20.0]);
    setup.sides[0][1] = Side::Swinging { amplitude: 4.0, period: 5.0 };
    setup.sides[1][0] = Side::Displaced(vec![[0.0, 0.0], [3.0, 2.0], [7.0, 0.0]]);
    scatter(&mut setup, 80, 0.3, 3.0, 4);
    setup.balls.retain(|ball| ball.position[1] > ball.radius + 2.1);
    let mut gas = setup.build().unwrap();
    let energy = gas.energy();
    advance(&mut gas, 20.0);
    assert!(gas.work().abs() > 1e-3 * energy);
    assert!(((gas.energy() - energy) / gas.work() - 1.0).abs() < 1e-10);
    assert!((gas.wall(0, 1).unwrap()[0] - 30.0).abs() < 1e-9 && (gas.wall(1, 0).unwrap()[0]).abs() < 1e-12);
    assert!(gas.deepest_overlap() < 1e-9);
}

#[test]
fn thermal_walls_bring_the_gas_to_their_temperature() {
    let mut setup = Setup::<2>::new([20.0, 20.0]);
    setup.sides[0] = [Side::Thermal { temperature: 3.0 }, Side::Thermal { temperature: 3.0 }];
    scatter(&mut setup, 200, 0.3, 1.0, 4);
    setup.balls.iter_mut().for_each(|ball| ball.mass = 1.0);
    let mut gas = setup.measured(100.0, 1.0).build().unwrap();
    advance(&mut gas, 100.0);
    let (mut sum, looks) = (0.0, 300);
    for look in 0..looks {
        advance(&mut gas, 100.0 + f64::from(look));
        sum += gas.temperature();
    }
    // Temperature of 200 balls varies by 7 %; of independent looks there are more than a hundred.
    assert!((sum / f64::from(looks) / 3.0 - 1.0).abs() < 0.02, "{}", sum / f64::from(looks));
}

#[test]
fn a_ball_that_falls_bounces_back_to_its_height() {
    let mut gas =
        Setup::<2>::new([4.0, 10.0]).gravity([0.0, -2.0]).ball([2.0, 5.0], [0.0, 0.0], 1.0, 1.0).build().unwrap();
    // Down 4 in 2, up again in 2: a thousand times.
    advance(&mut gas, 4000.0);
    assert!((gas.states()[0].0[1] - 5.0).abs() < 1e-8);
    assert!((gas.energy() - 10.0).abs() < 1e-10);
}

#[test]
fn a_partition_divides_until_it_is_lifted() {
    let mut setup = Setup::<2>::new([20.0, 10.0]);
    setup.partition = Some(Partition { axis: 0, at: 10.0, lifted_at: Some(30.0), hole: None });
    scatter(&mut setup, 60, 0.3, 2.0, 6);
    setup.balls.retain(|ball| ball.position[0] < 10.0 - ball.radius);
    let mut gas = setup.build().unwrap();
    for step in 1..=29 {
        advance(&mut gas, f64::from(step));
        assert!((0..gas.len()).all(|ball| gas.states()[ball].0[0] <= 10.0 - gas.body(ball).0 * (1.0 - 1e-9)));
    }
    let energy = gas.energy();
    advance(&mut gas, 100.0);
    let beyond = gas.states().iter().filter(|state| state.0[0] > 10.0).count();
    assert!(beyond > gas.len() / 4 && beyond < 3 * gas.len() / 4, "{beyond} of {}", gas.len());
    assert!((gas.energy() / energy - 1.0).abs() < 1e-12);
}

#[test]
fn a_hole_lets_through_only_what_comes_before_it() {
    let wall = |axis, hole| Partition { axis, at: 5.0, lifted_at: None, hole: Some(vec![hole]) };
    let mut setup = Setup::<2>::new([10.0, 10.0]);
    setup.partition = Some(wall(0, [4.0, 6.0]));
    let setup = setup.ball([2.0, 5.0], [1.0, 0.0], 0.5, 1.0).ball([2.0, 8.0], [1.0, 0.0], 0.5, 1.0);
    let mut gas = setup.build().unwrap();
    advance(&mut gas, 4.0);
    assert!((gas.states()[0].0[0] - 6.0).abs() < 1e-12, "straight through the hole");
    assert!((gas.states()[1].0[0] - 3.0).abs() < 1e-12, "back from the wall");
    // Thrown up through the hole, drifting: it comes down beside the hole and stays above.
    let mut setup = Setup::<2>::new([10.0, 10.0]).gravity([0.0, -2.0]);
    setup.partition = Some(wall(1, [0.0, 3.0]));
    let mut gas = setup.ball([1.0, 4.0], [1.0, 3.5], 0.3, 1.0).build().unwrap();
    for step in 1..=150 {
        advance(&mut gas, 0.1 * f64::from(step));
        let [x, y] = gas.states()[0].0;
        assert!((y - 5.0).abs() >= 0.3 * (1.0 - 1e-9) || x <= 3.5, "in the wall at {x}, {y}");
    }
}

#[test]
fn a_piston_bent_far_away_comes_to_balls_at_rest() {
    // One ball is thrown back and forth and bends the piston's path; the other lies at the far end until the piston is there.
    let piston = Side::Piston { mass: 1e6, pressure: 0.0, velocity: -1.0 };
    let setup = Setup::<2>::new([60.0, 6.0]).side(0, 1, piston);
    let setup = setup.ball([50.0, 4.5], [3.0, 0.0], 0.5, 1.0).ball([10.0, 1.5], [0.0, 0.0], 0.5, 1.0);
    let mut gas = setup.clone().build().unwrap();
    advance(&mut gas, 49.0);
    assert_eq!(gas.states()[1].1, [0.0, 0.0]);
    let mut list = setup.method(Method::List).build().unwrap();
    for gas in [&mut gas, &mut list] {
        advance(gas, 52.0);
    }
    assert!(gas.states()[1].1[0] < -1.0, "{:?}", gas.states());
    assert_eq!(gas.states(), list.states());
}

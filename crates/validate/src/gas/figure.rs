//! The published example, event by event.

use super::{advance, rows};
use crate::{Case, Options, Row};
use corpuscle_gas::{Gas, Method, Nearest, Setup, With};
use corpuscle_model::ModelError;

pub(super) const FIGURE_11: Case = Case {
    name: "gas/figure-11",
    about: "Figure 11 of Deng, Hu, Li & Zhang (2012): four balls A, B, C, D and a wall E, C at rest. The list of nearest events is \
            theirs after each event, and the event-driven method has the same states to the bit.",
    slow: false,
    reduced: 1.0,
    run: figure_11,
};

fn figure_11(_: &Options) -> Vec<Row> {
    rows(FIGURE_11.name, measure())
}

const A: usize = 0;
const B: usize = 1;
const C: usize = 2;
const D: usize = 3;

/// E is the floor: the lower wall along y, the third of the box.
const E: With = With::Wall(2);

/// B overtakes A on its way down to E; D runs into C, which then hits B from the side.
fn setup(method: Method) -> Setup<2> {
    Setup::new([40.0, 40.0])
        .ball([16.0, 4.5], [0.0, -1.0], 1.0, 1.0)
        .ball([16.0, 10.5], [0.0, -3.0], 1.0, 1.0)
        .ball([10.0, 6.0], [0.0, 0.0], 1.0, 1.0)
        .ball([6.0, 6.0], [4.0, 0.0], 1.0, 1.0)
        .method(method)
}

/// What the list must hold, and how the balls must move.
struct Stage {
    nearest: [(f64, With); 4],
    velocity: [[f64; 2]; 4],
}

/// By hand: D meets C at 1/2, C meets B at 3/2, and B, had it gone on, would have met A at 2. After CB the way to E is free for A and B.
fn stages() -> [Stage; 3] {
    let never = (f64::INFINITY, With::Nothing);
    [
        Stage {
            nearest: [(2.0, With::Ball(B)), (2.0, With::Ball(A)), (0.5, With::Ball(D)), (0.5, With::Ball(C))],
            velocity: [[0.0, -1.0], [0.0, -3.0], [0.0, 0.0], [4.0, 0.0]],
        },
        Stage {
            nearest: [(2.0, With::Ball(B)), (1.5, With::Ball(C)), (1.5, With::Ball(B)), never],
            velocity: [[0.0, -1.0], [0.0, -3.0], [4.0, 0.0], [0.0, 0.0]],
        },
        Stage {
            nearest: [(3.5, E), (1.5 + 5.0 / 3.0, E), never, never],
            velocity: [[0.0, -1.0], [4.0, -3.0], [0.0, 0.0], [0.0, 0.0]],
        },
    ]
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let mut list = setup(Method::List).build()?;
    let mut fast = setup(Method::EventDriven).build()?;
    let (mut wrong, mut late, mut apart) = (0, 0.0_f64, 0);
    // Between the events.
    for (events, (stage, time)) in stages().iter().zip([0.0, 1.0, 1.75]).enumerate() {
        advance(&mut list, time)?;
        advance(&mut fast, time)?;
        let found = list.nearest().unwrap_or_default();
        wrong += usize::from(list.collisions() != events as u64) + differences(&list, &found, stage);
        late = stage
            .nearest
            .iter()
            .zip(&found)
            .filter(|(known, _)| known.0.is_finite())
            .map(|(known, found)| (known.0 - found.time).abs())
            .fold(late, f64::max);
        apart += usize::from(list.states() != fast.states());
    }
    // Without the others A would be at E.
    let mut alone = setup(Method::List);
    alone.balls.truncate(1);
    wrong += usize::from(alone.build()?.nearest() != Some(vec![Nearest { time: 3.5, with: E }]));
    let row = |measure, value, bound| Row::at_most(FIGURE_11.name, measure, value, "", bound);
    Ok(vec![
        row("events_and_velocities_that_differ", wrong as f64, 0.0),
        row("error_of_times", late, 1e-12),
        row("stages_where_methods_differ", apart as f64, 0.0),
    ])
}

/// Balls whose nearest event, or velocity, is not what it must be.
fn differences(gas: &Gas<2>, found: &[Nearest], stage: &Stage) -> usize {
    let events = (0..4).filter(|&ball| found.get(ball).map(|event| event.with) != Some(stage.nearest[ball].1));
    let states = gas.states();
    let apart = |ball: usize, axis: usize| (states[ball].1[axis] - stage.velocity[ball][axis]).abs();
    let moves = (0..4).filter(|&ball| apart(ball, 0).max(apart(ball, 1)) > 1e-12);
    events.count() + moves.count()
}

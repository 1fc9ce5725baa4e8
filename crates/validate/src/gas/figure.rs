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
    run: figure_11,
};

fn figure_11(_: &Options) -> Vec<Row> {
    rows(FIGURE_11.name, measure())
}

const [A, B, C, D]: [usize; 4] = [0, 1, 2, 3];

/// A falls towards E, the box's floor, and is met by B before; D runs into C, which then runs into B.
fn setup(method: Method) -> Setup<2> {
    Setup::new([40.0, 40.0])
        .ball([10.0, 6.0], [1.0, -1.0], 1.0, 1.0)
        .ball([18.0, 3.0], [-1.0, 0.0], 1.0, 1.0)
        .ball([23.0, 3.0], [0.0, 0.0], 1.0, 1.0)
        .ball([27.0, 3.0], [-4.0, 0.0], 1.0, 1.0)
        .method(method)
}

/// What the list must hold, and until when it stays so.
struct Stage {
    nearest: [(f64, With); 4],
    velocity_x: [f64; 4],
}

/// By hand: A and B touch at 3; D and C at 1/2; C and B at 1/2 + 3.5/3; then B, at -4, and A at the first root of
/// (14/3 - 5 s)^2 + (s - 4/3)^2 = 4, s the time since. C would meet A at 4.2. A would be at E at 5, which is never its nearest.
fn stages() -> [Stage; 3] {
    let never = (f64::INFINITY, With::Nothing);
    let second = 0.5 + 3.5 / 3.0;
    let (half, rest) = (14.0 / 3.0 * 5.0 + 4.0 / 3.0, (14.0_f64 / 3.0).powi(2) + (4.0_f64 / 3.0).powi(2) - 4.0);
    let third = second + (half - (half * half - 26.0 * rest).sqrt()) / 26.0;
    [
        Stage {
            nearest: [(3.0, With::Ball(B)), (3.0, With::Ball(A)), (0.5, With::Ball(D)), (0.5, With::Ball(C))],
            velocity_x: [1.0, -1.0, 0.0, -4.0],
        },
        Stage {
            nearest: [(3.0, With::Ball(B)), (second, With::Ball(C)), (second, With::Ball(B)), never],
            velocity_x: [1.0, -1.0, -4.0, 0.0],
        },
        Stage {
            nearest: [(third, With::Ball(B)), (third, With::Ball(A)), (4.2, With::Ball(A)), never],
            velocity_x: [1.0, -4.0, -1.0, 0.0],
        },
    ]
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let mut list = setup(Method::List).build()?;
    let mut fast = setup(Method::EventDriven).build()?;
    let (mut wrong, mut late, mut apart) = (0, 0.0_f64, 0);
    // Between the events.
    for (stage, time) in stages().iter().zip([0.0, 1.0, 2.0]) {
        advance(&mut list, time)?;
        advance(&mut fast, time)?;
        let found = list.nearest().unwrap_or_default();
        wrong += usize::from(list.collisions() != time as u64) + differences(&list, &found, stage);
        late = stage.nearest.iter().zip(&found).filter(|(known, _)| known.0.is_finite())
            .map(|(known, found)| (known.0 - found.time).abs()).fold(late, f64::max);
        apart += usize::from(list.states() != fast.states());
    }
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
    let moves = (0..4).filter(|&ball| (states[ball].1[0] - stage.velocity_x[ball]).abs() > 1e-12);
    events.count() + moves.count()
}

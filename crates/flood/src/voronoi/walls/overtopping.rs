//! Water that flows over the crests of walls.

use crate::hydraulics::over_weir;
use crate::voronoi::patch::Change;
use crate::voronoi::solver::Solver;
use crate::voronoi::water::Column;
use corpuscle_scene::Weir;

/// Most of the volume between the levels on both sides that flows over in a step.
const MOST: f64 = 0.5;

/// Lets water flow over crests for `step` s: Poleni's formula with the coefficient of critical depth on a broad crest, C = (2/3)^(3/2) g^(1/2), and what the
/// water behind it holds back (Villemonte 1947). It takes its velocity along.
pub(crate) fn overtop(solver: &mut Solver, step: f64) {
    let coefficient = (2.0_f64 / 3.0).powf(1.5) * solver.gravity.sqrt();
    for number in 0..solver.crests.len() {
        let (cells, crest) = solver.crests[number];
        let cells = cells.map(|cell| cell as usize);
        let level = |cell: usize| Some(solver.water[cell]).filter(|water| water.depth > 0.0).map(|water| water.level);
        let levels = cells.map(level);
        let [from, to] = if levels[0] >= levels[1] { [0, 1] } else { [1, 0] };
        let Some(upper) = levels[from].filter(|upper| *upper > crest.level) else { continue };
        let weir = Weir { crest_m: crest.level, width_m: crest.length, coefficient };
        let wanted = step * over_weir(&weir, upper, levels[to]);
        let [own, other] = [from, to].map(|side| solver.mesh.area[cells[side]]);
        let behind = levels[to].unwrap_or(f64::NEG_INFINITY);
        let most = if behind > crest.level {
            (upper - behind) * own * other / (own + other)
        } else {
            (upper - crest.level) * own
        };
        let Column { volume: held, momentum } = solver.columns[cells[from]];
        let volume = wanted.min(MOST * most).min(held);
        if volume <= 0.0 {
            continue;
        }
        let share = volume / held;
        let given = Column { volume, momentum: momentum.map(|momentum| share * momentum) };
        let taken = Column { volume: -given.volume, momentum: given.momentum.map(|momentum| -momentum) };
        let mut change = Change::default();
        change.apply(solver, cells[from], taken);
        change.apply(solver, cells[to], given);
    }
}

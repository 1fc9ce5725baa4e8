//! Boundaries as a GPU has them.

use super::super::gpu::{
    Border, DISCHARGE, LEVEL, NONE, NORMAL, OPEN, PADDLE, Part, SharedDischarge, Tables, WALL, WAVE,
};
use super::super::solver::Solver;
use super::Boundary;
use super::open::{Boundaries, faces_of, lowest_of, wets};
use corpuscle_scene::Table;

/// Level of no water beyond, above the bed of the cell, m.
const DRY: f64 = -1e30;

/// The tables of a rule, and the level from which those of a level count, m.
#[derive(Debug, Clone, Copy)]
struct OfRule {
    table: u32,
    velocity_table: u32,
    datum: f64,
}

/// What is uploaded of boundaries.
pub(in crate::voronoi) struct Uploaded {
    /// Each border face.
    pub borders: Vec<Border>,
    /// See `beyond` of the memory.
    pub beyond: Vec<f32>,
    pub discharges: Vec<SharedDischarge>,
    pub parts: Vec<Part>,
}

/// The rows of a table of levels above a datum.
fn above(table: &Table, datum: f64) -> impl Iterator<Item = [f64; 2]> + '_ {
    table.rows().iter().map(move |[time, level]| [*time, level - datum])
}

/// The velocity of a paddle by its displacement: constant between two rows, and 0 before and after.
fn velocity(motion: &Table) -> Vec<[f64; 2]> {
    let rows = motion.rows();
    let mut velocity = vec![[rows[0][0], 0.0]];
    for pair in rows.windows(2).filter(|pair| pair[0][0] < pair[1][0]) {
        let speed = (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]);
        velocity.extend([[pair[0][0], speed], [pair[1][0], speed]]);
    }
    velocity.push([rows[rows.len() - 1][0], 0.0]);
    velocity
}

impl Boundaries {
    /// Packs them for a GPU; `known` is the state of the water beyond each border face (see [`Boundaries::beyond_at_start`]).
    pub fn upload(&self, solver: &Solver, known: &[f64], obstacle_of: &[u32], tables: &mut Tables) -> Uploaded {
        let mut uploaded =
            Uploaded { borders: Vec::new(), beyond: Vec::new(), discharges: Vec::new(), parts: Vec::new() };
        let rules: Vec<OfRule> = (0..self.rules.len())
            .map(|rule| {
                let of_rule = self.tables_of(solver, rule as u16, tables);
                self.share_out(solver, rule as u16, of_rule, &mut uploaded);
                of_rule
            })
            .collect();
        for (border, obstacle) in obstacle_of.iter().enumerate() {
            let of_rule = self.rule_of(border).map(|rule| rules[usize::from(rule)]);
            let (kind, beyond) = self.border(solver, border, known[border], of_rule);
            uploaded.borders.push(Border { obstacle: *obstacle, ..kind });
            uploaded.beyond.push(beyond as f32);
        }
        uploaded
    }

    fn tables_of(&self, solver: &Solver, rule: u16, tables: &mut Tables) -> OfRule {
        let mut found = OfRule { table: NONE, velocity_table: NONE, datum: 0.0 };
        match &self.rules[usize::from(rule)] {
            Boundary::Level(level) => {
                found.datum = level.rows()[0][1];
                found.table = tables.add(above(level, found.datum));
            }
            Boundary::Wave { level, velocity, rest } => {
                found.datum = *rest;
                found.table = level.as_ref().map_or(NONE, |level| tables.add(above(level, found.datum)));
                found.velocity_table =
                    velocity.as_ref().map_or(NONE, |velocity| tables.add(velocity.rows().iter().copied()));
            }
            Boundary::Paddle(motion) => found.table = tables.add(velocity(motion)),
            Boundary::Discharge(discharge) => found.table = tables.add(discharge.rows().iter().copied()),
            Boundary::Rating(rating) => {
                // Water may not have come to any face yet.
                let (lowest, length) = lowest_of(&self.of_faces, solver, rule);
                let datum = if length > 0.0 { lowest } else { 0.0 };
                found.table = tables.add(rating.rows().iter().map(|[level, value]| [level - datum, *value]));
            }
            Boundary::Wall | Boundary::Periodic | Boundary::Open | Boundary::NormalDepth(_) => {}
        }
        found
    }

    /// Adds a discharge that is shared out, and the parts of its border faces.
    fn share_out(&self, solver: &Solver, rule: u16, of_rule: OfRule, uploaded: &mut Uploaded) {
        let is_rating = match &self.rules[usize::from(rule)] {
            Boundary::Discharge(_) => 0,
            Boundary::Rating(_) => 1,
            _ => return,
        };
        let (lowest, length) = lowest_of(&self.of_faces, solver, rule);
        let first = uploaded.parts.len() as u32;
        let part = |(border, cell, of_face): (usize, usize, f64)| {
            let bed = solver.mesh.bed[cell];
            let when_dry = if wets(bed, lowest) { 1.0 / length } else { 0.0 };
            Part {
                border: border as u32,
                cell: cell as u32,
                length: of_face as f32,
                bed: (bed - lowest) as f32,
                when_dry: when_dry as f32,
            }
        };
        uploaded.parts.extend(faces_of(&self.of_faces, solver, rule).map(part));
        let end = uploaded.parts.len() as u32;
        uploaded.discharges.push(SharedDischarge { table: of_rule.table, is_rating, first, end });
    }

    /// A border face, and what is known of the water beyond as the device has it.
    fn border(&self, solver: &Solver, border: usize, known: f64, of_rule: Option<OfRule>) -> (Border, f64) {
        let face = &solver.mesh.faces[solver.borders[border] as usize];
        let cell = face.cells[0] as usize;
        let bed = solver.mesh.bed[cell];
        let axis = usize::from(face.normal[1].abs() > face.normal[0].abs());
        let wall = Border {
            kind: WALL,
            face: solver.borders[border],
            obstacle: NONE,
            table: NONE,
            velocity_table: NONE,
            datum: 0.0,
            ground: (self.ground[border] - bed) as f32,
            rest: 0.0,
            factor: 0.0,
            span: solver.mesh.layout.bounds.size()[axis] as f32,
        };
        let (Some(OfRule { table, velocity_table, datum }), Some(rule)) = (of_rule, self.rule_of(border)) else {
            return (wall, 0.0);
        };
        let own = Border { table, velocity_table, datum: (datum - bed) as f32, ..wall };
        let open = |level: f64| (Border { kind: OPEN, ..own }, level.max(DRY));
        match &self.rules[usize::from(rule)] {
            Boundary::Wall | Boundary::Periodic => (wall, 0.0),
            Boundary::Open => open(known - bed),
            Boundary::NormalDepth(root) => match solver.slowing.conveyance(cell, solver.gravity) {
                Some(conveyance) => (Border { kind: NORMAL, factor: (root * conveyance) as f32, ..own }, 0.0),
                None => open(DRY),
            },
            Boundary::Level(_) => (Border { kind: LEVEL, ..own }, known),
            Boundary::Wave { rest, .. } => (Border { kind: WAVE, rest: (rest - bed) as f32, ..own }, 0.0),
            Boundary::Discharge(_) | Boundary::Rating(_) => (Border { kind: DISCHARGE, ..own }, 0.0),
            Boundary::Paddle(_) => (Border { kind: PADDLE, ..own }, 0.0),
        }
    }

    /// Sets the state of the water beyond prescribed levels from a GPU's.
    pub fn set_beyond(&self, beyond: &[f32], known: &mut [f64]) {
        for (border, (known, beyond)) in known.iter_mut().zip(beyond).enumerate() {
            let rule = self.rule_of(border).map(|rule| &self.rules[usize::from(rule)]);
            if let Some(Boundary::Level(_)) = rule {
                *known = f64::from(*beyond);
            }
        }
    }

    /// Whether a discharge is shared out over border faces.
    pub fn shares_discharges(&self) -> bool {
        self.rules.iter().any(|rule| matches!(rule, Boundary::Discharge(_) | Boundary::Rating(_)))
    }

    /// Whether the water beyond some border face has a level that is held.
    pub fn holds_levels(&self) -> bool {
        self.rules.iter().any(|rule| matches!(rule, Boundary::Level(_)))
    }
}

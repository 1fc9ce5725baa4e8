//! Boundaries from a scene, and what they do at each face from step to step.

use super::super::domain::{total, total_of};
use super::super::mesh::{LINE, SOLID};
use super::super::reconstruction::AtFace;
use super::super::solver::Solver;
use super::{Boundary, Now, state};
use crate::error::setup;
use crate::series::load;
use corpuscle_model::{ExactSum, ModelError};
use corpuscle_scene::{Edge, Flood, Side, Table};
use corpuscle_terrain::{Bounds, Terrain};
use std::path::Path;

/// How long a held level takes to be met exactly, in crossings of the terrain by waves: shorter waves leave.
pub(crate) const CROSSINGS: f64 = 10.0;

/// The same where the level changes fast: so that sloshing, which takes four crossings, still goes out.
pub(crate) const FEWEST_CROSSINGS: f64 = 0.25;

/// How far the level may be from one that changes, over the depth: where it would be farther, waves are let out less.
pub(crate) const LAG: f64 = 0.005;

/// A part of a side with a rule of its own.
#[derive(Debug, Clone)]
struct Part {
    side: usize,
    /// Along the side, m.
    from: f64,
    to: f64,
}

/// What the sides of the terrain do, and parts of them.
#[derive(Debug)]
pub(crate) struct Boundaries {
    /// West, east, south, north, then the parts, then the lines inside.
    pub rules: Vec<Boundary>,
    parts: Vec<Part>,
    /// The rule of each border face of the solver; none at solids.
    pub(super) of_faces: Vec<Option<u16>>,
    /// Height of the ground in the middle of each border face, m.
    pub(super) ground: Vec<f64>,
    /// What each border face does in the two stages of the step.
    now: [Vec<Now>; 2],
}

/// The coordinate along a side of the terrain, in its own coordinates, to a thousandth.
fn own_along(terrain: &Terrain, side: usize, along: f64) -> f64 {
    let [x, y] = terrain.bounds().centre();
    let own = terrain.to_own(if side < 2 { [x, along] } else { [along, y] });
    (1000.0 * own[usize::from(side < 2)]).round() / 1000.0
}

/// Refuses parts of a side that overlap: which boundary condition holds there would not be clear.
fn check_overlaps(parts: &[Part]) -> Result<(), ModelError> {
    for (number, part) in parts.iter().enumerate() {
        let overlaps = |other: &Part| other.side == part.side && other.from < part.to && part.from < other.to;
        if let Some(other) = parts[..number].iter().position(overlaps) {
            return Err(setup(format!(
                "flood.edge_part.{number} overlaps flood.edge_part.{other} on the same side; let one end where the other begins"
            )));
        }
    }
    Ok(())
}

impl Boundaries {
    pub fn open(scene: &Flood, terrain: &Terrain, folder: &Path) -> Result<Self, ModelError> {
        let edges = &scene.edges;
        let sides = [&edges.west, &edges.east, &edges.south, &edges.north];
        let of_parts = scene.edge_part.iter().map(|part| &part.edge);
        let of_lines = scene.edge_line.iter().map(|line| &line.edge);
        let rules = sides
            .into_iter()
            .chain(of_parts)
            .chain(of_lines)
            .map(|edge| boundary(edge, terrain, folder))
            .collect::<Result<_, _>>()?;
        let part = |(number, part): (usize, &corpuscle_scene::EdgePart)| {
            let side = match part.side {
                Side::West => 0,
                Side::East => 1,
                Side::South => 2,
                Side::North => 3,
            };
            let bounds = terrain.bounds();
            let [x, y] = terrain.to_own(bounds.centre());
            let along = |value: f64| {
                let own = if side < 2 { [x, value] } else { [value, y] };
                terrain.to_model(own)[usize::from(side < 2)]
            };
            let (from, to) = (along(part.from), along(part.to));
            let [low, high] = if side < 2 { [bounds.y_min, bounds.y_max] } else { [bounds.x_min, bounds.x_max] };
            if to <= low || from >= high {
                return Err(setup(format!(
                    "flood.edge_part.{number} from {} to {} lies outside its side, which goes from {} to {} in the terrain's coordinates",
                    part.from,
                    part.to,
                    own_along(terrain, side, low),
                    own_along(terrain, side, high),
                )));
            }
            Ok(Part { side, from, to })
        };
        let parts = scene.edge_part.iter().enumerate().map(part).collect::<Result<Vec<Part>, _>>()?;
        check_overlaps(&parts)?;
        Ok(Self { rules, parts, of_faces: Vec::new(), ground: Vec::new(), now: [Vec::new(), Vec::new()] })
    }

    /// Whether the west and east, and the south and north sides are joined.
    pub fn periodic(&self) -> [bool; 2] {
        [0, 2].map(|side| matches!(self.rules[side], Boundary::Periodic))
    }

    /// Whether water at each side, all along it, is mirrored.
    pub fn mirrors(&self) -> [bool; 4] {
        [0, 1, 2, 3].map(|side| {
            let parts = self.parts.iter().zip(&self.rules[4..]).filter(|(part, _)| part.side == side);
            self.rules[side].mirrors() && parts.clone().all(|(_, rule)| rule.mirrors())
        })
    }

    /// Whether water may come in over each side, over solids, and over lines inside.
    pub fn brings(&self) -> [bool; 6] {
        let lines = &self.rules[4 + self.parts.len()..];
        [0, 1, 2, 3, 4, 5].map(|side| {
            if side == usize::from(LINE) {
                return lines.iter().any(Boundary::brings);
            }
            let parts = self.parts.iter().zip(&self.rules[4..]).filter(|(part, _)| part.side == side);
            self.rules.get(side).is_some_and(|rule| side < 4 && rule.brings())
                || parts.clone().any(|(_, rule)| rule.brings())
        })
    }

    /// Whether water may come in by a rule: those of the four sides, then of their parts.
    pub fn brings_by(&self, rule: usize) -> bool {
        self.rules[rule].brings()
    }

    /// Whether each side has parts with rules of their own.
    pub fn divided(&self) -> [bool; 4] {
        [0, 1, 2, 3].map(|side| self.parts.iter().any(|part| part.side == side))
    }

    /// Whether each rule of the sides and their parts holds at a face of this process.
    pub fn have_faces(&self) -> Vec<bool> {
        let mut found = vec![false; 4 + self.parts.len()];
        for rule in self.of_faces.iter().flatten() {
            if let Some(found) = found.get_mut(usize::from(*rule)) {
                *found = true;
            }
        }
        found
    }

    /// Whether water may come in somewhere.
    pub fn bring(&self) -> bool {
        self.rules.iter().any(Boundary::brings)
    }

    /// Finds the rules of border faces that were added.
    pub fn extend(&mut self, solver: &Solver, terrain: &Terrain) {
        let mesh = &solver.mesh;
        for &border in &solver.borders[self.of_faces.len()..] {
            let face = &mesh.faces[border as usize];
            let cell = mesh.centroid[face.cells[0] as usize];
            let away = |axis: usize| 0.5 * f64::from(face.between[axis]) + f64::from(face.offset[axis]);
            let mut middle = [0, 1].map(|axis| cell[axis] + away(axis));
            if let Some(side) = face.border().filter(|side| *side < SOLID) {
                let Bounds { x_min, x_max, y_min, y_max } = terrain.bounds();
                middle[usize::from(side >= 2)] = [x_min, x_max, y_min, y_max][usize::from(side)];
            }
            self.ground.push(terrain.height(middle[0], middle[1]));
            let rule = face.border().filter(|side| *side != SOLID).map(|side| {
                if side == LINE {
                    let of_line = mesh.line_faces.binary_search_by_key(&border, |(face, _)| *face);
                    let line = of_line.map_or(0, |index| mesh.line_faces[index].1);
                    return (4 + self.parts.len()) as u16 + line as u16;
                }
                let side = usize::from(side);
                let along = middle[usize::from(side < 2)];
                let here = |part: &Part| part.side == side && (part.from..part.to).contains(&along);
                self.parts.iter().position(here).map_or(side as u16, |part| part as u16 + 4)
            });
            self.of_faces.push(rule);
        }
        self.now.iter_mut().for_each(|now| now.resize(self.of_faces.len(), Now::Wall));
    }

    /// Clears what is known of the border faces.
    pub fn forget_faces(&mut self) {
        self.of_faces.clear();
        self.ground.clear();
        self.now.iter_mut().for_each(Vec::clear);
    }

    /// The rule of a border face, by its number; none at solids.
    pub fn rule_of(&self, border: usize) -> Option<u16> {
        self.of_faces[border]
    }

    /// Whether a border face is on an open side.
    pub fn is_open(&self, border: usize) -> bool {
        self.of_faces[border].is_some_and(|rule| matches!(self.rules[usize::from(rule)], Boundary::Open))
    }

    /// What a border face does in a stage of the step.
    #[inline]
    pub fn now(&self, stage: usize, border: usize) -> Now {
        self.now[stage][border]
    }

    /// What is known of the water beyond each border face at the start: at open sides its level, m, that of the water before it (minus infinity where it is
    /// dry); at held ones its velocity outwards, m/s.
    pub fn beyond_at_start(&self, solver: &Solver, border: usize) -> f64 {
        let Some(Boundary::Open) = self.of_faces[border].map(|rule| &self.rules[usize::from(rule)]) else { return 0.0 };
        let water = &solver.water[solver.mesh.faces[solver.borders[border] as usize].cells[0] as usize];
        if water.depth > 0.0 { water.level } else { f64::NEG_INFINITY }
    }

    /// Finds the boundary condition of each border face in a step of `step` s from `time` on; `beyond` is the state of the water there (see
    /// [`Boundaries::beyond_at_start`]).
    pub fn prepare(&mut self, solver: &Solver, time: f64, step: f64, beyond: &[f64]) {
        for number in 0..self.rules.len() {
            let shared = match &self.rules[number] {
                Boundary::Discharge(table) => Some(table.integral(time, time + step) / step),
                Boundary::Rating(rating) => {
                    let level = self.level_of_depth(solver, number as u16);
                    Some(if level.is_finite() { -rating.at(level).max(0.0) } else { 0.0 })
                }
                _ => None,
            };
            if let Some(discharge) = shared {
                self.share(solver, number as u16, discharge);
            }
        }
        for (border, rule) in self.of_faces.iter().enumerate() {
            let Some(rule) = rule.map(|rule| &self.rules[usize::from(rule)]) else { continue };
            for (stage, at) in [time, time + step].into_iter().enumerate() {
                let now = match rule {
                    Boundary::Wall | Boundary::Periodic => Now::Wall,
                    Boundary::Open => Now::Open(beyond[border]),
                    Boundary::Level(level) => Now::Beyond(level.at(at), beyond[border], self.ground[border]),
                    Boundary::Wave { level, velocity, rest } => {
                        let water = &solver.water[solver.mesh.faces[solver.borders[border] as usize].cells[0] as usize];
                        let level = level.as_ref().map(|level| level.at(at));
                        let velocity = velocity.as_ref().map(|velocity| velocity.at(at));
                        wave(level, velocity, *rest, [water.level - water.depth, self.ground[border]], solver.gravity)
                    }
                    Boundary::NormalDepth(root) => {
                        let cell = solver.mesh.faces[solver.borders[border] as usize].cells[0] as usize;
                        solver
                            .slowing
                            .conveyance(cell, solver.gravity)
                            .map_or(Now::Open(f64::NEG_INFINITY), |conveyance| Now::Normal(root * conveyance))
                    }
                    // The mean velocity over the step, so that all of the displacement counts.
                    Boundary::Paddle(motion) => Now::Moving((motion.at(time + step) - motion.at(time)) / step),
                    Boundary::Discharge(_) | Boundary::Rating(_) => continue,
                };
                self.now[stage][border] = now;
            }
        }
    }

    /// Level of the water along the faces of a rule, m; films count as little as they are deep.
    fn level_of_depth(&self, solver: &Solver, rule: u16) -> f64 {
        let weighted = own_faces_of(&self.of_faces, solver, rule).map(|(_, cell, length)| {
            let water = &solver.water[cell];
            [length * water.depth, length * water.depth * water.level]
        });
        let [weight, sum] = sums(solver, weighted);
        if weight > 0.0 { sum / weight } else { f64::NEG_INFINITY }
    }

    /// Shares a discharge inwards, m3/s, out over the faces of a rule by conveyance: length times depth to 5/3. The depths of what comes in are those below one
    /// level: by its own depth a face that has more water than others would get more of it, and a jet would stay one. Where all are dry it comes in at the
    /// lowest ones.
    fn share(&mut self, solver: &Solver, rule: u16, discharge: f64) {
        let level = self.level_of_depth(solver, rule);
        let depth = |cell: usize| match solver.water[cell].depth {
            depth if discharge < 0.0 => depth,
            _ => solver.mesh.depth_below(cell, level),
        };
        let conveyance = |cell: usize| depth(cell).powf(5.0 / 3.0);
        let Self { of_faces, now, .. } = self;
        let faces = || faces_of(of_faces, solver, rule);
        let own = own_faces_of(of_faces, solver, rule).map(|(_, cell, length)| length * conveyance(cell));
        let total = total_of(solver.domain.as_ref(), own.collect());
        let (lowest, lowest_length) = lowest_of(of_faces, solver, rule);
        for (border, cell, _) in faces() {
            let dry = if wets(solver.mesh.bed[cell], lowest) { 1.0 / lowest_length } else { 0.0 };
            let share = if total > 0.0 { conveyance(cell) / total } else { dry };
            now.iter_mut().for_each(|now| now[border] = Now::Discharge(discharge * share));
        }
    }

    /// The velocity of the water beyond held levels after a step: a level that rises sends a wave in, as fast as a wave into still water is; over many crossings of the
    /// terrain it comes to move as the water inside, so that the level is met exactly. With a the height of the waves that come in, b of those that leave, and T
    /// the level, linear theory gives (T - a)' = (b - (T - a)) / (2 t), with t the time that this takes: in a basin without another way out
    /// b = T/2, and a + b is off by t T'. So t is short where T changes fast, as in a tide.
    pub fn follow(&self, solver: &Solver, time: f64, step: f64, beyond: &mut [f64]) {
        let size = solver.mesh.layout.bounds.size();
        for (border, rule) in self.of_faces.iter().enumerate() {
            let Some(Boundary::Level(level)) = rule.map(|rule| &self.rules[usize::from(rule)]) else { continue };
            let face = &solver.mesh.faces[solver.borders[border] as usize];
            let water = &solver.water[face.cells[0] as usize];
            let bed = water.level - water.depth;
            let [was, is] = [time, time + step].map(|at| (solver.gravity * (level.at(at) - bed).max(0.0)).sqrt());
            if was == 0.0 || is == 0.0 || water.depth <= 0.0 {
                beyond[border] = 0.0;
                continue;
            }
            beyond[border] -= 2.0 * (is - was);
            let length = face.normal[0].hypot(face.normal[1]);
            let across = (water.velocity[0] * face.normal[0] + water.velocity[1] * face.normal[1]) / length;
            let at = AtFace { depth: water.depth, level: water.level, across, along: 0.0 };
            let beyond_now = Now::Beyond(level.at(time + step), beyond[border], self.ground[border]);
            let found = state(beyond_now, &at, solver.gravity);
            let axis = usize::from(face.normal[1].abs() > face.normal[0].abs());
            let change = (level.at(time + step) - level.at(time)).abs() / step;
            let crossing = size[axis] / is;
            let relaxation = (LAG * water.depth / change).clamp(FEWEST_CROSSINGS * crossing, CROSSINGS * crossing);
            beyond[border] += (step / relaxation).min(1.0) * (found.across - beyond[border]);
        }
    }
}

/// The lowest bed before the border faces of a rule, m, and the length of those before which it lies, m.
pub(super) fn lowest_of(of_faces: &[Option<u16>], solver: &Solver, rule: u16) -> (f64, f64) {
    let faces = || own_faces_of(of_faces, solver, rule).map(|(_, cell, length)| (solver.mesh.bed[cell], length));
    let lowest = faces().map(|(bed, _)| bed).fold(f64::INFINITY, f64::min);
    let lowest = solver.domain.as_ref().map_or(lowest, |domain| domain.processes.least(lowest));
    let lengths = faces().filter(|(bed, _)| wets(*bed, lowest)).map(|(_, length)| length).collect();
    (lowest, total_of(solver.domain.as_ref(), lengths))
}

/// Sums of pairs over all processes.
fn sums(solver: &Solver, pairs: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    let [mut first, mut second] = [ExactSum::default(); 2];
    for pair in pairs {
        first.add(pair[0]);
        second.add(pair[1]);
    }
    total(solver.domain.as_ref(), &mut [], &mut [&mut first, &mut second]);
    [first.value(), second.value()]
}

/// Whether a bed lies as low as the lowest: there water comes in where all is dry.
pub(super) fn wets(bed: f64, lowest: f64) -> bool {
    bed <= lowest + 1e-6 * (1.0 + lowest.abs())
}

/// The border faces of a rule: their number among all border faces, cell, length, m. `of_faces` is the rule of each.
pub(super) fn faces_of<'a>(
    of_faces: &'a [Option<u16>],
    solver: &'a Solver,
    rule: u16,
) -> impl Iterator<Item = (usize, usize, f64)> + 'a {
    let here = of_faces.iter().enumerate().filter(move |(_, of_face)| **of_face == Some(rule));
    here.map(|(border, _)| {
        let face = &solver.mesh.faces[solver.borders[border] as usize];
        (border, face.cells[0] as usize, face.normal[0].hypot(face.normal[1]))
    })
}

/// Those of them whose cells are computed by this process.
fn own_faces_of<'a>(
    of_faces: &'a [Option<u16>],
    solver: &'a Solver,
    rule: u16,
) -> impl Iterator<Item = (usize, usize, f64)> + 'a {
    faces_of(of_faces, solver, rule).filter(|(_, cell, _)| solver.owns(*cell))
}

/// The water of an incoming simple wave over the bed of a cell, and the ground under its face: what is not given of level and velocity inwards follows from u = 2 (c - c0).
fn wave(level: Option<f64>, velocity: Option<f64>, rest: f64, [bed, ground]: [f64; 2], gravity: f64) -> Now {
    let celerity = |level: f64| (gravity * (level - bed).max(0.0)).sqrt();
    let at_rest = celerity(rest);
    let level = level.unwrap_or_else(|| {
        let celerity = (at_rest + 0.5 * velocity.unwrap_or(0.0)).max(0.0);
        bed + celerity * celerity / gravity
    });
    let velocity = velocity.unwrap_or_else(|| 2.0 * (celerity(level) - at_rest));
    Now::Beyond(level, -velocity, ground)
}

/// Refuses a paddle that moves farther than the terrain is long: it would leave it, and its discharge is that of a wall at the side.
fn check_travel(motion: &Table, terrain: &Terrain) -> Result<(), ModelError> {
    let positions = || motion.rows().iter().map(|row| row[1]);
    let travel = positions().fold(f64::NEG_INFINITY, f64::max) - positions().fold(f64::INFINITY, f64::min);
    let Bounds { x_min, x_max, y_min, y_max } = terrain.bounds();
    let length = (x_max - x_min).max(y_max - y_min);
    if travel < length {
        return Ok(());
    }
    Err(setup(format!(
        "a paddle of [flood.edges] moves {travel} m to and fro, and the terrain is {length} m long: its positions are in metres, small \
         compared with the waves"
    )))
}

fn boundary(edge: &Edge, terrain: &Terrain, folder: &Path) -> Result<Boundary, ModelError> {
    let table = |rows: &Vec<[f64; 2]>| load(&corpuscle_scene::Series::Table(rows.clone()), folder);
    Ok(match edge {
        Edge::Open => Boundary::Open,
        Edge::Wall => Boundary::Wall,
        Edge::Periodic => Boundary::Periodic,
        Edge::Stage(level) => Boundary::Level(load(level, folder)?),
        Edge::Discharge(discharge) => {
            let discharge = load(discharge, folder)?;
            if let Some(row) = discharge.rows().iter().find(|row| row[1] < 0.0) {
                return Err(setup(format!(
                    "a discharge of [flood.edges] is {} m3/s at {} s: it must not be negative; for water that leaves give a rating",
                    row[1], row[0]
                )));
            }
            Boundary::Discharge(discharge)
        }
        Edge::Wave(wave) => Boundary::Wave {
            level: wave.level_m.as_ref().map(|level| load(level, folder)).transpose()?,
            velocity: wave.velocity_m_per_s.as_ref().map(|velocity| load(velocity, folder)).transpose()?,
            rest: wave.rest_level_m,
        },
        Edge::Paddle(motion) => {
            let motion = load(motion, folder)?;
            if let Some(pair) =
                motion.rows().windows(2).find(|pair| pair[0][0] == pair[1][0] && pair[0][1] != pair[1][1])
            {
                return Err(setup(format!(
                    "a paddle of [flood.edges] jumps from {} m to {} m at {} s: a wall cannot; give it time to move",
                    pair[0][1], pair[1][1], pair[0][0]
                )));
            }
            check_travel(&motion, terrain)?;
            Boundary::Paddle(motion)
        }
        Edge::NormalDepth(slope) => Boundary::NormalDepth(slope.sqrt()),
        Edge::Rating(rows) => Boundary::Rating(table(rows)?),
    })
}

//! The air in a slice through the middle of the box, coloured by its speed.

use crate::picture::{Balls, Colour, Disc, Figure, Key, Side, of_part};
use corpuscle_model::{Frame, Model, ParticleSet};
use corpuscle_scene::dew::Face;
use corpuscle_scene::{Axis, Dew};

/// Colour of solids.
const SOLID: Colour = [0x6b, 0x78, 0x85];

/// Fraction of the air that may be faster than the last colour, so that few particles do not darken the others.
const FASTEST_PART: f64 = 0.005;

/// Fewest particles in a slice that is drawn.
const FEWEST: usize = 300;

/// The slice across the shortest side of the box; none where particle files show no air, or little of it, or it is at rest.
///
/// # Errors
/// What cannot be encoded.
pub(super) fn slice(dew: &Dew, model: &dyn Model) -> Result<Option<Figure>, String> {
    let frame = model.frame();
    let Some(air) = set(&frame, "air") else { return Ok(None) };
    let across = (0..3).min_by(|&a, &b| dew.size_m[a].total_cmp(&dew.size_m[b])).unwrap_or(1);
    let [right, up] = [[1, 2], [0, 2], [0, 1]][across];
    let middle = |set: &ParticleSet, at: &usize| {
        (set.position[*at][across] - 0.5 * dew.size_m[across]).abs() <= 0.5 * dew.spacing_m
    };
    let speed = |at: usize| air.velocity[at].iter().map(|along| along * along).sum::<f64>().sqrt();
    let mut speeds: Vec<f64> = (0..air.len()).map(speed).collect();
    speeds.sort_by(f64::total_cmp);
    let Some(&most) = speeds.get(((1.0 - FASTEST_PART) * speeds.len() as f64) as usize) else { return Ok(None) };
    let sliced: Vec<usize> = (0..air.len()).filter(|at| middle(air, at)).collect();
    if most == 0.0 || sliced.len() < FEWEST {
        return Ok(None);
    }
    let disc = |set: &ParticleSet, at: usize, colour: Colour| {
        let [x, y] = [set.position[at][right], set.position[at][up]];
        Disc { position: [x, y, 0.0], radius: 0.5 * dew.spacing_m, colour }
    };
    let coloured = |at: usize| disc(air, at, of_part((speed(at) / most).min(1.0)));
    let solids = set(&frame, "solid");
    let solid = solids
        .iter()
        .flat_map(|set| (0..set.len()).filter(|at| middle(set, at)).map(|at| disc(set, at, SOLID)).collect::<Vec<_>>());
    let discs = solid.chain(sliced.into_iter().map(coloured)).collect();
    let [from, to] = [[0.0; 3], [dew.size_m[right], dew.size_m[up], 0.0]];
    let sides = [right, up, across].map(|axis| dew.faces.along(Axis::ALL[axis]).map(side));
    let balls = Balls {
        dimensions: 2,
        from,
        to,
        view: [from, to],
        sides,
        partition: None,
        discs,
        trajectory: Vec::new(),
        followed: None,
        key: Key::Speed { most, unit: "m/s" },
        unit: "m",
    };
    balls.figure(None).map(Some)
}

fn set<'a>(frame: &'a Frame, name: &str) -> Option<&'a ParticleSet> {
    frame.sets.iter().find(|set| set.name == name)
}

fn side(face: &Face) -> Side {
    match face {
        Face::Wall => Side::Wall,
        Face::Periodic => Side::Open,
        Face::Open | Face::Outflow | Face::Inflow(_) => Side::Passage,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_faces_without_a_wall_are_passages() {
        assert_eq!(
            [Face::Wall, Face::Periodic, Face::Outflow].map(|face| side(&face)),
            [Side::Wall, Side::Open, Side::Passage]
        );
    }
}

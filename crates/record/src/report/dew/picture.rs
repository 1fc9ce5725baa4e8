//! The drops as seen from the side to which most of them face, to scale.

use crate::picture::{Balls, Colour, Disc, Key, Side, number};
use corpuscle_model::{Model, Values};
use corpuscle_scene::{Axis, Dew, dew::Face};

const WATER: Colour = [0x2f, 0x7e, 0xb8];

/// The picture; none without drops.
pub(super) fn drops(dew: &Dew, model: &dyn Model) -> Option<Balls> {
    let frame = model.frame();
    let set = frame.sets.iter().find(|set| set.name == "drops" && !set.is_empty())?;
    let normals = set.columns.iter().find_map(|column| match &column.values {
        Values::Vector(normals) if column.name == "normal" => Some(normals),
        _ => None,
    })?;
    let facing = |axis: usize| normals.iter().zip(&set.mass).map(|(n, mass)| mass * n[axis].abs()).sum::<f64>();
    let along = (0..3).max_by(|&a, &b| facing(a).total_cmp(&facing(b)))?;
    let [right, up] = [[1, 2], [0, 2], [0, 1]][along];
    let flat = |place: [f64; 3]| [place[right], place[up], 0.0];
    let corners = [[0.0; 3], flat(dew.size_m)];
    let disc = |at: usize| Disc { position: flat(set.position[at]), radius: set.radius[at], colour: WATER };
    let side = |face: &Face| if *face == Face::Wall { Side::Wall } else { Side::Open };
    let sides = [right, up].map(|axis| dew.faces.along(Axis::ALL[axis]).map(side));
    Some(Balls {
        dimensions: 2,
        from: corners[0],
        to: corners[1],
        view: corners,
        sides: [sides[0], sides[1], [Side::Open; 2]],
        partition: None,
        discs: (0..set.len()).map(disc).collect(),
        way: Vec::new(),
        followed: None,
        key: Key::Kinds(vec![(format!("drops: {}", number(set.len() as f64).replace(".0", "")), WATER)]),
        unit: "m",
    })
}

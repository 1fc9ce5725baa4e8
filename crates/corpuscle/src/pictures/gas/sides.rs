//! The sides of the box of a gas, and the wall across it.

use super::{INK, REGION, View, tubes};
use crate::pictures::DrawContext;
use corpuscle_model::SolidShape;
use corpuscle_render::{Border, Drawable, LineStyle, Solid, SolidStyle, Tubes, box_edges};
use corpuscle_scene::{Axis, Gas, NamedRegion, Partition, Wall, padded};
use std::sync::Arc;

/// Width of edges, pixels of a picture 1080 pixels high.
const EDGE: f64 = 2.0;
/// Colour of thermal walls, and light that plates transmit.
const THERMAL_WALL: [u8; 3] = [0xd5, 0x5e, 0x00];
const PLATE: [u8; 3] = [214, 223, 234];
/// Thickness of a plate, fraction of the stage.
const THICK: f64 = 0.012;

fn moves(wall: &Wall) -> bool {
    matches!(wall, Wall::Moving { .. } | Wall::Motion(_) | Wall::Piston { .. })
}

/// The partition, while it stands.
fn standing(gas: &Gas, time: f64) -> Option<&Partition> {
    gas.partition.as_ref().filter(|partition| partition.lifted_at_s.is_none_or(|lifted| time < lifted))
}

/// Sides and partition of a flat box. Where one side moves the others are as long as its range.
pub(super) fn borders(gas: &Gas, view: &View, time: f64) -> Vec<Border> {
    let mut borders = Vec::new();
    let stage = [<[f64; 3]>::from(view.stage.from), view.stage.to.into()];
    let container = [view.container.from, view.container.to];
    for axis in [Axis::X, Axis::Y] {
        let (across, along) = (axis.index(), 1 - axis.index());
        for (end, wall) in gas.walls.along(axis).into_iter().enumerate() {
            let span = if moves(wall) { container } else { stage };
            let position = |at: f64| if across == 0 { [container[end][0], at] } else { [at, container[end][1]] };
            let ends = [position(span[0][along]), position(span[1][along])];
            let mut outwards = [0.0; 2];
            outwards[across] = if end == 0 { -1.0 } else { 1.0 };
            let line = |style| Border::Line { style, ends, outwards };
            borders.push(match wall {
                Wall::Fixed => line(LineStyle::Wall),
                Wall::Periodic => line(LineStyle::Periodic),
                Wall::Thermal { .. } => line(LineStyle::ThermalWall),
                Wall::Moving { .. } | Wall::Motion(_) | Wall::Piston { .. } => {
                    Border::Piston { ends, outwards, rod: (stage[end][across] - container[end][across]).abs() }
                }
            });
        }
    }
    if let Some(partition) = standing(gas, time) {
        let across = partition.axis.index().min(1);
        let [low, high] = [container[0][1 - across], container[1][1 - across]];
        let hole = partition.hole.as_ref().map(|hole| [hole.from[0], hole.to[0]]);
        let stretches = hole.map_or(vec![[low, high]], |[from, to]| vec![[low, from], [to, high]]);
        let position = |at: f64| if across == 0 { [partition.at, at] } else { [at, partition.at] };
        borders.extend(stretches.into_iter().map(|stretch| Border::Line {
            style: LineStyle::Partition,
            ends: stretch.map(position),
            outwards: [0.0; 2],
        }));
    }
    borders.extend(gas.measure.region.iter().flat_map(outline));
    borders
}

/// The edges of a flat region of measurement.
fn outline(NamedRegion { from, to, .. }: &NamedRegion) -> [Border; 4] {
    let corners = [[from[0], from[1]], [to[0], from[1]], [to[0], to[1]], [from[0], to[1]]];
    std::array::from_fn(|edge| Border::Line {
        style: LineStyle::Region,
        ends: [corners[edge], corners[(edge + 1) % 4]],
        outwards: [0.0; 2],
    })
}

/// The edges of a box in space, those of sides at a temperature in its colour, and of the regions of measurement.
pub(super) fn edges(gas: &Gas, context: &DrawContext, view: &View) -> Vec<Tubes> {
    let (from, to) = (view.container.from, view.container.to);
    let is_hot = |edge: &Vec<[f64; 3]>| {
        Axis::ALL.into_iter().any(|axis| {
            let k = axis.index();
            let walls = gas.walls.along(axis).into_iter().zip([from[k], to[k]]);
            walls
                .into_iter()
                .any(|(wall, at)| matches!(wall, Wall::Thermal { .. }) && edge.iter().all(|point| point[k] == at))
        })
    };
    let (hot, cold): (Vec<_>, Vec<_>) = box_edges(from, to).into_iter().partition(is_hot);
    let regions = gas.measure.region.iter().flat_map(|region| box_edges(padded(&region.from), padded(&region.to)));
    [(INK, EDGE, cold), (THERMAL_WALL, 2.0 * EDGE, hot), (REGION, EDGE, regions.collect())]
        .map(|(colour, width, edges)| {
            tubes(context, &view.stage, colour, [width, 0.0], edges.iter().map(Vec::as_slice))
        })
        .into()
}

/// The plates in a box in space, kept from picture to picture while they stay where they are.
#[derive(Default)]
pub(super) struct Plates {
    kept: Vec<(SolidBounds, Solid)>,
}

type SolidBounds = [[f64; 3]; 2];

impl Plates {
    /// Plates for walls that move, and for the partition while it stands.
    pub(super) fn of(
        &mut self,
        gas: &Gas,
        context: &DrawContext,
        view: &View,
        time: f64,
    ) -> impl Iterator<Item = &mut dyn Drawable> + use<'_> {
        let shapes = shapes(gas, view, time);
        let before = std::mem::take(&mut self.kept);
        let same = before.iter().map(|(bounds, _)| *bounds).eq(shapes.iter().map(|shape| shape.bounds));
        self.kept = if same {
            before
        } else {
            let solid =
                |shape: &SolidShape| Solid::new(&context.renderer, &view.stage, shape, SolidStyle::Glass(PLATE));
            shapes.iter().map(|shape| (shape.bounds, solid(shape))).collect()
        };
        self.kept.iter_mut().map(|(_, solid)| solid as &mut dyn Drawable)
    }
}

fn shapes(gas: &Gas, view: &View, time: f64) -> Vec<SolidShape> {
    let thick = THICK * view.stage.unit();
    let (from, to) = (view.container.from, view.container.to);
    let mut shapes = Vec::new();
    for axis in Axis::ALL {
        let k = axis.index();
        for (end, _) in gas.walls.along(axis).into_iter().enumerate().filter(|(_, wall)| moves(wall)) {
            let face = if end == 0 { from[k] } else { to[k] };
            let beyond = if end == 0 { face - thick } else { face + thick };
            shapes.push(plate([from, to], k, [face.min(beyond), face.max(beyond)], None));
        }
    }
    if let Some(partition) = standing(gas, time) {
        let middle = [partition.at - 0.25 * thick, partition.at + 0.25 * thick];
        let hole = partition.hole.as_ref().map(|hole| [hole.from.clone(), hole.to.clone()]);
        shapes.push(plate([from, to], partition.axis.index(), middle, hole));
    }
    shapes
}

/// A plate across an axis, over the box, with a hole.
fn plate(mut bounds: SolidBounds, axis: usize, [low, high]: [f64; 2], hole: Option<[Vec<f64>; 2]>) -> SolidShape {
    (bounds[0][axis], bounds[1][axis]) = (low, high);
    let hole = hole.map(|[from, to]| {
        // The hole goes through: it is as long as it has to be along the axis.
        let mut hole = bounds;
        let others = (0..3).filter(|k| *k != axis);
        others.zip(from.into_iter().zip(to)).for_each(|(k, (from, to))| (hole[0][k], hole[1][k]) = (from, to));
        let long = bounds[1][axis] - bounds[0][axis];
        (hole[0][axis], hole[1][axis]) = (low - long, high + long);
        hole
    });
    let distance = move |at: [f64; 3]| {
        let plate = from_box(bounds, at);
        hole.map_or(plate, |hole| plate.max(-from_box(hole, at)))
    };
    SolidShape { bounds, distance: Arc::new(distance) }
}

/// Distance from a box, at most; negative inside.
fn from_box([from, to]: SolidBounds, at: [f64; 3]) -> f64 {
    (0..3).map(|k| (from[k] - at[k]).max(at[k] - to[k])).fold(f64::NEG_INFINITY, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plate_is_solid_but_for_its_hole() {
        let shape = plate([[0.0; 3], [4.0, 6.0, 6.0]], 0, [1.9, 2.1], Some([vec![2.0, 2.0], vec![4.0, 4.0]]));
        assert_eq!(shape.bounds, [[1.9, 0.0, 0.0], [2.1, 6.0, 6.0]]);
        assert!((shape.distance)([2.0, 1.0, 1.0]) < 0.0);
        assert!((shape.distance)([2.0, 3.0, 3.0]) > 0.0);
        assert!((shape.distance)([2.5, 1.0, 1.0]) > 0.0);
    }

    #[test]
    fn a_region_is_outlined_all_round() {
        let region = NamedRegion { name: "a".into(), from: vec![1.0, 2.0], to: vec![4.0, 6.0] };
        let edges = outline(&region).map(|border| match border {
            Border::Line { style: LineStyle::Region, ends, outwards: [0.0, 0.0] } => ends,
            other => panic!("{other:?}"),
        });
        let length = |[one, other]: [[f64; 2]; 2]| (one[0] - other[0]).hypot(one[1] - other[1]);
        assert_eq!(edges.map(length), [3.0, 4.0, 3.0, 4.0]);
        assert!((0..4).all(|edge| edges[edge][1] == edges[(edge + 1) % 4][0]), "{edges:?}");
    }
}

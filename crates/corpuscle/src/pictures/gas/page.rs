//! The overlay of the picture of a gas.

use super::{GasPicture, View, sides, speeds};
use crate::pictures::{DrawContext, Moment};
use corpuscle_drawing::text;
use corpuscle_output::GasKey;
use corpuscle_render::{Axes, Key, LineStyle, Mark, Overlay};
use corpuscle_scene::{Axis, NamedRegion, Units, Wall, padded};

/// Largest enlargement of balls without a remark.
const HARDLY: f64 = 1.15;

impl GasPicture {
    pub(super) fn overlay(
        &self,
        title: &str,
        moment: &Moment<'_>,
        key: &GasKey,
        view: &View,
        remark: String,
    ) -> Overlay {
        let (unit, time) = match self.gas.units {
            Units::Si => ("m", text::any_time(moment.frame.time)),
            Units::Reduced => ("", text::short_number(moment.frame.time)),
        };
        let key = match key {
            GasKey::Kinds(kinds) => Key::Kinds(kinds.clone()),
            GasKey::Speed { most, unit: "" } => Key::Values("Speed".into(), speeds(*most)),
            GasKey::Speed { most, unit } => Key::Values(format!("Speed, {unit}"), speeds(*most)),
        };
        let flat = self.gas.dimensions() == 2;
        Overlay {
            title: title.into(),
            time: format!("t = {time}"),
            key: Some(key),
            key_position: view.key_position,
            lines: self.lines(moment),
            remark,
            borders: if flat { sides::borders(&self.gas, view, moment.frame.time) } else { Vec::new() },
            marks: if flat { self.marks(moment) } else { Vec::new() },
            labels: self.gas.measure.region.iter().map(label).collect(),
            axes: Some(Axes {
                from: view.stage.from.into(),
                to: view.stage.to.into(),
                unit: unit.into(),
                heights: 1.0,
            }),
            ..Overlay::default()
        }
    }

    /// The legend of the lines in the picture.
    fn lines(&self, moment: &Moment<'_>) -> Vec<(LineStyle, String)> {
        let axes = Axis::ALL.into_iter().take(self.gas.dimensions());
        let walls: Vec<&Wall> = axes.flat_map(|axis| self.gas.walls.along(axis)).collect();
        let flat = self.gas.dimensions() == 2;
        let followed = moment.paths.iter().any(|path| !path.points.is_empty());
        let measured = !self.gas.measure.region.is_empty();
        let found = [
            (measured, LineStyle::Region, "region of measurement"),
            (followed, LineStyle::Trajectory, "trajectory of one ball"),
            (
                walls.iter().any(|wall| matches!(wall, Wall::Thermal { .. })),
                LineStyle::ThermalWall,
                "wall at a temperature",
            ),
            (flat && walls.iter().any(|wall| matches!(wall, Wall::Periodic)), LineStyle::Periodic, "periodic side"),
        ];
        found.into_iter().filter(|(there, ..)| *there).map(|(_, style, name)| (style, name.into())).collect()
    }

    pub(super) fn remark(&self, context: &DrawContext, moment: &Moment<'_>, view: &View) -> String {
        let enlarged = self.enlarged(context, moment.frame, view);
        let mut radii = moment.frame.sets.iter().flat_map(|set| &set.radius);
        let first = radii.next();
        let alike = radii.all(|radius| Some(radius) == first);
        match (enlarged > HARDLY && enlarged.is_finite(), alike) {
            (false, _) => String::new(),
            (true, true) => format!("balls drawn {enlarged:.1} times as large as they are"),
            (true, false) => "small balls drawn larger than they are".into(),
        }
    }

    /// Marks of the start of the trajectory and of its ball.
    fn marks(&self, moment: &Moment<'_>) -> Vec<Mark> {
        let mut marks: Vec<Mark> =
            moment.paths.iter().filter_map(|path| path.points.first()).map(|start| Mark::Start(*start)).collect();
        for set in &moment.frame.sets {
            let found = set.id.iter().position(|id| Some(*id) == self.gas.follow);
            marks.extend(found.map(|at| Mark::Ring(set.position[at], set.radius[at])));
        }
        marks
    }
}

/// The name of a region, in the middle of its upper side.
fn label(region: &NamedRegion) -> ([f64; 3], String) {
    let (from, to) = (padded(&region.from), padded(&region.to));
    let mut position: [f64; 3] = std::array::from_fn(|axis| 0.5 * (from[axis] + to[axis]));
    let upwards = region.to.len() - 1;
    position[upwards] = to[upwards];
    (position, region.name.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_of_a_region_stands_on_its_upper_side() {
        let region = |from: &[f64], to: &[f64]| NamedRegion { name: "a".into(), from: from.into(), to: to.into() };
        assert_eq!(label(&region(&[1.0, 2.0], &[4.0, 6.0])), ([2.5, 6.0, 0.0], "a".into()));
        assert_eq!(label(&region(&[0.0; 3], &[2.0, 4.0, 6.0])), ([1.0, 2.0, 6.0], "a".into()));
    }
}

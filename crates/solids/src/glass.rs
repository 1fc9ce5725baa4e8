//! A wine glass.

use crate::shape::above_zero;
use crate::{Profile, Shape, SolidError};

/// A wine glass, upright on z = 0, turned about z: a foot, a stem and a bowl that is open above. Lengths in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WineGlass {
    /// Height of the whole glass.
    pub height: f64,
    /// Largest outer radius of the bowl.
    pub bowl_radius: f64,
    /// Radius of the foot.
    pub foot_radius: f64,
    /// Radius of the stem.
    pub stem_radius: f64,
    /// Thickness of the bowl's wall and of the foot.
    pub wall: f64,
}

impl Default for WineGlass {
    /// A glass for white wine: 20 cm high, walls of 3 mm.
    fn default() -> Self {
        Self { height: 0.2, bowl_radius: 0.04, foot_radius: 0.035, stem_radius: 0.005, wall: 0.003 }
    }
}

/// Part of the height below the bowl, and part of the bowl's radius at its rim.
const STEM_PART: f64 = 0.45;
const RIM_PART: f64 = 0.8;

/// Corners of the bowl from its bottom to its rim, outside and inside each.
const BOWL_CORNERS: u32 = 24;

impl WineGlass {
    /// The glass as a solid of revolution.
    ///
    /// # Errors
    /// [`SolidError::Size`] for a length that is not above 0, [`SolidError::Profile`] for walls too thick for the glass.
    pub fn shape(&self) -> Result<Shape, SolidError> {
        let lengths = [
            ("the height of a wine glass in m", self.height),
            ("the radius of the bowl of a wine glass in m", self.bowl_radius),
            ("the radius of the foot of a wine glass in m", self.foot_radius),
            ("the radius of the stem of a wine glass in m", self.stem_radius),
            ("the wall of a wine glass in m", self.wall),
        ];
        lengths.into_iter().try_for_each(|(what, value)| above_zero(what, value))?;
        let mut corners = vec![[0.0, 0.0], [self.foot_radius, 0.0], [self.foot_radius, self.wall]];
        corners.push([self.stem_radius, 2.0 * self.wall]);
        corners
            .extend(self.bowl(self.bowl_radius, STEM_PART * self.height).filter(|corner| corner[0] > self.stem_radius));
        let inner: Vec<_> =
            self.bowl(self.bowl_radius - self.wall, STEM_PART * self.height + 1.5 * self.wall).collect();
        corners.extend(inner.into_iter().rev());
        Ok(Shape::Revolution(Profile::new(corners)?))
    }

    /// One side of the bowl from the axis at `bottom` to the rim: a quarter of an ellipse that is widest at 45 % of the
    /// bowl's height, then a part of another that narrows to the rim.
    fn bowl(&self, radius: f64, bottom: f64) -> impl Iterator<Item = [f64; 2]> {
        let (height, rim) = (self.height, RIM_PART.acos());
        let widest = bottom + 0.45 * (height - bottom);
        (0..=BOWL_CORNERS).map(move |step| {
            let part = 2.0 * f64::from(step) / f64::from(BOWL_CORNERS);
            if part <= 1.0 {
                let angle = 0.5 * std::f64::consts::PI * part;
                let around = if step == 0 { 0.0 } else { radius * angle.sin() };
                [around, widest - (widest - bottom) * angle.cos()]
            } else {
                let angle = (part - 1.0) * rim;
                [radius * angle.cos(), widest + (height - widest) * angle.sin() / rim.sin()]
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::WineGlass;

    #[test]
    fn it_holds_wine_and_stands_on_its_foot() {
        let glass = WineGlass::default().shape().unwrap();
        let inside = |point| glass.nearest(point).distance < 0.0;
        assert!(!inside([0.0, 0.0, 0.15]), "the bowl is empty");
        assert!(inside([0.0385, 0.0, 0.14]), "the bowl has a wall");
        assert!(inside([0.0, 0.0, 0.05]) && !inside([0.006, 0.0, 0.05]), "the stem is thin");
        assert!(inside([0.03, 0.0, 0.001]), "the foot is wide");
        assert_eq!(glass.bounds()[1][2], 0.2);
    }

    #[test]
    fn a_glass_of_walls_alone_is_refused() {
        assert!(WineGlass { wall: 0.05, ..WineGlass::default() }.shape().is_err());
        assert!(WineGlass { height: f64::NAN, ..WineGlass::default() }.shape().is_err());
    }
}

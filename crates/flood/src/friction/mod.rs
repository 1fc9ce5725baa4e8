//! Laws of bed friction, for both schemes: after Manning, Chezy, or in proportion to the velocity.

use crate::error::setup;
use corpuscle_model::ModelError;
use corpuscle_scene::{Flood, Friction, LARGEST_MANNING, LandUse, Manning};
use corpuscle_terrain::{RasterField, Terrain};
use std::path::Path;

/// A law of bed friction: slowing by the rate k times the speed, k = coefficient / depth^power, or by a rate alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Law {
    /// Manning 1891: k = g n^2 / d^(4/3).
    Manning,
    /// Chezy 1775: k = g / (C^2 d).
    Chezy,
    /// In proportion to the velocity: the rate is g S.
    Linear,
}

impl Law {
    /// The law's coefficient, from the scene's number: g n^2, g / C^2 or g S.
    pub fn coefficient(self, gravity: f64, number: f64) -> f64 {
        match self {
            Self::Manning => gravity * number * number,
            Self::Chezy => gravity / (number * number),
            Self::Linear => gravity * number,
        }
    }

    /// Whether the rate does not depend on the speed.
    #[inline(always)]
    pub fn is_linear(self) -> bool {
        self == Self::Linear
    }

    /// The power of the depth by which the rate is the coefficient.
    #[inline(always)]
    pub fn power_of(self, depth: f64) -> f64 {
        match self {
            Self::Manning => depth * depth.cbrt(),
            Self::Chezy => depth,
            Self::Linear => 1.0,
        }
    }

    /// That power's exponent, for shaders; negative where the law is linear.
    #[cfg(feature = "gpu")]
    pub fn exponent(self) -> f32 {
        match self {
            Self::Manning => 4.0 / 3.0,
            Self::Chezy => 1.0,
            Self::Linear => -1.0,
        }
    }
}

/// How the ground slows the water.
pub(crate) struct Roughness {
    /// The law.
    pub law: Law,
    /// Its number over the ground: Manning's n, s/m^(1/3), Chezy's C, m^(1/2)/s, or the friction slope over the velocity, s/m.
    pub number: Coefficient,
}

/// A number over the ground.
pub(crate) enum Coefficient {
    Even(f64),
    Raster(Box<RasterField>),
    /// By kinds of ground: their numbers in the raster, with theirs; and that of the rest.
    Classes(Box<RasterField>, Vec<(f64, f64)>, Box<Coefficient>),
}

impl Roughness {
    pub fn open(scene: &Flood, terrain: &Terrain, folder: &Path) -> Result<Self, ModelError> {
        let even = |law, number| Ok(Self { law, number: Coefficient::Even(number) });
        match scene.friction {
            Some(Friction::Chezy(c)) => return even(Law::Chezy, c),
            Some(Friction::Linear(slope)) => return even(Law::Linear, slope),
            None => {}
        }
        let open = |path: &Path| RasterField::open(folder.join(path), terrain).map(Box::new).map_err(setup);
        let rest = match &scene.manning {
            Manning::Number(n) => Coefficient::Even(*n),
            Manning::Raster { raster } => {
                let field = open(raster)?;
                check_manning(&folder.join(raster), &field)?;
                Coefficient::Raster(field)
            }
        };
        let manning = |number| Ok(Self { law: Law::Manning, number });
        let Some(LandUse { raster, class }) = &scene.land_use else { return manning(rest) };
        let classes: Vec<_> = class.iter().filter_map(|class| Some((class.code as f64, class.manning?))).collect();
        if classes.is_empty() {
            return manning(rest);
        }
        manning(Coefficient::Classes(open(raster)?, classes, Box::new(rest)))
    }

    /// Manning's n where no kind of ground has its own, to be changed; none where that is a raster, or friction another law's.
    pub fn rest(&mut self) -> Option<&mut f64> {
        if self.law == Law::Manning { self.number.rest() } else { None }
    }

    /// Whether it slows nothing.
    pub fn is_smooth(&self) -> bool {
        self.law == Law::Manning && self.number.even() == Some(0.0)
    }
}

/// Refuses a raster with values that are no Manning's n.
fn check_manning(path: &Path, field: &RasterField) -> Result<(), ModelError> {
    let Some([low, high]) = field.range() else { return Ok(()) };
    if low >= 0.0 && high <= LARGEST_MANNING {
        return Ok(());
    }
    Err(setup(format!(
        "flood.manning: the raster {} has values from {low} to {high}, which are no Manning's n, 0.01 to 0.2 for most ground; if it has Strickler's k \
         give 1 / k, and if some value marks cells without data say so in the file: `gdal_edit.py -a_nodata`",
        path.display()
    )))
}

impl Coefficient {
    /// The raster that says how fine it is.
    #[cfg(feature = "gpu")]
    pub fn raster(&self) -> Option<&RasterField> {
        match self {
            Self::Even(_) => None,
            Self::Raster(raster) | Self::Classes(raster, ..) => Some(raster),
        }
    }

    /// The value, where it is the same everywhere.
    pub fn even(&self) -> Option<f64> {
        if let Self::Even(value) = self { Some(*value) } else { None }
    }

    fn rest(&mut self) -> Option<&mut f64> {
        match self {
            Self::Even(value) => Some(value),
            Self::Raster(_) => None,
            Self::Classes(_, _, rest) => rest.rest(),
        }
    }

    pub fn at(&self, x: f64, y: f64) -> f64 {
        match self {
            Self::Even(value) => *value,
            Self::Raster(raster) => raster.nearest(x, y).unwrap_or(0.0),
            Self::Classes(raster, classes, rest) => {
                let code = raster.nearest(x, y);
                let class = classes.iter().find(|(class, _)| Some(*class) == code);
                class.map_or_else(|| rest.at(x, y), |(_, value)| *value)
            }
        }
    }
}

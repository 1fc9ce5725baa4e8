//! The solids.

use crate::Series;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A solid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Solid {
    /// Name, unique in the scene.
    pub name: String,
    /// Its form.
    pub shape: Shape,
    /// What it is made of.
    #[serde(default)]
    pub material: Material,
    /// Where its own origin is, m.
    #[serde(default)]
    pub position_m: [f64; 3],
    /// Turns about x, then y, then z through its own origin, degrees.
    #[serde(default)]
    pub rotation_deg: [f64; 3],
    /// Temperature, °C: at the start, or over time where it is held.
    pub temperature_c: Series,
    /// Whether its temperature is held whatever happens; else it warms and cools.
    #[serde(default)]
    pub held: bool,
    /// Layers of particles below its surface. Left out: it is filled.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub layers: Option<u32>,
    /// A heater in it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub heater: Option<Heater>,
    /// What is outside, where the solid reaches a side of the box.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outside: Option<Outside>,
    /// Radiation between its surface in the box and what surrounds it. Left out: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radiation: Option<Radiation>,
    /// How air is kept out of it. Left out: as of all, by `boundary.treatment`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub treatment: Option<super::Treatment>,
    /// Density of nucleation sites on it, 1/m2. Left out: as on all, by `drops.sites_per_m2`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sites_per_m2: Option<f64>,
    /// How water lies on it.
    #[serde(default)]
    pub wetting: Wetting,
    /// Parts of its surface that are measured by themselves.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub face: Vec<SolidFace>,
}

/// How water lies on a solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Wetting {
    /// As drops.
    #[default]
    Drops,
    /// As a film that flows down: the surface is one that water wets, as with an anti-fog coating.
    Film,
}

/// A part of a solid's surface that is measured by itself: where the surface faces one way more than any other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SolidFace {
    /// Name, unique among the faces of the solid.
    pub name: String,
    /// The way that it faces, by the solid's own axes, before it is turned.
    pub side: Side,
}

/// A heater, which warms all of a solid evenly. Give exactly one of `power_w` and `power_w_per_m2`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Heater {
    /// Power in what of the solid is in the box, W, constant or over time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub power_w: Option<Series>,
    /// Power for each area of the solid's surface in the box, W/m2, constant or over time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub power_w_per_m2: Option<Series>,
}

/// What is outside a side of the box, for a solid that reaches it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outside {
    /// The side of the box, a wall.
    pub side: Side,
    /// Temperature of the air outside, °C, constant or over time.
    pub temperature_c: Series,
    /// Heat transfer coefficient of the air outside, W/(m2 K).
    pub h_w_per_m2_k: f64,
    /// Emissivity of the solid's outer surface.
    #[serde(default)]
    pub emissivity: f64,
    /// Mean radiant temperature outside, °C, constant or over time, as of the sky. Left out: that of the air outside.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surroundings_c: Option<Series>,
    /// Layers of the wall between the solid and the air outside, from the solid outwards. Left out: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub layers: Vec<WallLayer>,
}

/// A layer of a wall. Give either `material` and `thickness_m`, or `resistance_m2_k_per_w`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WallLayer {
    /// What it is made of.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material: Option<Material>,
    /// Its thickness, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thickness_m: Option<f64>,
    /// Thermal resistance of a layer that holds no heat, as of a gap with air, m2 K/W.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub resistance_m2_k_per_w: Option<f64>,
}

/// Radiation between a grey surface and what surrounds it, much larger than the solid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Radiation {
    /// Emissivity of the surface.
    pub emissivity: f64,
    /// Mean radiant temperature, °C, constant or over time.
    pub surroundings_c: Series,
}

/// A side of the box, or of a solid by its own axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// At x = 0.
    XMin,
    /// At the largest x.
    XMax,
    /// At y = 0.
    YMin,
    /// At the largest y.
    YMax,
    /// At z = 0.
    ZMin,
    /// At the largest z.
    ZMax,
}

impl Side {
    /// Number of its axis, and 0 at the lower or 1 at the upper end of it.
    pub fn axis_and_end(self) -> [usize; 2] {
        let number = self as usize;
        [number / 2, number % 2]
    }

    /// Its key in `[dew.faces]`.
    pub fn key(self) -> &'static str {
        let [axis, end] = self.axis_and_end();
        crate::check::SIDES[axis][end]
    }
}

/// The form of a solid, in its own coordinates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Shape {
    /// A box with its middle at the origin.
    Box {
        /// Lengths of its sides, m.
        size_m: [f64; 3],
    },
    /// A ball with its middle at the origin.
    Sphere {
        /// Radius, m.
        radius_m: f64,
    },
    /// A cylinder along z with its middle at the origin.
    Cylinder {
        /// Radius, m.
        radius_m: f64,
        /// Length along z, m.
        height_m: f64,
    },
    /// A profile turned about z.
    Revolution {
        /// Corners `[distance from the axis, z]` in turn, m; the last is joined to the first.
        profile_m: Vec<[f64; 2]>,
    },
    /// A wine glass that stands on z = 0.
    WineGlass(WineGlass),
    /// A mesh from a file.
    Mesh(MeshFile),
}

/// A wine glass that stands on z = 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct WineGlass {
    /// Height of the whole glass, m.
    pub height_m: f64,
    /// Largest outer radius of the bowl, m.
    pub bowl_radius_m: f64,
    /// Radius of the foot, m.
    pub foot_radius_m: f64,
    /// Radius of the stem, m.
    pub stem_radius_m: f64,
    /// Thickness of the bowl's wall and of the foot, m.
    pub wall_m: f64,
}

impl Default for WineGlass {
    fn default() -> Self {
        Self { height_m: 0.2, bowl_radius_m: 0.04, foot_radius_m: 0.035, stem_radius_m: 0.005, wall_m: 0.003 }
    }
}

/// A mesh from a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeshFile {
    /// OBJ, STL, PLY, glTF or GLB.
    pub path: PathBuf,
    /// What its numbers are measured in. Required for all but glTF and GLB, which are in metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<LengthUnit>,
}

impl MeshFile {
    /// True for the formats that say themselves that they are in metres.
    pub fn is_in_metres(&self) -> bool {
        let extension = self.path.extension().and_then(|extension| extension.to_str());
        extension.is_some_and(|extension| ["gltf", "glb"].contains(&extension.to_ascii_lowercase().as_str()))
    }
}

/// A unit of length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LengthUnit {
    /// Metre.
    M,
    /// Centimetre.
    Cm,
    /// Millimetre.
    Mm,
    /// Inch.
    In,
    /// Foot.
    Ft,
}

impl LengthUnit {
    /// One of it in m; inch and foot as agreed in 1959.
    pub fn in_metres(self) -> f64 {
        match self {
            Self::M => 1.0,
            Self::Cm => 0.01,
            Self::Mm => 0.001,
            Self::In => 0.0254,
            Self::Ft => 0.3048,
        }
    }
}

/// What a solid is made of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(
    untagged,
    deny_unknown_fields,
    expecting = "expected the name of a material, as in \"glass\", or { conductivity_w_per_m_k = 1.4, heat_capacity_j_per_kg_k \
                 = 750, density_kg_per_m3 = 2500 }"
)]
pub enum Material {
    /// One of the table of materials.
    Named(String),
    /// Told by its numbers.
    Own {
        /// Conductivity of heat, W/(m K).
        conductivity_w_per_m_k: f64,
        /// Heat capacity, J/(kg K).
        heat_capacity_j_per_kg_k: f64,
        /// Density, kg/m3.
        density_kg_per_m3: f64,
    },
}

impl Default for Material {
    fn default() -> Self {
        Self::Named("glass".into())
    }
}

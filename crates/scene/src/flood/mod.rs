//! What a flood scene says. Lengths in m, times in s, discharges in m3/s, in the terrain's coordinates
//! (for a geographic terrain: longitude and latitude in degrees wherever a position is named).

mod adaptive;
mod check;
mod finer;
mod friction;
mod obstacle;
mod rain;
mod scene;
mod start;
mod structures;

pub use adaptive::Adaptive;
pub use finer::Finer;
pub use friction::Friction;
pub use obstacle::{Circle, Obstacle};
pub use rain::{ConstantInfiltration, GreenAmpt, Horton, Infiltration, LandClass, LandUse, Rain};
pub use scene::FloodScene;
pub use start::{Field, StartVelocity, VelocityRasters};
pub use structures::{Culvert, Link, LinkLaw, Outflow, Stage, Weir};

use crate::KernelName;
use crate::Series;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The `[flood]` table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Flood {
    /// Which formulation moves the water.
    pub scheme: Scheme,
    /// What lengths and discharges are written in. A scene that was read is in metres.
    pub units: FloodUnits,
    /// Distance between particles, m: in scheme voronoi in all water, in sph-swe in water of depth `spacing_depth_m`, where particles hold
    /// `spacing_m^2 * spacing_depth_m` each at the start, so that they stand closer in deeper water and wider in shallower. Left out: the size of
    /// the terrain's cells, or more, so that not more than about 200,000 particles are wet.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spacing_m: Option<f64>,
    /// The depth at which particles are `spacing_m` apart, m, in scheme sph-swe; particles that fall from the air hold
    /// `spacing_m^2 * spacing_depth_m` each in both schemes. Left out: the mean depth of the initial water, or 1 m where there is none; in
    /// scheme voronoi 1 m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spacing_depth_m: Option<f64>,
    /// Acceleration of gravity, m/s2.
    pub gravity_m_per_s2: f64,
    /// Manning's roughness n, s/m^(1/3): a number or a raster.
    pub manning: Manning,
    /// Friction after another law than Manning's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<Friction>,
    /// Kinds of ground by a raster.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub land_use: Option<LandUse>,
    /// How water soaks into the ground.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub infiltration: Option<Infiltration>,
    /// Rain.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rain: Option<Rain>,
    /// Parts of the terrain with finer cells (scheme `voronoi`).
    pub finer: Vec<Finer>,
    /// Cells that become finer where the water is shallow on uneven ground (scheme `voronoi`).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub adaptive: Option<Adaptive>,
    /// How much water a cell holds below a level (scheme `voronoi`).
    pub storage: Storage,
    /// Whether all cells take the same time step (scheme `voronoi`).
    pub time_steps: TimeSteps,
    /// A position counts as wet above this depth, m (maps and extent).
    pub wet_depth_m: f64,
    /// Interval at which the maps of maxima, arrival and duration sample the water, s. Left out: the gauge period.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub map_every_s: Option<f64>,
    /// Parameters of scheme `sph-swe`.
    pub sph_swe: SphSwe,
    /// What happens at the four sides of the terrain.
    pub edges: Edges,
    /// What happens at parts of the sides.
    pub edge_part: Vec<EdgePart>,
    /// Lines inside the terrain at which water enters or leaves as at a side.
    pub edge_line: Vec<EdgeLine>,
    /// Water that is there at the start.
    pub water: Vec<Water>,
    /// Water that comes in.
    pub inflow: Vec<Inflow>,
    /// Outflows by a rating curve.
    pub outflow: Vec<Outflow>,
    /// Water that is held at a level.
    pub stage: Vec<Stage>,
    /// Culverts, weirs and other ways from one point to another.
    pub link: Vec<Link>,
    /// Buildings and walls.
    pub obstacle: Vec<Obstacle>,
    /// Points where depth, level and velocity are recorded.
    pub gauge: Vec<Gauge>,
    /// Lines through which the discharge is recorded.
    pub section: Vec<Section>,
    /// A GeoJSON file with the flooded area as observed; hit rate and critical success index are then reported.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub observed_extent: Option<PathBuf>,
}

impl Flood {
    /// The first key below `[flood]` that only scheme voronoi has; none where scheme sph-swe has all.
    #[must_use]
    pub fn only_of_voronoi(&self) -> Option<String> {
        let soaks = |class: &LandClass| class.infiltration.is_some();
        let classes = self.land_use.iter().flat_map(|land_use| &land_use.class);
        let line = self.obstacle.iter().position(|obstacle| obstacle.line.is_some());
        let Edges { west, east, south, north } = &self.edges;
        let of_voronoi = |edge: &Edge| !matches!(edge, Edge::Open | Edge::Wall | Edge::Periodic);
        let side = [("west", west), ("east", east), ("south", south), ("north", north)];
        let side = side.into_iter().find(|(_, edge)| of_voronoi(edge));
        let keys = [
            ("storage", (self.storage != Storage::Mean).then(String::new)),
            ("time_steps", (self.time_steps != TimeSteps::Global).then(String::new)),
            ("finer", first(&self.finer)),
            ("adaptive", self.adaptive.as_ref().map(|_| String::new())),
            ("rain", self.rain.as_ref().map(|_| String::new())),
            ("infiltration", self.infiltration.as_ref().map(|_| String::new())),
            ("land_use", classes.into_iter().position(soaks).map(|row| format!(".class.{row}.infiltration"))),
            ("edges", side.map(|(side, _)| format!(".{side}"))),
            ("edge_part", first(&self.edge_part)),
            ("edge_line", first(&self.edge_line)),
            ("outflow", first(&self.outflow)),
            ("stage", first(&self.stage)),
            ("link", first(&self.link)),
            ("obstacle", line.map(|row| format!(".{row}.line"))),
        ];
        keys.into_iter().find_map(|(key, below)| Some(format!("{key}{}", below?)))
    }
}

/// The first row of a list, as part of its key.
fn first<T>(rows: &[T]) -> Option<String> {
    rows.first().map(|_| ".0".into())
}

impl Default for Flood {
    fn default() -> Self {
        Self {
            scheme: Scheme::Voronoi,
            units: FloodUnits::Si,
            spacing_m: None,
            spacing_depth_m: None,
            gravity_m_per_s2: 9.81,
            manning: Manning::Number(0.03),
            friction: None,
            land_use: None,
            infiltration: None,
            rain: None,
            finer: Vec::new(),
            adaptive: None,
            storage: Storage::Mean,
            time_steps: TimeSteps::Global,
            wet_depth_m: 0.01,
            map_every_s: None,
            sph_swe: SphSwe::default(),
            edges: Edges::default(),
            edge_part: Vec::new(),
            edge_line: Vec::new(),
            water: Vec::new(),
            inflow: Vec::new(),
            outflow: Vec::new(),
            stage: Vec::new(),
            link: Vec::new(),
            obstacle: Vec::new(),
            gauge: Vec::new(),
            section: Vec::new(),
            observed_extent: None,
        }
    }
}

/// Which formulation moves the water.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scheme {
    /// Columns of water over Voronoi cells, with fluxes through their closed faces: right on any ground.
    Voronoi,
    /// The published stable SPH-SWE scheme (Acta Physica Sinica, 2021), with its control force.
    SphSwe,
}

/// How much water a cell holds below a level.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Storage {
    /// The ground of a cell is level, at its mean height.
    Mean,
    /// The heights of the ground within a cell count: a table of volume against level for each.
    LevelVolume,
}

/// Which time steps cells take.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TimeSteps {
    /// All the same.
    Global,
    /// Cells that can take longer steps do, where that saves time.
    Local,
}

/// What the numbers of a flood are written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FloodUnits {
    /// Metres, cubic metres a second, millimetres an hour.
    Si,
    /// Feet, cubic feet a second, inches an hour.
    Us,
}

/// Largest value that is taken for Manning's n, s/m^(1/3): that of the roughest ground is about 0.2, and what is above this is Strickler's 1/n.
pub const LARGEST_MANNING: f64 = 1.0;

/// Manning's roughness.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(
    untagged,
    deny_unknown_fields,
    expecting = "expected a number, as in 0.03, or a file, as in { raster = \"n.tif\" }"
)]
pub enum Manning {
    /// One value everywhere, s/m^(1/3).
    Number(f64),
    /// A raster of values in any format that terrain comes in.
    Raster {
        /// The file.
        raster: PathBuf,
    },
}

/// Parameters of scheme `sph-swe`, defaults from its Table 1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SphSwe {
    /// Fixed time step, s.
    pub time_step_s: f64,
    /// Initial smoothing length h0, m. Left out: that of Table 1, 2.66 m, scaled with the root of the particles' volume (which
    /// is 1 m3 there), so that a particle has as many neighbours as in the paper.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothing_length_m: Option<f64>,
    /// How the smoothing length follows the water.
    pub smoothing: SmoothingForm,
    /// The smoothing kernel.
    pub kernel: KernelName,
    /// Density of water rho0 (also the reference two-dimensional density), kg/m3.
    pub density_kg_per_m3: f64,
    /// Gas constant k.
    pub gas_constant: f64,
    /// Viscosity.
    pub viscosity: f64,
    /// Particle radius, m (drawing only). Left out: half the spacing, as in Table 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius_m: Option<f64>,
    /// The terrain-difference velocity control force, on or off.
    pub control_force: bool,
    /// Strength of the control force; the paper prints no coefficient.
    pub control_strength: f64,
    /// Side of the control square over the smoothing length (alpha).
    pub control_square: f64,
    /// Negative pressures are set to 0.
    pub clip_negative_pressure: bool,
    /// Smoothing length at most this many times h0.
    pub largest_smoothing: f64,
}

impl Default for SphSwe {
    fn default() -> Self {
        Self {
            time_step_s: 0.02,
            smoothing_length_m: None,
            smoothing: SmoothingForm::Density,
            kernel: KernelName::Mueller,
            density_kg_per_m3: 1000.0,
            gas_constant: 10.0,
            viscosity: 0.1,
            radius_m: None,
            control_force: true,
            control_strength: 1.0,
            control_square: 0.5,
            clip_negative_pressure: true,
            largest_smoothing: 4.0,
        }
    }
}

/// How the smoothing length of scheme `sph-swe` follows the water.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SmoothingForm {
    /// From the density: h = h0 (rho0 / rho)^(1/2).
    Density,
    /// The paper's general forms (8) and (9): at the start from the neighbours' area, then by its rate of change. On the CPU only.
    Rate,
}

/// The four sides of the terrain.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Edges {
    /// Side at the smallest x.
    pub west: Edge,
    /// Side at the largest x.
    pub east: Edge,
    /// Side at the smallest y.
    pub south: Edge,
    /// Side at the largest y.
    pub north: Edge,
}

/// What happens at one side.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Edge {
    /// Water flows out and is counted; nothing comes in.
    #[default]
    Open,
    /// A wall without friction.
    Wall,
    /// What leaves here comes in at the opposite side (which must be periodic too).
    Periodic,
    /// The level is held at this value over time, m (scheme voronoi). Waves that are short beside the time in which they cross the terrain leave.
    Stage(Series),
    /// So much comes in over time, m3/s, shared out by conveyance (scheme voronoi).
    Discharge(Series),
    /// A wave comes in, and waves from inside leave (scheme voronoi).
    Wave(Wave),
    /// Water leaves at the depth of normal flow on this slope, and none comes in (scheme voronoi).
    NormalDepth(f64),
    /// A wall that moves: how far it stands inwards of the side over time, m (scheme voronoi). Its displacement is taken as small beside waves: it acts at the side.
    Paddle(Series),
    /// Water leaves by the level before the side: rows of `[level, discharge]`, m and m3/s, linear between them (scheme voronoi).
    Rating(Vec<[f64; 2]>),
}

/// A wave that comes in at a side. Give its level, its velocity, or both.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wave {
    /// The level of the water at rest, m.
    pub rest_level_m: f64,
    /// The level of the incoming wave alone over time, m. Left out: that of a simple wave with the velocity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level_m: Option<Series>,
    /// Its velocity inwards over time, m/s. Left out: that of a simple wave with the level.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity_m_per_s: Option<Series>,
}

/// What happens at a part of a side, in place of what happens at the rest of it (scheme voronoi).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EdgePart {
    /// The side.
    pub side: Side,
    /// Where the part begins along the side, in the terrain's own coordinates: y at the west and east, x at the south and north.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// What happens there.
    pub edge: Edge,
}

/// A line inside the terrain that is a side to the water on its right, seen from its first position towards its last, and a wall to the water on its left
/// (scheme voronoi).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EdgeLine {
    /// Positions along it.
    pub line: Vec<[f64; 2]>,
    /// What happens there.
    pub edge: Edge,
}

/// A side of the terrain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// At the smallest x.
    West,
    /// At the largest x.
    East,
    /// At the smallest y.
    South,
    /// At the largest y.
    North,
}

/// Water that is there at the start. Give exactly one of `level_m`, `depth_m`, `depth_raster` or `block`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Water {
    /// Up to this level, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level_m: Option<Field>,
    /// This depth, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth_m: Option<Field>,
    /// A raster of depths, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth_raster: Option<PathBuf>,
    /// Only inside this polygon: corners `[x, y]` in the terrain's coordinates. Left out: everywhere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub polygon: Option<Vec<[f64; 2]>>,
    /// A block of particles released above the ground, falling freely until it lands.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub block: Option<Block>,
    /// Velocity at the start.
    pub velocity_m_per_s: StartVelocity,
}

/// A block of particles in the air.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Block {
    /// Corner at the smallest x and y.
    pub from: [f64; 2],
    /// Corner at the largest x and y.
    pub to: [f64; 2],
    /// Height of its lower side above the ground below its centre, m.
    pub height_m: f64,
    /// Layers of particles, one above the other, one spacing apart.
    #[serde(default = "one")]
    pub layers: usize,
}

fn one() -> usize {
    1
}

/// Water that comes in. Give exactly one of `at` or `line`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Inflow {
    /// Name, for gauges and messages.
    pub name: String,
    /// At a point `[x, y]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 2]>,
    /// Spread along a line of points `[x, y]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<Vec<[f64; 2]>>,
    /// Discharge over time, m3/s.
    pub discharge_m3_per_s: Series,
    /// Velocity `[east, north]` with which the water comes in, m/s.
    #[serde(default)]
    pub velocity_m_per_s: [f64; 2],
}

/// A point where depth, level and velocity are recorded. Give exactly one of `at` or `lon_lat`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gauge {
    /// Name, unique in the scene.
    pub name: String,
    /// Position `[x, y]` in the terrain's coordinates.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 2]>,
    /// Position as longitude and latitude, degrees (WGS 84).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lon_lat: Option<[f64; 2]>,
}

/// A line through which the discharge is recorded, positive from its left to its right side
/// (left of the way from its first to its last point).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Section {
    /// Name, unique in the scene.
    pub name: String,
    /// Points `[x, y]` in the terrain's coordinates.
    pub line: Vec<[f64; 2]>,
}

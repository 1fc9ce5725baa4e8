//! Numbers as the shaders see them: `dew_card.wgsl`, `dew_solids.wgsl` and `dew_columns.wgsl` have the same in the same order.
//!
//! Single precision has some 7 digits. They are not to be spent on where the room is, nor on the 300 K and the part of vapour that all
//! air has in common: places are counted from the middle of the room, temperature and vapour from those of the ambient air. What grows by
//! little in a step is kept as a sum with what it has too much.

use bytemuck::{Pod, Zeroable};

/// Air as it comes in by a face.
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Inlet {
    pub velocity: [f32; 3],
    pub temperature: f32,
    pub vapour: f32,
    pub behind: f32,
    pub unused: [f32; 2],
}

/// A fan.
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct CardFan {
    pub low: [f32; 3],
    pub rate: f32,
    pub high: [f32; 3],
    pub speed: f32,
    pub direction: [f32; 3],
    pub unused: f32,
}

/// Fans that there is room for: 48 KiB of the 64 that every device has for numbers of this kind.
pub(crate) const MOST_FANS: usize = 1024;

/// Numbers of the run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Parameters {
    pub low: [f32; 3],
    pub h: f32,
    pub high: [f32; 3],
    pub spacing: f32,
    pub faces: [u32; 8],
    pub corner: [f32; 3],
    pub per_cell: f32,
    pub cells: [u32; 3],
    pub flags: u32,
    pub apart: [f32; 3],
    pub fans: u32,
    pub counts: [u32; 3],
    pub per_h: f32,
    pub gravity: [f32; 3],
    pub sound: f32,
    pub driven: [f32; 3],
    pub viscosity: f32,
    pub density: f32,
    pub rest_density: f32,
    pub kappa: f32,
    pub of_filling: f32,
    pub of_moments: f32,
    pub of_pressure: f32,
    pub of_spread: f32,
    pub of_laplacian: f32,
    pub of_pair: f32,
    pub mass: f32,
    pub heat_capacity: f32,
    pub latent_heat: f32,
    pub heat_diffusivity: f32,
    pub vapour_diffusivity: f32,
    pub largest_diffusivity: f32,
    pub vapour_reach: f32,
    pub ambient: f32,
    pub ambient_vapour: f32,
    pub celsius: f32,
    pub air_pressure: f32,
    pub spreading: f32,
    pub farthest: f32,
    pub cfl: f32,
    pub shortest_step: f32,
    pub slowest: f32,
    pub saturated: f32,
    pub ambient_pressure: f32,
    pub zero: u32,
    pub deepest: [f32; 3],
    pub full: u32,
    pub field_corner: [f32; 3],
    pub per_node: f32,
    pub nodes: [u32; 3],
    pub low_beyond: f32,
    pub useless_beyond: f32,
    pub low_after: f32,
    pub time_factor: f32,
    pub lacking: f32,
    pub viscosity_per_kelvin: f32,
    pub conductivity_per_kelvin: f32,
    pub diffusivity_per_kelvin: f32,
    pub reference: f32,
    pub inlets: [Inlet; 6],
}

/// Values of [`Parameters::flags`].
pub(super) const IS_PASSED: u32 = 1;
pub(super) const DIFFUSES: u32 = 2;
pub(super) const FOGS: u32 = 4;
pub(super) const SATURATES: u32 = 8;
pub(super) const REFUSES_FAST: u32 = 16;
pub(super) const RELATIVE: u32 = 32;
pub(super) const TENDS: u32 = 64;
pub(super) const IS_CLOSED: u32 = 128;
pub(super) const IS_HARMONIC: u32 = 256;

/// What the faces do.
pub(super) const WALL: u32 = 0;
pub(super) const PERIODIC: u32 = 1;
pub(super) const INLET: u32 = 2;
pub(super) const OUTLET: u32 = 3;
pub(super) const OPEN: u32 = 4;

/// A sum and what it has too much.
pub(super) type Account = [f32; 2];

/// The value of a sum.
pub(super) fn value([sum, lacking]: Account) -> f64 {
    f64::from(sum) - f64::from(lacking)
}

/// A number as a sum of two.
pub(super) fn account(value: f64) -> Account {
    let sum = value as f32;
    [sum, (f64::from(sum) - value) as f32]
}

/// A parcel of air.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct CardParticle {
    pub place: [f32; 3],
    pub density: f32,
    pub velocity: [f32; 3],
    pub fog: f32,
    pub acceleration: [f32; 3],
    pub deposit: f32,
    pub spreading: [f32; 3],
    pub id: u32,
    pub temperature: Account,
    pub vapour: Account,
    pub role: u32,
    pub idle: f32,
    pub unused: [f32; 2],
}

/// A particle of a solid, its image, or a ghost sample.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct CardSite {
    pub place: [f32; 3],
    pub volume: f32,
    pub to_air: f32,
    pub to_solid: f32,
    pub part: f32,
    pub flags: u32,
    pub particle: u32,
    pub first: u32,
    pub end: u32,
    pub capacity: f32,
}

/// Values of [`CardSite::flags`].
pub(super) const BOUNDARY: u32 = 1;
pub(super) const NEAR_SURFACE: u32 = 2;
pub(super) const JOINS_DENSITY: u32 = 4;
pub(super) const REPELS: u32 = 8;
pub(super) const GHOST: u32 = 16;
pub(super) const HELD: u32 = 32;
pub(super) const IMAGE_BEYOND: u32 = 64;

/// Water on a particle of a solid.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct CardWater {
    pub told: f32,
    pub evaporation: f32,
    pub gained: Account,
}

/// What else changes of a particle of a solid.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct CardSolid {
    pub temperature: Account,
    pub flow: f32,
    pub held: f32,
    pub stiff: f32,
    pub water: f32,
}

/// A solid.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct CardBody {
    pub first: u32,
    pub end: u32,
    pub flow: f32,
    pub stiff: f32,
    pub held: Account,
    pub first_row: u32,
    pub end_row: u32,
    pub water: f32,
    pub unused: f32,
}

/// A value over time: see `dew_rows.wgsl`.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct CardRow {
    pub time: Account,
    pub value: f32,
    pub unused: f32,
}

impl CardRow {
    /// A value less `zero` at a time, counted from `start`, s.
    pub fn new([time, value]: [f64; 2], start: f64, zero: f64) -> Self {
        Self { time: account(time - start), value: (value - zero) as f32, unused: 0.0 }
    }
}

/// A column of air outside an open side: see `dew_columns.wgsl`.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct OutsideColumn {
    pub velocity: f32,
    pub is_free: u32,
}

/// Bytes of a `BeforeColumn`, of `dew_columns.wgsl` too.
pub(super) type BeforeColumn = [u32; 3];

/// Bytes of a `Column`, a `Surface`, a `Partial`, and of what is summed before faces.
pub(super) type Column = [f32; 16];
pub(super) type Surface = [f32; 8];
pub(super) type Partial = [f32; 16];
pub(super) type Before = [[f32; 8]; 6];

/// Sums of four numbers.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Account4 {
    pub sum: [f32; 4],
    pub lacking: [f32; 4],
}

impl Account4 {
    pub fn values(&self) -> [f64; 4] {
        [0, 1, 2, 3].map(|k| value([self.sum[k], self.lacking[k]]))
    }
}

/// What a group sums up for gauges: see `dew_measure.wgsl`.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct CardMeasured {
    pub temperature: f32,
    pub vapour: f32,
    pub fog: f32,
    pub fastest: f32,
    pub count: u32,
}

/// It is looked for air of low utility once in so many steps.
pub(super) const TURN: u32 = crate::utility::STEPS as u32;

/// Steps that can be ordered at once.
pub(super) const MOST_STEPS: usize = 64;

/// What the host learns, and says.
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Status {
    pub particles: u32,
    pub cells: u32,
    pub halted: u32,
    pub steps: u32,
    pub particle_steps: [u32; 2],
    pub step: f32,
    pub until: f32,
    pub elapsed: Account,
    pub next_id: u32,
    pub fastest: f32,
    pub came: Account4,
    pub went: Account4,
    pub diffused: Account4,
    pub fogged: Account,
    pub time: Account,
    pub phase: [Account; 6],
    pub before: [f32; 6],
    pub spreading_before: [f32; 6],
    pub density_excess_beyond: [f32; 6],
    pub running_mean_before: [f32; 6],
    pub seen: Account,
    pub turn: u32,
    pub spare: [u32; 3],
    pub drift: [f32; 2],
    pub lengths: [f32; MOST_STEPS],
}

/// Values of [`Status::halted`]: broken down; the host has said until when to go on; more air may come than there is room for.
pub(super) const BROKEN: u32 = 2;
pub(super) const SPOKEN: u32 = 3;
pub(super) const FULL: u32 = 4;

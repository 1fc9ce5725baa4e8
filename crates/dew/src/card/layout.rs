//! Numbers as the shaders see them: `dew_card.wgsl` has the same in the same order.
//!
//! Single precision has some 7 digits. They are not to be spent on where the room is, nor on the 300 K and the part of vapour that all
//! air has in common: places are counted from the middle of the room, temperature and vapour from those of the ambient air. What grows by
//! little in a step is kept as a sum with what it has too much.

use crate::air::{Particle, Role};
use crate::room::Room;
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

/// Fans that there is room for.
pub(crate) const MOST_FANS: usize = 8;

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
    pub of_moment: f32,
    pub of_pressure: f32,
    pub of_spread: f32,
    pub of_laplacian: f32,
    pub of_pair: f32,
    pub mass: f32,
    pub heat_capacity: f32,
    pub latent_heat: f32,
    pub heat_diffusivity: f32,
    pub vapour_diffusivity: f32,
    pub diffusivity: f32,
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
    pub inlets: [Inlet; 6],
    pub fan: [CardFan; MOST_FANS],
}

/// Values of [`Parameters::flags`].
pub(super) const IS_PASSED: u32 = 1;
pub(super) const DIFFUSES: u32 = 2;
pub(super) const FOGS: u32 = 4;
pub(super) const SATURATES: u32 = 8;
pub(super) const REFUSES_FAST: u32 = 16;
pub(super) const RELATIVE: u32 = 32;

/// What the faces do.
pub(super) const WALL: u32 = 0;
pub(super) const PERIODIC: u32 = 1;
pub(super) const INLET: u32 = 2;
pub(super) const OUTLET: u32 = 3;

const INSIDE: u32 = 0;
const COMING: u32 = 1;
const LEAVING: u32 = 2;

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
    pub evenness: f32,
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

/// Water on a particle of a solid.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct CardWater {
    pub told: f32,
    pub unused: f32,
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
}

/// Bytes of a `Column`, a `Surface`, a `Partial`, and of what is summed before faces.
pub(super) type Column = [f32; 12];
pub(super) type Surface = [f32; 8];
pub(super) type Partial = [f32; 16];
pub(super) type Before = [[f32; 2]; 6];

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
    pub unused: [f32; 2],
    pub phase: [Account; 6],
    pub before: [f32; 6],
    pub spare: [f32; 2],
    pub lengths: [f32; MOST_STEPS],
}

/// Values of [`Status::halted`]: broken down; and the host has said until when to go on.
pub(super) const BROKEN: u32 = 2;
pub(super) const SPOKEN: u32 = 3;

/// Where the shaders count from.
#[derive(Debug, Clone, Copy)]
pub(super) struct Origin {
    pub room: Room,
    /// Temperature, K, and part of the mass that is vapour.
    pub temperature: f64,
    pub vapour: f64,
}

impl Origin {
    fn middle(&self, axis: usize) -> f64 {
        0.5 * (self.room.low[axis] + self.room.high[axis])
    }

    /// A place from the middle of the room.
    pub fn relative(&self, place: [f64; 3]) -> [f32; 3] {
        [0, 1, 2].map(|axis| (place[axis] - self.middle(axis)) as f32)
    }

    /// The same for a parcel: rounding must not put it over a high face.
    fn parcel(&self, place: [f64; 3]) -> [f32; 3] {
        let (high, relative) = (self.relative(self.room.high), self.relative(place));
        [0, 1, 2].map(|axis| {
            let is_inside = place[axis] < self.room.high[axis];
            if is_inside { relative[axis].min(high[axis].next_down()) } else { relative[axis] }
        })
    }

    pub fn to_card(self, particle: &Particle) -> CardParticle {
        let narrow = |vector: [f64; 3]| vector.map(|along| along as f32);
        CardParticle {
            place: self.parcel(particle.position),
            density: particle.density as f32,
            velocity: narrow(particle.velocity),
            fog: particle.fog as f32,
            acceleration: narrow(particle.acceleration),
            spreading: narrow(particle.spreading),
            id: particle.id as u32,
            temperature: account(particle.temperature - self.temperature),
            vapour: account(particle.vapour - self.vapour),
            role: role(particle.role),
            evenness: 1.0,
            ..CardParticle::default()
        }
    }

    pub fn to_host(self, particle: &CardParticle) -> Particle {
        let wide = |vector: [f32; 3]| vector.map(f64::from);
        let place = wide(particle.place);
        Particle {
            position: [0, 1, 2].map(|axis| place[axis] + self.middle(axis)),
            velocity: wide(particle.velocity),
            acceleration: wide(particle.acceleration),
            spreading: wide(particle.spreading),
            temperature: value(particle.temperature) + self.temperature,
            vapour: value(particle.vapour) + self.vapour,
            fog: f64::from(particle.fog),
            density: f64::from(particle.density),
            id: u64::from(particle.id),
            role: role_of(particle.role),
            idle: 0.0,
        }
    }
}

/// As `dew_card.wgsl` has roles. Those of low utility and of open sides are refused before the run starts.
fn role(role: Role) -> u32 {
    let of_face = |kind: u32, axis: u8, side: u8| kind | ((2 * u32::from(axis) + u32::from(side)) << 4);
    match role {
        Role::Coming(axis, side) => of_face(COMING, axis, side),
        Role::Leaving(axis, side) => of_face(LEAVING, axis, side),
        Role::Inside | Role::Outside(..) | Role::Still | Role::Gone | Role::Idle => INSIDE,
    }
}

fn role_of(role: u32) -> Role {
    let face = (role >> 4) as u8;
    match role & 15 {
        COMING => Role::Coming(face / 2, face % 2),
        LEAVING => Role::Leaving(face / 2, face % 2),
        _ => Role::Inside,
    }
}

//! Numbers as the shaders see them: `flood_card.wgsl` and `flood_columns.wgsl` have the same in the same order.

use crate::particle::Particle;
use bytemuck::{Pod, Zeroable};

/// Square cells; no columns: there is nothing in them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Grid {
    pub corner: [f32; 2],
    pub cell: f32,
    pub per_cell: f32,
    pub columns: u32,
    pub rows: u32,
    pub unused: [f32; 2],
}

/// Numbers of the run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Parameters {
    /// West, east, south, north, m from the centre.
    pub bounds: [f32; 4],
    pub rules: [u32; 4],
    /// Key of the random numbers.
    pub key: [u32; 8],
    pub grid: Grid,
    pub walls: Grid,
    pub outlines: Grid,
    pub ground_corner: [f32; 2],
    pub ground_per_metre: [f32; 2],
    pub ground_patches: [u32; 2],
    pub farthest: u32,
    pub friction: u32,
    pub roughness: f32,
    pub gravity: f32,
    pub eta: f32,
    pub largest_h: f32,
    pub viscosity: f32,
    pub cfl: f32,
    pub longest_step: f32,
    pub shortest_step: f32,
    pub new_volume: f32,
    pub new_h: f32,
    pub spacing: f32,
    pub obstacles: u32,
    pub rough_corner: [f32; 2],
    pub rough_per_metre: [f32; 2],
    pub rough_cells: [u32; 2],
    pub smoothing: f32,
    pub rain: u32,
    pub patches_per_metre: [f32; 2],
    pub patches: [u32; 2],
    pub patch_area: f32,
    pub film: f32,
    pub drop_h: f32,
    pub scheme: u32,
    pub before: f32,
    pub reach_over_h: f32,
    pub in_air: u32,
    pub fall_step: f32,
    pub rest_density: f32,
    pub gas_constant: f32,
    pub sph_swe_viscosity: f32,
    pub clips_pressure: u32,
    pub control: u32,
    pub control_strength: f32,
    pub control_square: f32,
    pub first_h: f32,
    pub widest_h: f32,
    /// 0, which compilers cannot tell.
    pub zero: u32,
    /// Of splitting and merging, as [`crate::refinement::Refinement`] has them; `widest` is 0 where there is none.
    pub widest: f32,
    pub smallest: f32,
    pub largest: f32,
    /// Lists of neighbours: where they begin, how far the next four numbers of one are off, and how many neighbours a list takes.
    pub near_first: u32,
    pub near_stride: u32,
    pub most_near: u32,
}

/// Scheme sph-swe.
pub(super) const SPH_SWE: u32 = 1;

/// What the sides do.
pub(super) const OPEN: u32 = 0;
pub(super) const WALL: u32 = 1;
pub(super) const PERIODIC: u32 = 2;
pub(super) const STAGE: u32 = 3;

/// How the ground slows the water.
pub(super) const SMOOTH: u32 = 0;
pub(super) const MANNING: u32 = 1;
pub(super) const CHEZY: u32 = 2;
pub(super) const LINEAR: u32 = 3;
pub(super) const MAPPED: u32 = 4;

/// What the host learns, and says.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Status {
    pub particles: u32,
    pub cells: u32,
    pub halted: u32,
    pub steps: u32,
    pub particle_steps: [u32; 2],
    pub step: f32,
    pub until: f32,
    /// Sums with what they lack.
    pub elapsed: [f32; 2],
    pub outflow: [f32; 2],
    pub inflow: [f32; 2],
    pub momentum_lost: [f32; 2],
    pub momentum_gained: [f32; 2],
    pub from_outside: [f32; 2],
    pub mean_h: f32,
    pub look: f32,
    pub low: [f32; 2],
    pub high: [f32; 2],
    pub births: u32,
    pub born: u32,
    pub next_id: u32,
    pub steps_before: u32,
    pub falling: u32,
    pub unused: u32,
    pub stages: [f32; 4],
    pub next_stages: [f32; 4],
    pub rained: [f32; 2],
    pub infiltrated: [f32; 2],
    pub wetted: f32,
    pub unused_too: f32,
    pub clock: [f32; 2],
    /// Rows of gauges: how many times the host has told of, how many of them were taken before this step, how many are due in it, and
    /// how many places each looks at.
    pub rows_told: u32,
    pub rows_taken: u32,
    pub rows_due: u32,
    pub gauge_places: u32,
    /// Looks at the maps: how many times the host has told of, and how many of them have passed; when it was last looked, since the host spoke, and
    /// for how long it had not been before that, s.
    pub looks_told: u32,
    pub looks_taken: u32,
    pub looked: f32,
    pub since_look: f32,
    /// Their cells, the depth above which one is wet, m, and when the host spoke, s.
    pub map_cells: u32,
    pub wet_depth: f32,
    pub began: f32,
    pub unused_three: f32,
}

/// Values of [`Status::halted`]: broken down; and the host has said until when to go on.
pub(super) const BROKEN: u32 = 2;
pub(super) const SPOKEN: u32 = 3;

/// A particle, its place from the centre and its ground above the level that heights are counted from.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct CardParticle {
    pub place: [f32; 2],
    pub velocity: [f32; 2],
    pub acceleration: [f32; 2],
    pub volume: f32,
    pub weight: f32,
    pub h: f32,
    pub next_h: f32,
    pub depth: f32,
    pub ground: f32,
    pub surface_slope: [f32; 2],
    pub id: u32,
    pub outside: u32,
}

/// A particle that is to come, and the zone where.
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(super) struct CardBirth {
    pub velocity: [f32; 2],
    pub time: f32,
    pub zone: u32,
}

/// A particle in the air.
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(super) struct CardDrop {
    pub place: [f32; 2],
    pub velocity: [f32; 2],
    pub z: f32,
    pub w: f32,
    pub volume: f32,
    pub h: f32,
    pub id: u32,
    pub is_up: u32,
}

/// A boundary particle.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct WallSite {
    pub place: [f32; 2],
    pub normal: [f32; 2],
    pub area: f32,
    pub obstacle: u32,
    /// Its area as scheme sph-swe has it, m2.
    pub volume: f32,
    pub unused: f32,
}

/// Where particles may touch an obstacle, the force on it now, and its sum over time with what that lacks.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct OnObstacle {
    pub low: [f32; 2],
    pub high: [f32; 2],
    pub force: [f32; 2],
    pub impulse: [[f32; 2]; 2],
    pub unused: [f32; 2],
}

/// A cell of the maps: see `flood_maps.wgsl`.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct CardCell {
    pub place: [f32; 2],
    pub max_depth: f32,
    pub max_speed: f32,
    pub hazard: f32,
    pub arrival: f32,
    pub duration: f32,
    pub unused: f32,
}

/// A cell of the ground that rain falls on.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct Patch {
    pub film: f32,
    pub factor: f32,
    pub soaked: [f32; 2],
    pub law: u32,
    pub gain: f32,
    pub demand: f32,
    pub is_deep: u32,
}

/// What is to become of a particle that may be split or merged.
pub(super) type Plan = [u32; 2];

/// The parts of a metre in which the ground counts what it takes of particles.
pub(super) const DEPTH: f64 = 1e10;

/// What a `vec3f` takes in an array.
pub(super) type Push = [f32; 4];

/// The part of a particle's volume times m/s that impulses of particles put back are counted in.
pub(super) const KNOCK: f64 = 1e-4;

/// Bytes of a `Column`, of `Slopes` and of a `Partial`.
pub(super) type Column = [f32; 8];
pub(super) type Slopes = [f32; 16];
pub(super) type Partial = [f32; 14];

/// Where the shaders count from, in model coordinates: single precision has some 7 digits, which are not to be spent on the place of
/// the whole.
#[derive(Debug, Clone, Copy)]
pub(super) struct Origin {
    pub centre: [f64; 2],
    pub level: f64,
}

impl Origin {
    /// A place from the centre.
    pub fn relative(self, place: [f64; 2]) -> [f32; 2] {
        [0, 1].map(|axis| (place[axis] - self.centre[axis]) as f32)
    }

    pub fn to_card(self, particle: &Particle) -> CardParticle {
        CardParticle {
            place: self.relative([particle.x, particle.y]),
            velocity: [particle.u, particle.v].map(|value| value as f32),
            acceleration: [particle.ax, particle.ay].map(|value| value as f32),
            volume: particle.volume as f32,
            weight: particle.weight as f32,
            h: particle.h as f32,
            next_h: particle.next_h as f32,
            depth: particle.depth as f32,
            ground: (particle.ground - self.level) as f32,
            surface_slope: particle.surface_slope.map(|value| value as f32),
            id: particle.id as u32,
            outside: particle.outside.map_or(0, |side| u32::from(side) + 1),
        }
    }

    /// But for the slope of the ground, which is the terrain's.
    pub fn to_host(self, particle: &CardParticle) -> Particle {
        let wide = |pair: [f32; 2]| pair.map(f64::from);
        let ([x, y], [u, v], [ax, ay]) = (wide(particle.place), wide(particle.velocity), wide(particle.acceleration));
        Particle {
            x: x + self.centre[0],
            y: y + self.centre[1],
            u,
            v,
            ax,
            ay,
            volume: f64::from(particle.volume),
            weight: f64::from(particle.weight),
            h: f64::from(particle.h),
            next_h: f64::from(particle.next_h),
            depth: f64::from(particle.depth),
            ground: f64::from(particle.ground) + self.level,
            ground_slope: [0.0; 2],
            surface_slope: wide(particle.surface_slope),
            outside: particle.outside.checked_sub(1).map(|side| side as u8),
            id: u64::from(particle.id),
        }
    }
}

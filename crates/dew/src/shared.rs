//! What the host and the shaders of humid air share: one declaration, from which the WGSL comes too.
//!
//! Single precision has some 7 digits. They are not to be spent on where the room is, nor on the 300 K and the part of vapour that all
//! air has in common: positions are counted from the middle of the room, temperature and vapour from those of the ambient air. What grows by
//! little in a step is kept as a compensated sum, a value and its error term.

use corpuscle_gpu::{AtomicI32, AtomicU32, DeviceParticles, Stepping, from_pair, to_pair};

corpuscle_gpu::declare! {
    include [Stepping]
    constants {
        /// Flag of [`Parameters::flags`]: air enters and leaves by faces.
        pub const IS_PASSED: u32 = 1;
        /// Vapour diffuses to surfaces; else particles that are colder than their dew point deposit their excess.
        pub const DIFFUSES: u32 = 2;
        /// Vapour beyond saturation becomes fog.
        pub const FOGS: u32 = 4;
        /// There is a search for supersaturated vapour.
        pub const SATURATES: u32 = 8;
        /// Air faster than sound is refused.
        pub const REFUSES_FAST: u32 = 16;
        /// What diffuses is relative humidity.
        pub const RELATIVE: u32 = 32;
        /// There is a search for air of low utility.
        pub const FINDS_LOW_UTILITY: u32 = 64;
        /// No air enters or leaves.
        pub const IS_CLOSED: u32 = 128;
        /// Conductivities of air and solid are harmonically averaged; else arithmetically.
        pub const IS_HARMONIC: u32 = 256;
        /// What a face does: it is a wall.
        pub const WALL: u32 = 0;
        /// It is joined to the opposite one.
        pub const PERIODIC: u32 = 1;
        /// Air comes in.
        pub const INLET: u32 = 2;
        /// Air leaves.
        pub const OUTLET: u32 = 3;
        /// Particles are advected by the flow.
        pub const OPEN: u32 = 4;
        /// Number of faces, and what stands for none of them.
        pub const NO_FACE: u32 = 6;
        /// Role of a particle: in the room. Roles of a face have its number, twice the axis and 1 for the high side, in higher bits.
        pub const INSIDE: u32 = 0;
        /// Before an inlet.
        pub const COMING: u32 = 1;
        /// Beyond an outlet.
        pub const LEAVING: u32 = 2;
        /// Beyond an open side.
        pub const OUTSIDE: u32 = 3;
        /// It stays.
        pub const STILL: u32 = 4;
        /// Of low utility.
        pub const IDLE: u32 = 5;
        /// Bits of a role below the number of its face.
        pub const FACE_BITS: u32 = 4;
        /// Those bits.
        pub const ROLE_MASK: u32 = 15;
        /// Flag of [`Site::flags`]: a boundary particle.
        pub const BOUNDARY: u32 = 1;
        /// Air can come within reach of it.
        pub const NEAR_SURFACE: u32 = 2;
        /// It counts in the density of the air.
        pub const JOINS_DENSITY: u32 = 4;
        /// It repels air.
        pub const REPELS: u32 = 8;
        /// A ghost sample.
        pub const GHOST: u32 = 16;
        /// Its temperature is held.
        pub const HELD: u32 = 32;
        /// A ghost particle beyond a side that air passes.
        pub const GHOST_PARTICLE_BEYOND: u32 = 64;
        /// Steps between two searches for air of low utility.
        pub const TURN: u32 = crate::constants::UTILITY_STEPS as u32;
        /// Groups that share the particles when they are summed up for gauges.
        pub const MEASURING_GROUPS: u32 = 64;
        /// Fans that there is room for: 48 KiB of the 64 that every device has for numbers of this kind.
        pub const MOST_FANS: u32 = 1024;
        /// Distance beyond a face that air passes at which it is removed, in smoothing lengths.
        pub const BEYOND: f32 = crate::constants::BEYOND as f32;
        /// Depth of the layer before an outlet whose mean velocity air beyond takes, in spacings.
        pub const OUTLET_LAYER: f32 = crate::constants::OUTLET_LAYER as f32;
        /// Acceleration limits the time step: this times the root of spacing over acceleration.
        pub const ACCELERATION_LIMIT: f32 = crate::constants::ACCELERATION_LIMIT as f32;
        /// Part of the longest step for which no diffusion overshoots its neighbours.
        pub const DIFFUSION_LIMIT: f32 = crate::constants::DIFFUSION_LIMIT as f32;
        /// Coefficient of vapour in the virtual temperature.
        pub const VAPOUR_LIGHTNESS: f32 = crate::humid_air::VAPOUR_LIGHTNESS as f32;
        /// Damping of particles that approach each other.
        pub const DAMPING: f32 = crate::air::DAMPING as f32;
        /// Strength of the virtual force of solids, over density and the square of the speed of sound.
        pub const STRENGTH: f32 = crate::constants::STRENGTH as f32;
        /// Its range, in spacings.
        pub const RANGE: f32 = crate::constants::RANGE as f32;
        /// Largest eigenvalue of a tensor of normalisation.
        pub const MAX_EIGENVALUE: f32 = crate::normalisation::MAX_EIGENVALUE as f32;
        /// Displacement after which distances from solids are compared, in smoothing lengths.
        pub const PROBE_STEP: f32 = crate::constants::PROBE_STEP as f32;
        /// Iterations of Newton's method for the temperature of a surface.
        pub const ITERATIONS: u32 = crate::constants::ITERATIONS as u32;
        /// Constants of the formula of saturation, Bolton 1980: its factor, and °C.
        pub const BOLTON_B: f32 = crate::humid_air::B as f32;
        /// See above.
        pub const BOLTON_C: f32 = crate::humid_air::C as f32;
        /// Molar mass of water over that of dry air.
        pub const MASS_RATIO: f32 = crate::humid_air::MASS_RATIO as f32;
    }
    structs {
        /// Compensated sums of four numbers (Kahan 1965): values and error terms, to be added.
        pub struct FourSums {
            /// The values.
            pub values: [f32; 4],
            /// Error terms.
            pub errors: [f32; 4],
        }

        /// Air as it comes in by a face.
        pub struct Inlet {
            /// m/s.
            pub velocity: [f32; 3],
            /// From the ambient air's, K.
            pub temperature: f32,
            /// From the ambient air's, part of the mass.
            pub vapour: f32,
            /// Where a new layer stands, m beyond the face.
            pub behind: f32,
            /// Where its temperatures over time begin and end among the values, and its vapour; none where they do not change.
            pub temperature_first: u32,
            pub temperature_end: u32,
            pub vapour_first: u32,
            pub vapour_end: u32,
            /// Fills up.
            pub unused: [f32; 2],
        }

        /// A box in which air is accelerated along a direction.
        pub struct Fan {
            /// Its low corner, m.
            pub low: [f32; 3],
            /// Rate of the acceleration, 1/s.
            pub rate: f32,
            /// Its high corner, m.
            pub high: [f32; 3],
            /// The speed to reach, m/s.
            pub speed: f32,
            /// Unit vector.
            pub direction: [f32; 3],
            /// Fills up.
            pub unused: f32,
        }

        /// Numbers of the run.
        pub struct Parameters {
            /// Low corner of the room, m from its middle.
            pub low: [f32; 3],
            /// The kernels' support, m.
            pub h: f32,
            /// High corner of the room.
            pub high: [f32; 3],
            /// m.
            pub spacing: f32,
            /// What the faces do: at low and high x, low and high y; at low and high z.
            pub faces: [[u32; 4]; 2],
            /// Lowest corner of the cells, m.
            pub corner: [f32; 3],
            /// Cells per metre.
            pub per_cell: f32,
            /// Cells along each axis.
            pub cells: [u32; 3],
            /// [`IS_PASSED`] and those after it.
            pub flags: u32,
            /// Distance of particles that come in by inlets, m.
            pub apart: [f32; 3],
            /// Number of fans.
            pub fans: u32,
            /// Particles that come in, along each axis.
            pub counts: [u32; 3],
            /// 1/m.
            pub per_h: f32,
            /// m/s2.
            pub gravity: [f32; 3],
            /// Artificial speed of sound, m/s.
            pub sound: f32,
            /// Acceleration of all air, m/s2.
            pub driven: [f32; 3],
            /// Kinematic viscosity, m2/s.
            pub viscosity: f32,
            /// Of the air, kg/m3.
            pub density: f32,
            /// At which the pressure is that at rest, kg/m3.
            pub rest_density: f32,
            /// How dense solids are for the air.
            pub kappa: f32,
            /// Factor of sums over (1 - q^2)^3, with q = r/h.
            pub of_filling: f32,
            /// Over (1 - q) q q q q/|q|^2.
            pub of_moments: f32,
            /// Over (1 - q)^2, times pressures.
            pub of_pressure: f32,
            /// Over (1 - q)^2.
            pub of_spread: f32,
            /// Over 1 - q.
            pub of_laplacian: f32,
            /// Conductance over conductivity of a pair of air and solid, m.
            pub of_pair: f32,
            /// Of a particle, kg.
            pub mass: f32,
            /// J/(kg K).
            pub heat_capacity: f32,
            /// J/kg.
            pub latent_heat: f32,
            /// m2/s.
            pub heat_diffusivity: f32,
            /// m2/s.
            pub vapour_diffusivity: f32,
            /// m2/s.
            pub largest_diffusivity: f32,
            /// Twice density times diffusivity of vapour, kg/(m s).
            pub vapour_reach: f32,
            /// Temperature of the ambient air, K.
            pub ambient: f32,
            /// Its vapour, part of the mass.
            pub ambient_vapour: f32,
            /// Its temperature, °C.
            pub celsius: f32,
            /// Pa.
            pub air_pressure: f32,
            /// Times the gradient of crowding, m2/s2.
            pub spreading: f32,
            /// Farthest that a particle is put in a step, m.
            pub farthest: f32,
            /// Part of a smoothing length that sound may cross in a step.
            pub cfl: f32,
            /// s.
            pub shortest_step: f32,
            /// Least speed beyond outlets, m/s.
            pub slowest: f32,
            /// Pressure of saturated vapour at the ambient temperature, Pa.
            pub saturated: f32,
            /// Vapour pressure of the ambient air, Pa.
            pub ambient_pressure: f32,
            /// Always 0; read at run time so that the optimiser keeps compensated sums.
            pub zero: u32,
            /// How far beyond an open side the last particle of a full column stands, m, by axis.
            pub deepest: [f32; 3],
            /// With more particles than this the host has to make room.
            pub full: u32,
            /// The first node at which distances to solids are known, m.
            pub field_corner: [f32; 3],
            /// Nodes per metre.
            pub per_node: f32,
            /// Nodes along each axis.
            pub nodes: [u32; 3],
            /// Air is of low utility beyond this distance, m.
            pub low_beyond: f32,
            /// It is taken out beyond this distance, m.
            pub useless_beyond: f32,
            /// After so long, s.
            pub low_after: f32,
            /// How many times faster than in reality solids and water on them change.
            pub time_factor: f32,
            /// What the ambient air lacks to be saturated, part of the mass.
            pub lacking: f32,
            /// Temperature coefficient of viscosity, 1/K.
            pub viscosity_per_kelvin: f32,
            /// Of conductivity, 1/K.
            pub conductivity_per_kelvin: f32,
            /// Of the diffusivity of vapour, 1/K.
            pub diffusivity_per_kelvin: f32,
            /// Temperature at which properties are as uploaded, from the ambient air's, K.
            pub reference: f32,
            /// By low and high x, y, z.
            pub inlets: [Inlet; 6],
        }

        /// A particle of air; temperature, K, and vapour, part of the mass, are counted from the ambient air's.
        pub struct Particle {
            /// m.
            pub position: [f32; 3],
            /// kg/m3.
            pub density: f32,
            /// m/s.
            pub velocity: [f32; 3],
            /// Part of the mass.
            pub fog: f32,
            /// m/s2.
            pub acceleration: [f32; 3],
            /// Water that it lays on solids near, kg, over the sum of their weights.
            pub deposit: f32,
            /// Acceleration of the transport velocity, m/s2.
            pub spreading: [f32; 3],
            /// Its number.
            pub id: u32,
            /// K.
            pub temperature: [f32; 2],
            /// Part of the mass.
            pub vapour: [f32; 2],
            /// [`INSIDE`] and those after it.
            pub role: u32,
            /// For how long it has been of low utility, s.
            pub idle: f32,
            /// Fills up.
            pub unused: [f32; 2],
        }

        /// A particle as it lies in memory: devices read sixteen bytes at a time where they are uploaded so, and a [`Particle`] member by member.
        pub struct Packed {
            /// See [`Particle`].
            pub position_and_density: [f32; 4],
            /// See [`Particle`].
            pub velocity_and_fog: [f32; 4],
            /// See [`Particle`].
            pub acceleration_and_deposit: [f32; 4],
            /// See [`Particle`].
            pub spreading_and_id: [u32; 4],
            /// See [`Particle`].
            pub temperature_and_vapour: [f32; 4],
            /// See [`Particle`].
            pub role_and_idle: [u32; 4],
        }

        /// Values of a particle that its neighbours read: a search reads only the first part of those out of reach.
        pub struct PackedColumn {
            /// m; pressure over the square of the density, Pa m6/kg2.
            pub position_and_pressure: [f32; 4],
            /// m/s; K.
            pub velocity_and_temperature: [f32; 4],
            /// Diagonal of the tensor of normalisation; vapour, part of the mass.
            pub diagonal_and_vapour: [f32; 4],
            /// Its other elements, doubled; what of the vapour diffuses.
            pub doubled_and_humidity: [f32; 4],
        }

        /// What a group of threads sums up over its particles.
        pub struct Partial {
            /// Of particles that entered: number, temperature, vapour and fog.
            pub came: [f32; 4],
            /// Of particles that left.
            pub went: [f32; 4],
            /// What diffused, K/s and 1/s.
            pub diffused: [f32; 2],
            /// Vapour that became fog, part of a particle's mass.
            pub fogged: f32,
            /// The longest step, s.
            pub longest: f32,
            /// Square of the largest speed, m2/s2.
            pub fastest: f32,
            /// Fills up.
            pub unused: f32,
            /// Fills up.
            pub unused_more: [f32; 2],
        }

        /// Sums over the air before a face, along the face's axis.
        pub struct BeforeOutlet {
            /// Within a smoothing length: acceleration, m/s2, velocity, m/s, and number.
            pub near: [f32; 3],
            /// Fills up.
            pub unused: f32,
            /// Nearest to it: `spreading`, m/s2, and number.
            pub nearest: [f32; 2],
            /// Fills up.
            pub unused_more: [f32; 2],
        }

        /// What the particles before a column sum up to, whatever their order: whole numbers.
        pub struct BeforeColumn {
            /// In units of `dew_columns.wgsl`.
            pub velocity: AtomicI32,
            /// Number of particles.
            pub count: AtomicU32,
            /// How far out its last particle is, as bits.
            pub outermost: AtomicU32,
        }

        /// A particle of a solid, its ghost particle, a ghost sample, or, with its pairs and capacity alone, a cell of a wall behind a solid.
        pub struct Site {
            /// m.
            pub position: [f32; 3],
            /// Over that of a particle of air.
            pub volume: f32,
            /// Conductivity with which the air is warmed, W/(m K).
            pub to_air: f32,
            /// Conductivity with which the solid is.
            pub to_solid: f32,
            /// Part of the heat at the surface that goes to the solid.
            pub part: f32,
            /// [`BOUNDARY`] and those after it.
            pub flags: u32,
            /// Number of the particle.
            pub particle: u32,
            /// First of its pairs in the list of conductances.
            pub first: u32,
            /// After the last of them.
            pub end: u32,
            /// J/K.
            pub capacity: f32,
        }

        /// Water on a particle of a solid.
        pub struct Water {
            /// When the host last uploaded, kg.
            pub uploaded: f32,
            /// Part of the evaporation of a wet surface that it lets go.
            pub evaporation: f32,
            /// Gained since, kg.
            pub gained: [f32; 2],
        }

        /// What else changes of a particle of a solid.
        pub struct Solid {
            /// From the ambient air's, K.
            pub temperature: [f32; 2],
            /// Heat through the surface in the last step, W.
            pub flow: f32,
            /// Heat that it was held against in the last step, J.
            pub held: f32,
            /// How stiff diffusion was, 1/s.
            pub stiff: f32,
            /// Water that the air gave, kg.
            pub water: f32,
        }

        /// State of a particle of a solid for the air in a step, and what the particle receives.
        pub struct Surface {
            /// From the ambient air's, K.
            pub temperature: f32,
            /// kg.
            pub water: f32,
            /// Part of the required evaporation for which there is water.
            pub share: f32,
            /// Heat from the air, W.
            pub heat: f32,
            /// With that through the solid, W.
            pub all_heat: f32,
            /// Water, kg/s.
            pub gain: f32,
            /// To air and within the solid, W/K.
            pub conductance: f32,
            /// As of [`Water`].
            pub evaporation: f32,
        }

        /// A solid or a wall: its particles or cells, and what they sum up to.
        pub struct Body {
            /// First of them.
            pub first: u32,
            /// After the last of them.
            pub end: u32,
            /// Heat through the surface, W.
            pub flow: f32,
            /// How stiff diffusion was, 1/s.
            pub stiff: f32,
            /// Heat that it was held against, J.
            pub held: [f32; 2],
            /// First of its rows, where the temperature at which it is held changes.
            pub first_row: u32,
            /// After the last of them.
            pub end_row: u32,
            /// Water that the air gave, kg.
            pub water: f32,
            /// Fills up.
            pub unused: f32,
        }

        /// A value at a time.
        pub struct Row {
            /// s since the state was sent.
            pub time: [f32; 2],
            /// Temperatures are counted from the ambient air's, K.
            pub value: f32,
            /// Fills up.
            pub unused: f32,
        }

        /// Part of a surface that a particle stands for.
        pub struct Part {
            /// m2.
            pub area: f32,
            /// Distance to the particle over the conductivity, m2 K/W.
            pub resistance: f32,
        }

        /// Share of a particle in its solid's heat sources.
        pub struct Share {
            /// Part of the heater's power.
            pub heater: f32,
            /// Fills up.
            pub unused: f32,
            /// Its surface in a side of the box.
            pub outside: Part,
            /// Its surface in the box.
            pub radiation: Part,
        }

        /// Surroundings of a surface.
        pub struct Surroundings {
            /// W/(m2 K).
            pub transfer_coefficient: f32,
            /// Emissivity times the Stefan-Boltzmann constant, W/(m2 K4).
            pub emissivity_sigma: f32,
            /// Rows of the temperature of the air.
            pub air_first: u32,
            /// After the last of them.
            pub air_end: u32,
            /// Rows of the mean radiant temperature.
            pub radiant_first: u32,
            /// After the last of them.
            pub radiant_end: u32,
        }

        /// Heat sources of a solid or a wall.
        pub struct Source {
            /// Factor of the heater's power.
            pub power_factor: f32,
            /// Fills up.
            pub unused: f32,
            /// Rows of the heater's power.
            pub power_first: u32,
            /// After the last of them.
            pub power_end: u32,
            /// Outside the box.
            pub outside: Surroundings,
            /// In the box.
            pub radiation: Surroundings,
            /// Heat that each kind has supplied, J.
            pub supplied: [[f32; 2]; 3],
        }

        /// A column of air outside an open side.
        pub struct OutsideColumn {
            /// How the air before it moves across the side, m/s.
            pub velocity: f32,
            /// Whether no solid is in it.
            pub is_free: u32,
        }

        /// What a group sums up for gauges.
        pub struct Measured {
            /// From the ambient air's, K.
            pub temperature: f32,
            /// From the ambient air's, part of the mass.
            pub vapour: f32,
            /// Part of the mass.
            pub fog: f32,
            /// Square of the largest speed, m2/s2.
            pub fastest: f32,
            /// Particles in the room.
            pub count: u32,
        }

        /// When the air is seen.
        pub struct Shown {
            /// Time from the last step to the time shown, s.
            pub since: f32,
            /// Fills up.
            pub unused: f32,
            /// Fills up.
            pub unused_more: [f32; 2],
        }

        /// What the host learns, and says.
        pub struct Status {
            /// Particles of air; this and the next first: the sort reads them.
            pub particles: u32,
            /// Number of cells.
            pub cells: u32,
            /// [`GOING`](corpuscle_gpu::GOING) and those after it.
            pub halted: u32,
            /// Steps since the start of the batch.
            pub steps: u32,
            /// Low and high half.
            pub particle_steps: [u32; 2],
            /// The next step, s.
            pub step: f32,
            /// Number of the next particle that comes in.
            pub next_id: u32,
            /// Time since the state was sent, s.
            pub time: [f32; 2],
            /// Time at which to halt, s since the state was sent.
            pub until: [f32; 2],
            /// Time of the last search for air of low utility, s since the upload.
            pub seen: [f32; 2],
            /// Vapour that became fog, part of a particle's mass.
            pub fogged: [f32; 2],
            /// Of particles that came: number, temperature, K, vapour and fog, parts of the mass.
            pub came: FourSums,
            /// The same of particles that left.
            pub went: FourSums,
            /// Over the mass of a particle: water that diffused in and out over faces, and energy, J/kg.
            pub diffused: FourSums,
            /// How far the air before each inlet has come since its last layer, m.
            pub phase: [[f32; 2]; 6],
            /// What air beyond each outlet is faster by, m/s.
            pub before: [f32; 6],
            /// The mean `spreading` nearest to each outlet along its axis, m/s2.
            pub spreading_before: [f32; 6],
            /// By how much the air beyond each outlet is denser than at rest, over its density at rest.
            pub density_excess_beyond: [f32; 6],
            /// Running mean of the velocity along its axis of the air before each outlet, m/s.
            pub running_mean_before: [f32; 6],
            /// What all air of a closed room gains in the next step for accelerated time: temperature, K, and vapour, part of the mass.
            pub drift: [f32; 2],
            /// Number of the batch's first step, from one that is a multiple of [`TURN`].
            pub turn: u32,
            /// Length of the last step, s.
            pub last_step: f32,
            /// Square of the largest speed in the last step, m2/s2.
            pub fastest: f32,
            /// Fills up.
            pub unused: u32,
            /// Fills up.
            pub unused_more: [u32; 2],
        }
    }

    /// What the passes work on.
    pub buffers Memory {
        /// Numbers of the run.
        uniform parameters: Parameters,
        /// What the host learns, and says.
        storage status: Status,
        /// The air.
        storage particles: [Packed],
        /// The air in the order of its cells.
        storage ordered: [Packed],
        /// Positions in that order, m.
        storage spots: [[f32; 4]],
        /// What neighbours read, in that order.
        storage columns: [PackedColumn],
        /// Sums of groups.
        storage partials: [Partial],
        /// Sums before faces, by group and face.
        storage before: [[BeforeOutlet; 6]],
        /// Sums before the columns outside.
        storage columns_before: [BeforeColumn],
        /// Columns of air outside open sides.
        storage outside_columns: [OutsideColumn],
        /// Particles in each cell.
        storage counts: [AtomicU32],
        /// The cell of each particle, and its number there.
        storage cell_slots: [[u32; 2]],
        /// Numbers of particles, by which those of a cell are put in order.
        storage keys: [u32],
        /// The first particle of each cell.
        storage start: [u32],
        /// The order of the cells.
        storage order: [u32],
        /// Slots of three numbers, of groups: a thread for each particle, a thread for each cell, a group for each block of 1024 cells, one group, a
        /// thread for each particle of the solids, a group for each solid.
        storage groups: [u32],
        /// The first site of each cell.
        storage site_start: [u32],
        /// What air comes near: particles of solids, ghost particles and ghost samples.
        storage sites: [Site],
        /// The particles of solids themselves, in order, then the cells of walls.
        storage own: [Site],
        /// What changes of them.
        storage solids: [Solid],
        /// Water on them.
        storage waters: [Water],
        /// Their state for the air in a step.
        storage surfaces: [Surface],
        /// Pairs between which heat goes: the other, and the bits of the conductance, W/K.
        storage pairs: [[u32; 2]],
        /// Solids and walls.
        storage bodies: [Body],
        /// Values over time.
        storage rows: [Row],
        /// Shares of the particles in heat sources.
        storage shares: [Share],
        /// Heat sources of solids and walls.
        storage sources: [Source],
        /// Sums for gauges.
        storage measured: [Measured],
        /// Distances to solids, m.
        storage field: [f32],
        /// The fans.
        uniform fans: [Fan; MOST_FANS as usize],
        /// When the air is seen.
        uniform seen_at: Shown,
        /// The air as it is drawn.
        storage drawn: DeviceParticles,
    }
}

const _: () = assert!(size_of::<Particle>() == size_of::<Packed>(), "two forms of one thing");

impl FourSums {
    /// The values of the sums.
    pub fn values(&self) -> [f64; 4] {
        std::array::from_fn(|k| from_pair([self.values[k], self.errors[k]]))
    }
}

impl Row {
    /// A value at a time, counted from `start`, s.
    pub fn new([time, value]: [f64; 2], start: f64) -> Self {
        Self { time: to_pair(time - start), value: value as f32, unused: 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::pieces;
    use corpuscle_gpu::Buffers;
    use corpuscle_scene::KernelName;
    use corpuscle_sph::kernel::Kernel;

    /// Each pass with what it imports and the bindings that it uses.
    #[test]
    fn every_shader_is_valid_and_within_the_floor() {
        let mut left = vec![std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src")];
        let mut count = 0;
        while let Some(path) = left.pop() {
            if path.is_dir() {
                left.extend(std::fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap_or_default();
            if path.extension().is_none_or(|extension| extension != "wgsl") || !text.contains("@compute") {
                continue;
            }
            let name = path.file_stem().unwrap().to_str().unwrap();
            for kernel in KernelName::ALL {
                let kernel = Kernel::<3>::device_piece(kernel);
                let whole = Memory::declaration().complete(name, &text, &pieces(&kernel)).unwrap().0;
                corpuscle_gpu::check_shader(&whole).unwrap_or_else(|error| panic!("{name}.wgsl: {error}"));
            }
            count += 1;
        }
        assert!(count >= 14, "{count}");
    }

    #[test]
    fn rust_and_wgsl_lay_structures_out_alike() {
        corpuscle_gpu::check_layouts(&Memory::declaration()).unwrap();
    }
}

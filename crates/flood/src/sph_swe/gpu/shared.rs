//! Constants and structures shared by the host and the shaders of scheme `sph-swe`: one declaration, from which the WGSL is generated too.

use corpuscle_gpu::{AtomicI32, AtomicU32, DeviceParticles, Stepping};

corpuscle_gpu::declare! {
    include [Stepping]
    constants {
        /// Circumference of a circle over its width.
        pub const PI: f32 = std::f32::consts::PI;
        /// Normalisation of the cubic spline in two dimensions over h^2.
        pub const SIGMA: f32 = corpuscle_sph::kernel::CubicSpline::<2>::SIGMA as f32;
        /// Random positions for each spawned particle.
        pub const SPAWN_CANDIDATES: u32 = super::super::inflow::SPAWN_CANDIDATES as u32;
        /// The first slot of [`Memory::groups`] for gauges: a thread for each particle and drop, a group for each row, a thread for each position and row.
        pub const GAUGES: u32 = 5;
        /// The slot for maps: a thread for each of their cells.
        pub const MAPS: u32 = 8;
        /// No cell.
        pub const NONE: u32 = u32::MAX;
        /// Water leaves over the side.
        pub const OPEN: u32 = 0;
        /// The side is a mirror.
        pub const WALL: u32 = 1;
        /// The side is joined to the opposite one.
        pub const PERIODIC: u32 = 2;
        /// A zone that is a disc.
        pub const DISC: u32 = 0;
        /// A zone that is a band on both sides of a line.
        pub const BAND: u32 = 1;
        /// A drop that is not in the air any more.
        pub const GONE: u32 = 0;
        /// A drop in the air.
        pub const FALLS: u32 = 1;
        /// A drop that has met ground or water in this step.
        pub const LANDS: u32 = 2;
        /// The part of a particle's volume times m/s in which impulses of particles put back are counted: whole numbers add up to the same in any order.
        pub const KNOCK: f32 = 1e-4;
        /// A particle that has come into an obstacle is put this far before its wall, over the particles' distance.
        pub const BEFORE_WALL: f32 = super::super::obstacles::BEFORE_WALL as f32;
        /// Most of a kernel that walls are taken to cover.
        pub const MOST_COVERED: f32 = super::super::obstacles::MOST_COVERED as f32;
        /// Distance beyond an edge at which particles are removed, in smoothing lengths.
        pub const BEYOND: f32 = super::super::boundaries::outflow::BEYOND as f32;
        /// Lowest Froude number of a particle that has left.
        pub const SLOWEST_LEAVING: f32 = super::super::boundaries::outflow::SLOWEST_LEAVING as f32;
        /// How far from an edge a particle has a ghost particle, in reaches.
        pub const GHOST_MARGIN: f32 = super::super::neighbours::GHOST_MARGIN as f32;
        /// Support of the sampling kernel over that of the scheme's.
        pub const SAMPLED: f32 = super::super::SAMPLED as f32;
        /// Share of a position's surroundings that water must cover for the position to be wet.
        pub const COVERED: f32 = super::super::sampling::COVERED as f32;
        /// Radius of a search for the water at a position over the reach of the particles there.
        pub const SEARCH_MARGIN: f32 = super::super::sampling::SEARCH_MARGIN as f32;
        /// Largest depth at a position over that of the deepest particle near it.
        pub const DEEPER: f32 = super::super::sampling::DEEPER as f32;
        /// Threads of a group that samples positions of gauges.
        pub const GAUGE_GROUP: u32 = 64;
        /// Threads of the group that spawns particles: more than [`SPAWN_CANDIDATES`] would only wait.
        pub const SPAWN_GROUP: u32 = 64;
        /// The word of `rows` with the first word of the first row.
        pub const ROWS: u32 = 0;
        /// The word with the number of words of a row.
        pub const STRIDE: u32 = 1;
        /// The word with the number of obstacles.
        pub const OBSTACLE_COUNT: u32 = 2;
        /// The first word of the positions.
        pub const POSITIONS: u32 = 3;
        /// The word of a row with the water in all, m3.
        pub const STORED: u32 = 4;
        /// The word with how long after the last step it is due, s.
        pub const SINCE: u32 = 5;
        /// Words of a row before its obstacles.
        pub const TOTALS: u32 = 6;
        /// Words of an obstacle: force, m4/s2, impulse along each axis as a pair, m4/s, and knocks.
        pub const OF_OBSTACLE: u32 = 8;
        /// Words of a position: depth, m, and velocity, m/s.
        pub const OF_POSITION: u32 = 3;
    }
    structs {
        /// Square cells; empty where there are no columns.
        pub struct Grid {
            /// South-west corner, m.
            pub corner: [f32; 2],
            /// Size of a cell, m.
            pub cell: f32,
            /// Its inverse.
            pub per_cell: f32,
            /// Number of columns.
            pub columns: u32,
            /// Number of rows.
            pub rows: u32,
            /// Padding: structures in a uniform begin at a multiple of 16 bytes.
            pub unused: [f32; 2],
        }

        /// Parameters of the run. Positions are in m from the centre of the ground, heights above that of the ground there.
        pub struct Parameters {
            /// West, east, south and north side of the ground.
            pub bounds: [f32; 4],
            /// Rules of the sides: [`OPEN`], [`WALL`], [`PERIODIC`].
            pub rules: [u32; 4],
            /// Key of the random numbers.
            pub key: [[u32; 4]; 2],
            /// The cells of the particles.
            pub grid: Grid,
            /// The cells of the boundary particles of obstacles.
            pub walls: Grid,
            /// The cells by which outlines of obstacles are found.
            pub outlines: Grid,
            /// South-west node of the ground.
            pub ground_corner: [f32; 2],
            /// Nodes of it per metre.
            pub ground_per_metre: [f32; 2],
            /// Patches between them.
            pub ground_patches: [u32; 2],
            /// South-west corner of the cells of that coefficient, where it differs.
            pub rough_corner: [f32; 2],
            /// Cells of it per metre.
            pub rough_per_metre: [f32; 2],
            /// Number of them along each side; none where it is the same everywhere.
            pub rough_cells: [u32; 2],
            /// Exponent of the depth in the law of friction; negative where it is linear.
            pub friction_exponent: f32,
            /// Coefficient of the law of friction over gravity, where it is the same everywhere: n^2, 1/C^2 or S.
            pub roughness: f32,
            /// Cells of the particles over which the longest reach spreads.
            pub farthest: u32,
            /// m/s2.
            pub gravity: f32,
            /// Time step, s.
            pub time_step: f32,
            /// The longest while drops are in the air, s.
            pub fall_step: f32,
            /// Volume of a new particle, m3.
            pub new_volume: f32,
            /// Smoothing length of a new particle, m.
            pub new_h: f32,
            /// Distance of particles, m.
            pub spacing: f32,
            /// Number of obstacles.
            pub obstacles: u32,
            /// Drops in the air at the start.
            pub in_air: u32,
            /// Density of water, kg/m3.
            pub rest_density: f32,
            /// Gas constant of the pressure, m4/s2 a column.
            pub gas_constant: f32,
            /// Viscosity.
            pub viscosity: f32,
            /// 1 where negative pressures are set to 0.
            pub clips_pressure: u32,
            /// 1 where the control force acts.
            pub control: u32,
            /// Its strength.
            pub control_strength: f32,
            /// Side of its square over the smoothing length.
            pub control_square: f32,
            /// Smoothing length at the start, m.
            pub first_h: f32,
            /// The largest, m.
            pub widest_h: f32,
            /// Always 0; read at run time so that the optimiser keeps compensated sums.
            pub zero: u32,
            /// Fills up.
            pub unused: u32,
            /// Fills up.
            pub unused_too: [u32; 2],
        }

        /// What the host learns, and says. Sums are pairs to be added.
        pub struct Status {
            /// Number of particles. This and the next first: the sort reads them.
            pub particles: u32,
            /// Number of cells.
            pub cells: u32,
            /// [`GOING`](corpuscle_gpu::GOING) and those after it.
            pub halted: u32,
            /// Steps since the batch began.
            pub steps: u32,
            /// Particle-steps since then, low and high half.
            pub particle_steps: [u32; 2],
            /// Time since the cells were last laid out, s. All times count from there, so that it does not matter how many steps a batch has.
            pub clock: [f32; 2],
            /// Time at which to halt, s.
            pub until: [f32; 2],
            /// Time at which the host samples the maps, s: the step that passes it is the last.
            pub host_sample: [f32; 2],
            /// Water that went out, m3.
            pub outflow: [f32; 2],
            /// Water that came in, m3.
            pub inflow: [f32; 2],
            /// Momentum over density that went, m4/s.
            pub momentum_lost: [f32; 2],
            /// Momentum over density that came, m4/s.
            pub momentum_gained: [f32; 2],
            /// Force of ground, edges and obstacles at the last evaluation, m4/s2.
            pub outer_force: [f32; 2],
            /// South-west corner of the water.
            pub low: [f32; 2],
            /// North-east corner of the water.
            pub high: [f32; 2],
            /// Time of the last sample of the maps, s.
            pub last_sample: [f32; 2],
            /// Time between that sample and the one before, s.
            pub since_sample: f32,
            /// The next step, s.
            pub step: f32,
            /// Mean smoothing length, m.
            pub mean_h: f32,
            /// Spawn requests uploaded.
            pub spawn_requests: u32,
            /// Number of them done.
            pub spawned: u32,
            /// The identity of the next new particle.
            pub next_id: u32,
            /// Drops in the air.
            pub falling: u32,
            /// Times of rows of gauges uploaded.
            pub rows_uploaded: u32,
            /// Rows that were filled before this step.
            pub rows_taken: u32,
            /// Rows that are due in it.
            pub rows_due: u32,
            /// Positions in each row.
            pub gauge_positions: u32,
            /// Sample times of the maps uploaded.
            pub map_times_uploaded: u32,
            /// Number of them taken.
            pub map_times_taken: u32,
            /// Cells of the maps.
            pub map_cells: u32,
            /// Depth above which one is wet, m.
            pub wet_depth: f32,
            /// Time at which the clock is 0, s.
            pub clock_began: f32,
        }

        /// A particle as it lies in memory, sixteen bytes at a time.
        pub struct Packed {
            /// m and m/s.
            pub position_and_velocity: [f32; 4],
            /// m/s2, m3 and m.
            pub acceleration_volume_depth: [f32; 4],
            /// Smoothing length now and for the next step, and height of the ground, m.
            pub lengths_and_ground: [f32; 4],
            /// Lasting identity, and 0 or the side over which it has left, from 1.
            pub identity: [u32; 4],
        }

        /// What the passes read of a particle beside others.
        pub struct Column {
            /// m.
            pub position: [f32; 2],
            /// m/s.
            pub velocity: [f32; 2],
            /// Area that it stands for, mass over density, m2.
            pub area: f32,
            /// kg/m3.
            pub density: f32,
            /// Pressure, as the paper has it.
            pub pressure: f32,
            /// Smoothing length, m.
            pub h: f32,
        }

        /// What a group of threads sums up over its particles.
        pub struct Partial {
            /// Water that went out, m3.
            pub outflow: f32,
            /// Water that came in, m3.
            pub inflow: f32,
            /// Momentum over density that obstacles gave by putting back, m4/s.
            pub knocked: f32,
            /// Momentum that came over the edges, m4/s.
            pub gained_at_edges: f32,
            /// Momentum that went over the edges, m4/s.
            pub lost_at_edges: f32,
            /// Momentum that friction gave, m4/s.
            pub slowed: f32,
            /// Force of ground, edges and obstacles, m4/s2.
            pub outer_force: [f32; 2],
            /// South-west corner.
            pub low: [f32; 2],
            /// North-east corner.
            pub high: [f32; 2],
            /// Sum of smoothing lengths, m.
            pub sum_of_h: f32,
            /// Fills up.
            pub unused: f32,
        }

        /// A particle that is to come.
        pub struct SpawnRequest {
            /// m/s.
            pub velocity: [f32; 2],
            /// By the clock, s.
            pub time: f32,
            /// The zone where: its first word in `zones`.
            pub zone: u32,
        }

        /// Water in the air.
        pub struct Drop {
            /// m.
            pub position: [f32; 2],
            /// m/s.
            pub velocity: [f32; 2],
            /// Height, m.
            pub z: f32,
            /// Upward velocity, m/s.
            pub w: f32,
            /// m3.
            pub volume: f32,
            /// Smoothing length that it will have, m.
            pub h: f32,
            /// Lasting identity.
            pub id: u32,
            /// [`GONE`], [`FALLS`], [`LANDS`].
            pub state: u32,
        }

        /// A boundary particle of an obstacle.
        pub struct WallSite {
            /// m.
            pub position: [f32; 2],
            /// Area of the obstacle that it stands for, m2.
            pub area: f32,
            /// Its area as the forces have it (Akinci et al. 2012, equation 4), m2.
            pub volume: f32,
            /// The obstacle.
            pub obstacle: u32,
            /// Fills up.
            pub unused: u32,
        }

        /// What water does to an obstacle.
        pub struct OnObstacle {
            /// South-west corner of the rectangle in which particles may touch it, m.
            pub low: [f32; 2],
            /// North-east corner.
            pub high: [f32; 2],
            /// Force now, over the density of water, m4/s2.
            pub force: [f32; 2],
            /// Sum of it over time along the east, as a pair to be added, m4/s.
            pub impulse_east: [f32; 2],
            /// The same along the north.
            pub impulse_north: [f32; 2],
        }

        /// A cell of the maps.
        pub struct MapCell {
            /// Its centre, m.
            pub position: [f32; 2],
            /// Largest depth, m.
            pub max_depth: f32,
            /// Largest speed, m/s.
            pub max_speed: f32,
            /// Largest depth x (speed + 0.5), m2/s.
            pub hazard: f32,
            /// When it was first seen wet, s; less than 0 before.
            pub arrival: f32,
            /// For how long it has been seen wet since, s.
            pub duration: f32,
            /// Fills up.
            pub unused: f32,
        }

        /// Parameters of drawing.
        pub struct Shown {
            /// Time from the last step to the time shown, s.
            pub since: f32,
            /// Distance of particles, m.
            pub spacing: f32,
            /// That of drops, m.
            pub drop_spacing: f32,
            /// Fills up.
            pub unused: f32,
        }
    }

    /// What the passes work on.
    pub buffers Memory {
        /// Numbers of the run.
        uniform parameters: Parameters,
        /// What the host learns, and says.
        storage status: Status,
        /// The particles.
        storage particles: [Packed],
        /// The particles in the order of their cells.
        storage sorted: [Packed],
        /// Position, m, volume, m3, and reach, m, of each in that order.
        storage spots: [[f32; 4]],
        /// What the passes read of each.
        storage columns: [Column],
        /// Push of obstacles on each over the density, m4/s2, and from 1 the obstacle that is nearest; 0 for none.
        storage pushes: [[f32; 4]],
        /// Sums of groups.
        storage partials: [Partial],
        /// Particles in each cell.
        storage counts: [AtomicU32],
        /// Cell of each particle, and its index within the cell.
        storage slots: [[u32; 2]],
        /// Sort key of each particle within its cell.
        storage keys: [u32],
        /// The first particle of each cell.
        storage start: [u32],
        /// The particles in the order of their cells, by number.
        storage order: [u32],
        /// The longest reach of the particles in each cell, m.
        storage own_reaches: [f32],
        /// The longest that touches each cell from its own row, m.
        storage reaches_along_rows: [f32],
        /// Search radius in each cell that finds all particles whose support covers a particle there, m.
        storage reaches: [f32],
        /// Numbers of groups: see `sph_finish.wgsl`.
        storage groups: [u32],
        /// Nodes of the ground: height, slope along y, slope along x, twist, per patch.
        storage nodes: [[f32; 4]],
        /// Manning's n over the ground, where it is a raster.
        storage rough: [f32],
        /// The first boundary particle of each cell.
        storage site_start: [u32],
        /// Boundary particles.
        storage sites: [WallSite],
        /// Outlines of obstacles: see `sph_outlines.wgsl`.
        storage outlines: [u32],
        /// Impulses of particles put back, east and north for each obstacle, in units of [`KNOCK`]; and last the number of particles put back.
        storage knocks: [AtomicI32],
        /// Obstacles.
        storage obstacles: [OnObstacle],
        /// Zones of sources: see `sph_spawn.wgsl`.
        storage zones: [u32],
        /// Spawn requests, the earliest first.
        storage spawn_requests: [SpawnRequest],
        /// Water in the air.
        storage drops: [Drop],
        /// Times at which rows of gauges are due, s.
        storage due: [[f32; 2]],
        /// Times at which the maps are sampled, s.
        storage map_times: [[f32; 2]],
        /// Sums of the water of groups, m3.
        storage volumes: [f32],
        /// Rows of gauges: see `sph_rows.wgsl`.
        storage rows: [u32],
        /// Cells of the maps that may become wet.
        storage map_cells: [MapCell],
        /// Parameters of drawing.
        uniform shown: Shown,
        /// Particles for drawing.
        storage drawn: DeviceParticles,
    }
}

#[cfg(test)]
mod tests {
    use super::Memory;
    use corpuscle_gpu::Buffers;

    #[test]
    fn rust_and_wgsl_lay_all_of_it_out_alike() {
        corpuscle_gpu::check_layouts(&Memory::declaration()).unwrap();
    }
}

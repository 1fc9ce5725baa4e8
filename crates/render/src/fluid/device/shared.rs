//! What the host and the kernels that make water on the device share: one declaration, from which the WGSL comes too.

use super::super::{droplet, sides, water};
use crate::shared::{Bound, DropletInstance, Vertex, Vertices};
use corpuscle_gpu::{AtomicU32, DeviceParticles, THREADS};

corpuscle_gpu::declare! {
    include [Bound, Vertices]
    constants {
        /// Threads of a group, one for each particle.
        pub const GROUP: u32 = THREADS;
        /// Threads of a group, one for each node of a border.
        pub const BORDER_GROUP: u32 = 64;
        /// Cells whose counts one group of the sort adds up.
        pub const SORT_BLOCK: u32 = corpuscle_gpu::SORT_BLOCK;
        /// Radius of the neighbour search, and of the spread of a particle's water, in spacings.
        pub const REACH: f32 = water::REACH as f32;
        /// Radius of the discs, in distances between particles.
        pub const DISC: f32 = water::DISC as f32;
        /// Their thickness over their width.
        pub const FLATNESS: f32 = water::FLATNESS as f32;
        /// Largest width of a particle's water over its spacing.
        pub const WIDEST: f32 = water::WIDEST as f32;
        /// Steepest slope of a water surface.
        pub const STEEPEST: f32 = water::STEEPEST as f32;
        /// Least second moment of neighbours for a fitted plane, in squares of their distance.
        pub const LEVEL: f32 = water::LEVEL as f32;
        /// Convergence of the water of a disc at which foam begins, and from which it is to the full, m/s.
        pub const TRAPPED: [f32; 2] = single(water::TRAPPED);
        /// The sum of weights of neighbours between which water is taken to be closed.
        pub const CLOSED: [f32; 2] = single(water::CLOSED);
        /// Energy over mass between which foam comes, m2/s2.
        pub const ENERGY: [f32; 2] = single(water::ENERGY);
        /// Foam on particles in the air.
        pub const SPRAY_FOAM: f32 = water::SPRAY_FOAM as f32;
        /// Less foam is not kept from picture to picture.
        pub const LEAST_FOAM: f32 = water::LEAST_FOAM as f32;
        /// Drawn particles have their ids modulo it, by which tests tell them apart.
        pub const DRAWN_NUMBERS: u32 = droplet::DRAWN_NUMBERS;
        /// How well particles must cover a node of a border for water to be there.
        pub const COVERED: f32 = sides::COVERED as f32;
        /// Larger than any height: stands for none.
        pub const NO_HEIGHT: f32 = 1e30;
        /// Slot of [`Memory::groups`] with a thread for each particle on the ground.
        pub const ON_GROUND: u32 = 4;
        /// Slot with the same while heights change.
        pub const SETTLING: u32 = 5;
        /// First of the arguments of the indirect draw in [`Memory::groups`].
        pub const DRAW: u32 = 18;
        /// First of the arguments of the indirect dispatch of splats in [`Memory::groups`], before [`SPLAT_COUNT`](crate::shared::SPLAT_COUNT).
        pub const SPLATS: u32 = crate::shared::SPLAT_COUNT - 3;
    }
    structs {
        /// Numbers of a picture.
        pub struct Settings {
            /// The particles' origin from the middle of the stage, m, with heights as they are drawn.
            pub shift: [f32; 3],
            /// Exaggeration of heights.
            pub raise: f32,
            /// South-west corner of the cells, m.
            pub corner: [f32; 2],
            /// Cells per metre.
            pub per_cell: f32,
            /// Stage units a metre.
            pub unit: f32,
            /// South-west node of the ground, m.
            pub ground_corner: [f32; 2],
            /// Nodes per metre.
            pub ground_per_metre: [f32; 2],
            /// Nodes eastwards and northwards.
            pub ground_nodes: [u32; 2],
            /// Cells of particles on the ground, eastwards. After all of them comes one for those in the air, and one for what is no particle.
            pub columns: u32,
            /// The same northwards.
            pub rows: u32,
            /// Particles that there is room for.
            pub room: u32,
            /// Bits of a particle's id that index the stored foam.
            pub memory: u32,
            /// The part of the foam before that is left.
            pub left: f32,
            /// Fills up.
            pub unused: f32,
        }

        /// Counts, and values passed from pass to pass.
        pub struct Sizes {
            /// Particles. This and the next first: the sort reads them.
            pub particles: u32,
            /// Cells.
            pub cells: u32,
            /// Whether a height has changed.
            pub has_changed: AtomicU32,
            /// The bits of the farthest reach of a particle at a border, m.
            pub farthest: AtomicU32,
        }
    }

    /// What the passes work on. Positions are counted from the middle of the stage, m.
    pub buffers Memory {
        /// Numbers of the picture.
        uniform water: Settings,
        /// The particles of the model.
        storage seen: DeviceParticles,
        /// How many there are.
        storage sizes: Sizes,
        /// Slots of three numbers, of groups: a thread for each particle, a thread for each cell, a group for each block of cells, one group, a thread for
        /// each particle on the ground, the same while heights change. Then, from [`DRAW`] on, what is drawn, and from [`SPLATS`] on the arguments of splats.
        storage groups: [u32],
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
        /// Heights of the ground, m, row by row from the south-west; [`NO_HEIGHT`] where there is none.
        storage heights: [f32],
        /// Columns of water: position, height and distance to the neighbours, m.
        storage sites: [[f32; 4]],
        /// Their motion: velocity east and north, m/s, and slope of the ground.
        storage motions: [[f32; 4]],
        /// Columns as a pass leaves them.
        storage settled: [[f32; 4]],
        /// Their motion as a pass leaves it.
        storage calmed: [[f32; 4]],
        /// Volume, m3, id, and velocity as it was before the water was calmed, m/s: their bits.
        storage matter: [[u32; 4]],
        /// Foam that comes now.
        storage foam: [f32],
        /// Foam by ids as it was.
        storage before: [f32],
        /// The bits of what will be: of numbers that are not negative, the greater has the greater bits. Where particles share a slot of the memory, the
        /// most foam stays, whichever comes first.
        storage after: [AtomicU32],
        /// The particles as they are drawn.
        storage instances: [DropletInstance],
        /// The water's level at the nodes of the borders, stage units.
        storage levels: [f32],
        /// The faces there, corner by corner.
        storage vertices: [Vertex],
    }
}

const fn single([from, to]: [f64; 2]) -> [f32; 2] {
    [from as f32, to as f32]
}

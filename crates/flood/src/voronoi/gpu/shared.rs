//! What the host and the shaders of scheme `voronoi` share: one declaration, from which the WGSL comes too.

use super::super::{friction, local, water};
use corpuscle_gpu::{DeviceParticles, Stepping};

corpuscle_gpu::declare! {
    include [Stepping]
    constants {
        /// Slot of [`Memory::groups`] with a thread for each cell.
        pub const CELL_SLOT: u32 = 0;
        /// Slot with a thread for each face.
        pub const FACE_SLOT: u32 = 1;
        /// Slot with a thread for each border face.
        pub const BORDER_SLOT: u32 = 2;
        /// Slot with a group for each discharge that is shared out.
        pub const DISCHARGE_SLOT: u32 = 3;
        /// Slot with a thread for each crest.
        pub const CREST_SLOT: u32 = 4;
        /// Slot with a thread for each cell beside a crest.
        pub const BESIDE_CREST_SLOT: u32 = 5;
        /// Slot with one group for all structures.
        pub const STRUCTURE_SLOT: u32 = 6;
        /// Slot with a thread for each cell, in a part of a step.
        pub const PART_CELL_SLOT: u32 = 7;
        /// Slot with a thread for each face, in a part of a step.
        pub const PART_FACE_SLOT: u32 = 8;
        /// Slot with a thread for each border face, in a part of a step.
        pub const PART_BORDER_SLOT: u32 = 9;
        /// Slot with a thread for each cell, where steps of cells are planned.
        pub const PLAN_CELL_SLOT: u32 = 10;
        /// Slot with a thread for each face, where steps of cells are planned.
        pub const PLAN_FACE_SLOT: u32 = 11;
        /// Slot with one group where steps of cells are planned.
        pub const PLAN_SLOT: u32 = 12;
        /// Largest distance, in neighbours, of cells with the shortest step from those that need it.
        pub const WIDENED_SHORTEST: u32 = local::WIDENED[0];
        /// The same of twice the shortest step.
        pub const WIDENED_TWICE: u32 = local::WIDENED[1];
        /// Cells as many neighbours away from a cell of a lower level repeat their stages with it.
        pub const REPEATED: u32 = local::REPEATED as u32;
        /// Steps of their own are taken where they save at least this part of the work.
        pub const LEAST_SAVED: f32 = local::LEAST_SAVED as f32;
        /// A distance in neighbours that stays beyond all that count.
        pub const BEYOND_REACH: u32 = 200;
        /// Stands for no cell, no face, no border.
        pub const NONE: u32 = u32::MAX;
        /// The border reflects.
        pub const WALL: u32 = 0;
        /// Water leaves over the border, and none comes in.
        pub const OPEN: u32 = 1;
        /// Water leaves over the border at the depth of normal flow.
        pub const NORMAL: u32 = 2;
        /// The water beyond the border is held at a level.
        pub const LEVEL: u32 = 3;
        /// A wave comes in over the border.
        pub const WAVE: u32 = 4;
        /// A discharge passes the border.
        pub const DISCHARGE: u32 = 5;
        /// The border is a wall that moves.
        pub const PADDLE: u32 = 6;
        /// A structure that lets water out by a rating.
        pub const OUTFLOW: u32 = 0;
        /// A structure that holds water at a level.
        pub const HOLD: u32 = 1;
        /// A structure that leads water from one patch to another.
        pub const LINK: u32 = 2;
        /// A link that is a culvert: its numbers are those of `Culvert` in `hydraulics.wgsl`.
        pub const CULVERT: u32 = 0;
        /// A link that is a weir: its numbers are crest, m, width, m, and coefficient, m^(1/2)/s.
        pub const WEIR: u32 = 1;
        /// A link that leads by a table over the difference of levels.
        pub const RATING: u32 = 2;
        /// Most of the volume between the levels on both sides of a crest that flows over in a step.
        pub const MAX_CREST_SHARE: f32 = super::super::walls::MAX_CREST_SHARE as f32;
        /// Coefficient of an orifice: see `structures/hydraulics.rs`.
        pub const ORIFICE: f32 = super::super::structures::hydraulics::ORIFICE as f32;
        /// Depth over the height of a culvert from which on it is submerged.
        pub const SUBMERGED: f32 = super::super::structures::hydraulics::SUBMERGED as f32;
        /// Exponent of Villemonte's formula: see `structures/hydraulics.rs`.
        pub const SUBMERGENCE_EXPONENT: f32 = super::super::structures::hydraulics::SUBMERGENCE_EXPONENT as f32;
        /// A law of infiltration: at one rate.
        pub const CONSTANT: f32 = 1.0;
        /// Horton 1940.
        pub const HORTON: f32 = 2.0;
        /// Green & Ampt 1911.
        pub const GREEN_AMPT: f32 = 3.0;
        /// Time step over the width of a cell and the speed of waves in it.
        pub const COURANT: f32 = super::super::solver::COURANT as f32;
        /// A neighbour whose bed stands above the level here counts in full from this part of the depth here on.
        pub const FILM: f32 = super::super::reconstruction::FILM as f32;
        /// Depth below which the velocity is taken from volume and momentum so that it stays finite, m.
        pub const THIN: f32 = water::THIN as f32;
        /// Depth below which water does not move, m.
        pub const STILL: f32 = water::STILL as f32;
        /// Water counts as at least this deep in the laws of friction, m.
        pub const THINNEST: f32 = friction::THINNEST as f32;
        /// Water less deep than this does not move where there is friction, m.
        pub const STILL_ON_BED: f32 = friction::STILL as f32;
        /// The part of the outflow that a cell without enough water for it keeps back, for rounding.
        pub const OUTFLOW_MARGIN: f32 = 1e-6;
        /// Steps between two evaluations of infiltration.
        pub const STEPS_A_DRAUGHT: u32 = super::super::rain::STEPS_A_DRAUGHT as u32;
        /// Words of `tables` that each table has at their beginning: first row, number of rows, then its value in the step.
        pub const TABLE: u32 = 6;
        /// The word with the integral over the step.
        pub const INTEGRAL: u32 = 2;
        /// The words with the value at the beginning of the step, and after it that at the end.
        pub const AT_BEGINNING: u32 = 3;
        /// The word with the mean over the step.
        pub const MEAN: u32 = 5;
        /// Words of a row: time, s, or level, m, as a pair, and value.
        pub const ROW: u32 = 3;
        /// How long a held level takes to be met exactly, in crossings of the terrain by waves.
        pub const CROSSINGS: f32 = super::super::boundaries::CROSSINGS as f32;
        /// The same where the level changes fast.
        pub const FEWEST_CROSSINGS: f32 = super::super::boundaries::FEWEST_CROSSINGS as f32;
        /// How far the level may be from one that changes, over the depth.
        pub const LAG: f32 = super::super::boundaries::LAG as f32;
        /// Words of a source of a cell: its table, the cell's share of it, and its velocity, m/s.
        pub const SOURCE: u32 = 4;
        /// Parts of a cell whose heights count.
        pub const PARTS: u32 = super::super::storage::PARTS as u32;
    }
    structs {
        /// Numbers that stay as they are while the device steps.
        pub struct Parameters {
            /// m/s2.
            pub gravity: f32,
            /// Longest time step, s.
            pub longest: f32,
            /// Depth of wet ground, m.
            pub wet_depth: f32,
            /// Number of cells.
            pub cells: u32,
            /// Number of faces.
            pub faces: u32,
            /// Exponent of the depth in the law of friction; negative where it is linear.
            pub friction_exponent: f32,
            /// Always 0; read at run time so that the optimiser keeps compensated sums.
            pub zero: u32,
            /// Number of border faces.
            pub borders: u32,
            /// Number of tables.
            pub tables: u32,
            /// The table of the depth of rain, m; [`NONE`] where there is none.
            pub rain_table: u32,
            /// Number of discharges that are shared out over border faces.
            pub discharges: u32,
            /// Number of crests.
            pub crests: u32,
            /// Number of cells beside crests.
            pub beside_crests: u32,
            /// Number of structures.
            pub structures: u32,
            /// Where in `tables` the heights of the parts of cells above their mean beds stand, m; [`NONE`] where they do not count.
            pub heights: u32,
            /// Coefficient of Poleni's formula for crests, m^(1/2)/s.
            pub crest_coefficient: f32,
        }

        /// Progress of the device. Pairs are compensated (Kahan) sums: value and error term, to be added.
        pub struct Status {
            /// Time, s.
            pub clock: [f32; 2],
            /// The requested time, s.
            pub until: [f32; 2],
            /// Volume that left over borders, m3.
            pub outflow: [f32; 2],
            /// Volume that came in over borders, m3.
            pub inflow: [f32; 2],
            /// Energy that left over borders, over density, m5/s2.
            pub energy_out: [f32; 2],
            /// The same that came in.
            pub energy_in: [f32; 2],
            /// Momentum over density that ground, borders and friction took, sum of both components, m4/s.
            pub momentum_out: [f32; 2],
            /// The same that they gave.
            pub momentum_in: [f32; 2],
            /// Rain, m3.
            pub rained: [f32; 2],
            /// Infiltration, m3.
            pub infiltrated: [f32; 2],
            /// Of these what the last step brought and took: water out and in.
            pub last_outflow: [f32; 2],
            /// See above.
            pub last_inflow: [f32; 2],
            /// Rain of the last step.
            pub last_rained: [f32; 2],
            /// Infiltration of the last step.
            pub last_infiltrated: [f32; 2],
            /// Energy out and in of the last step.
            pub last_energy: [f32; 2],
            /// Steps of wet cells: low and high part.
            pub cell_steps: [u32; 2],
            /// Whether the batch goes on: [`GOING`](corpuscle_gpu::GOING) and those after it.
            pub halted: u32,
            /// Steps since the start of the batch.
            pub steps: u32,
            /// Next time step, s.
            pub step: f32,
            /// Number of wet cells.
            pub wet: u32,
            /// Whether there is water beside tiles that are not made yet.
            pub at_rim: u32,
            /// Whether a value is not finite.
            pub is_broken: u32,
            /// Last time step, s.
            pub last_step: f32,
            /// Time since the ground drank, s.
            pub since_draught: f32,
            /// Steps since the start of the run.
            pub all_steps: u32,
            /// The current part of the step, where cells take steps of their own.
            pub part: u32,
            /// Number of the shortest steps in a step: 1 where all cells take the same; 0 where that is still to be planned.
            pub parts: u32,
            /// Cells of a pace up to this take part now.
            pub now: u32,
            /// The shortest step, s.
            pub shortest: f32,
            /// Padding.
            pub unused: u32,
        }

        /// What does not change of a cell.
        pub struct Ground {
            /// m2.
            pub area: f32,
            /// Twice the area over the perimeter, m.
            pub width: f32,
            /// Mean height of the ground, m: for the books alone, differences of heights stand in links and faces.
            pub bed: f32,
            /// Coefficient of the law of friction: g n^2, g / C^2 or g S.
            pub friction: f32,
            /// First link.
            pub first_link: u32,
            /// Link after the last.
            pub end_link: u32,
            /// Whether tiles round it are not made yet.
            pub rim: u32,
            /// Level, pace, near and view where cells take steps of their own, two bits each: see `local/mod.rs`.
            pub paces: u32,
        }

        /// A face from the side of one of its cells.
        pub struct Link {
            /// What the difference to the neighbour is multiplied by in the least-squares gradient, 1/m.
            pub gradient: [f32; 2],
            /// Outward unit normal times length, m.
            pub normal: [f32; 2],
            /// How much higher the bed of the neighbour stands, m.
            pub rise: f32,
            /// The cell on the other side; [`NONE`] at borders.
            pub neighbour: u32,
            /// The face; [`NONE`] where there is none yet.
            pub face: u32,
            /// Which of the face's cells this is: 0 or 1.
            pub side: u32,
        }

        /// A face between two cells, or between a cell and a border.
        pub struct Face {
            /// Unit normal from the first cell to the second times the length, m.
            pub normal: [f32; 2],
            /// From the first cell's centroid to the second's, m; on a border to the first's mirror image.
            pub between: [f32; 2],
            /// From the middle between the two centroids to the middle of the face, m.
            pub offset: [f32; 2],
            /// How much higher the bed of the second cell stands, m.
            pub rise: f32,
            /// The first cell.
            pub first: u32,
            /// The second; [`NONE`] on a border.
            pub second: u32,
            /// The border face by its number; [`NONE`] between cells.
            pub border: u32,
        }

        /// What a border face does.
        pub struct Border {
            /// [`WALL`], [`OPEN`] and those after it.
            pub kind: u32,
            /// The face.
            pub face: u32,
            /// The obstacle; [`NONE`] elsewhere.
            pub obstacle: u32,
            /// The table of the level over time, m, or of a paddle's velocity inwards, m/s; [`NONE`] where there is none.
            pub table: u32,
            /// The table of a wave's velocity inwards over time, m/s; [`NONE`] where there is none.
            pub velocity_table: u32,
            /// How much higher than the bed of the cell the level stands from which the table counts, m.
            pub datum: f32,
            /// How much higher than the bed of the cell the ground under the face stands, m.
            pub ground: f32,
            /// How much higher than the bed of the cell a wave's level at rest stands, m.
            pub rest: f32,
            /// At borders of normal flow its velocity over the depth to 2/3, m^(1/3)/s.
            pub factor: f32,
            /// Length of the terrain across the border, m.
            pub span: f32,
        }

        /// A discharge that is shared out over border faces.
        pub struct SharedDischarge {
            /// The table of the discharge inwards over time, m3/s, or of that outwards over the level, m.
            pub table: u32,
            /// Whether it is that over the level: 1 or 0.
            pub is_rating: u32,
            /// Its first part.
            pub first: u32,
            /// The part after its last.
            pub end: u32,
        }

        /// The part of a border face in a discharge.
        pub struct Part {
            /// The border face.
            pub border: u32,
            /// Its cell.
            pub cell: u32,
            /// Length of the face, m.
            pub length: f32,
            /// Bed of the cell above the level from which levels count, m.
            pub bed: f32,
            /// The part of a discharge that comes in here where all faces are dry, over the length, 1/m.
            pub when_dry: f32,
        }

        /// A crest between two cells that water may flow over.
        pub struct Crest {
            /// The cells.
            pub cells: [u32; 2],
            /// The part of each cell's water that may flow over here.
            pub parts: [f32; 2],
            /// Momentum over density that goes over with the volume, m4/s.
            pub momentum: [f32; 2],
            /// Volume that flows over in the step from the first cell to the second, m3.
            pub volume: f32,
            /// Crest above the bed of the first cell, m.
            pub above: f32,
            /// How much higher the bed of the second cell stands, m.
            pub rise: f32,
            /// m.
            pub length: f32,
        }

        /// A cell beside crests.
        pub struct BesideCrest {
            /// The cell.
            pub cell: u32,
            /// Its first entry among those of crests.
            pub first: u32,
            /// The entry after its last.
            pub end: u32,
        }

        /// What lets water out, holds it at a level or leads it to another position.
        pub struct Structure {
            /// First cells of its patches among those of all.
            pub firsts: [u32; 2],
            /// The cells after their last.
            pub ends: [u32; 2],
            /// Areas of its patches, m2.
            pub areas: [f32; 2],
            /// [`OUTFLOW`], [`HOLD`] or [`LINK`].
            pub kind: u32,
            /// Discharge over level, level over time, or discharge over the difference of levels: its table.
            pub table: u32,
            /// Whether a link leads both ways: 1 or 0.
            pub both_ways: u32,
            /// By what a link leads: [`CULVERT`], [`WEIR`] or [`RATING`].
            pub law: u32,
            /// Where in `tables` the numbers of the law stand.
            pub numbers: u32,
            /// Padding.
            pub unused: u32,
        }

        /// A cell of a patch.
        pub struct InPatch {
            /// The cell.
            pub cell: u32,
            /// Its bed above the level from which the structure's levels count, m.
            pub above: f32,
            /// m2.
            pub area: f32,
            /// Mean height of the ground, m.
            pub bed: f32,
        }

        /// Where a cell is drawn.
        pub struct CellPosition {
            /// Centroid from the origin of what is drawn, m.
            pub at: [f32; 2],
            /// Its bed above that origin, m.
            pub bed: f32,
            /// The lowest bits of the number of its point.
            pub id: u32,
        }

        /// The time at which the water is shown.
        pub struct Shown {
            /// How far it is on the way from the column before the last step to that after it.
            pub share: f32,
            /// Water less deep than this is not shown, m.
            pub least_depth: f32,
            /// Padding.
            pub unused: [f32; 2],
        }

        /// What the water pushed an obstacle with at a face.
        pub struct Push {
            /// Impulse over density since the flood is on the device, m4/s: eastwards, a compensated sum.
            pub east: [f32; 2],
            /// The same northwards.
            pub north: [f32; 2],
            /// That of the last step.
            pub last: [f32; 2],
        }

        /// What is conserved: a column of water over a cell.
        pub struct Column {
            /// Volume, m3, and what it lacks, to be added.
            pub volume: [f32; 2],
            /// Volume times velocity, m4/s.
            pub momentum: [f32; 2],
        }

        /// Depth and velocity of a cell. There is no level: differences of levels come from depths and rises of the bed, so that a datum far away costs no digits.
        pub struct Water {
            /// m/s.
            pub velocity: [f32; 2],
            /// m; 0 where dry.
            pub depth: f32,
            /// Level less mean bed and depth, m: not 0 where the heights of the ground within the cell count.
            pub shift: f32,
        }

        /// Slopes of depth, level, and velocity east- and northwards.
        pub struct Slopes {
            /// Along x.
            pub x: [f32; 4],
            /// Along y.
            pub y: [f32; 4],
        }

        /// What passes a face.
        pub struct Flux {
            /// Momentum that goes with the volume, over density, m4/s2.
            pub carried: [f32; 2],
            /// Thrust across the face per length on the first cell and on the second, over density, less the cell's own, m3/s2.
            pub thrust: [f32; 2],
            /// From the first cell to the second, m3/s, where both have the water for it.
            pub volume: f32,
            /// The lower pace near its two cells, where cells take steps of their own.
            pub near: u32,
        }

        /// Plan of the local time steps of a group of cells.
        pub struct Plan {
            /// The highest level of a cell.
            pub highest: u32,
            /// Number of wet cells.
            pub wet: u32,
            /// How often they go through their stages in the longest step, in quarters of the shortest.
            pub quarters: u32,
        }

        /// Record of a cell: see the maps.
        pub struct Record {
            /// Velocity at the highest speed, m/s.
            pub fastest: [f32; 2],
            /// m.
            pub max_depth: f32,
            /// Largest depth x (speed + 0.5), m2/s.
            pub hazard: f32,
            /// s; not-a-number where it was never wet.
            pub arrival: f32,
            /// s.
            pub duration: f32,
        }

        /// Totals over the borders of a group of cells in a step.
        pub struct BorderTotals {
            /// Volume that left, m3.
            pub outflow: [f32; 2],
            /// Volume that came in, m3.
            pub inflow: [f32; 2],
            /// Energy that left and that came in, over density, m5/s2.
            pub energy: [f32; 2],
            /// Momentum over density that ground, borders and friction gave, sum of both components, m4/s.
            pub momentum: f32,
            /// Whether a value is not finite.
            pub is_broken: u32,
        }

        /// Rain, infiltration and inflow of a cell.
        pub struct Supply {
            /// Infiltrated depth, m.
            pub soaked: f32,
            /// Area that rain runs into the cell from, times its factor, m2.
            pub rain_area: f32,
            /// Index of the law of infiltration in `tables`; [`NONE`] where there is none.
            pub law: u32,
            /// Where in `tables` its sources begin.
            pub first_source: u32,
            /// Where they end.
            pub end_source: u32,
            /// Padding.
            pub unused: u32,
        }

        /// Totals of a group of cells after a step: stable time step, wet cells, and rain, infiltration and inflow.
        pub struct Found {
            /// Rain, m3.
            pub rained: [f32; 2],
            /// Infiltration, m3.
            pub infiltrated: [f32; 2],
            /// Inflow of sources, m3.
            pub supplied: [f32; 2],
            /// Energy that all of these brought, over density, m5/s2.
            pub energy: f32,
            /// Momentum that they brought, over density, sum of both components, m4/s.
            pub momentum: f32,
            /// Shortest time step over the Courant number, s.
            pub step: f32,
            /// Number of wet cells.
            pub wet: u32,
            /// Whether there is water beside tiles that are not made yet.
            pub at_rim: u32,
            /// Padding.
            pub unused: u32,
        }
    }

    /// The buffers of a flood on the device.
    pub buffers Memory {
        /// Constant parameters.
        uniform parameters: Parameters,
        /// Progress.
        storage status: Status,
        /// Numbers of groups for cells, for faces, for border faces, for discharges that are shared out, for crests, for cells beside them, for structures, and for parts
        /// of a step and their plan: 3 each.
        storage groups: [u32],
        /// Each cell.
        storage ground: [Ground],
        /// Links of all cells.
        storage links: [Link],
        /// Each face.
        storage faces: [Face],
        /// Each border face.
        storage borders: [Border],
        /// State of the water beyond each border face: at open ones the level above the bed of the cell, m; at held ones the velocity outwards, m/s; where a
        /// discharge passes that inwards per length, m2/s.
        storage beyond: [f32],
        /// Discharges that are shared out.
        storage discharges: [SharedDischarge],
        /// The parts of border faces in them.
        storage parts: [Part],
        /// Columns now, then columns before the step; where cells take steps of their own then those at the start of these, and the sums of their results.
        storage columns: [Column],
        /// Water of each cell; where cells take steps of their own then that in their second stages.
        storage water: [Water],
        /// Slopes of each cell.
        storage slopes: [Slopes],
        /// Flux through each face.
        storage fluxes: [Flux],
        /// The part of its outflow that each cell has the water for.
        storage kept: [f32],
        /// Distances of each cell from those with the shortest step and twice that, in neighbours: 8 bits each, and once more for the next.
        storage distances: [u32],
        /// For each group of cells.
        storage plans: [Plan],
        /// Record of each cell.
        storage records: [Record],
        /// For each group of cells, and for structures.
        storage border_totals: [BorderTotals],
        /// For each group of cells.
        storage found: [Found],
        /// For each border face.
        storage pushes: [Push],
        /// Crests that water may flow over.
        storage crests: [Crest],
        /// Cells beside crests.
        storage beside_crests: [BesideCrest],
        /// For each of these its crests: twice the number, and one more where it is the second cell.
        storage crest_entries: [u32],
        /// Structures.
        storage structures: [Structure],
        /// Cells of their patches.
        storage in_patches: [InPatch],
        /// Discharge of each structure in the last step, m3/s.
        storage structure_discharges: [f32],
        /// Position of each cell for drawing; empty where nothing is drawn.
        storage positions: [CellPosition],
        /// The time that is shown.
        uniform shown: Shown,
        /// Particles for drawing.
        storage drawn: DeviceParticles,
        /// Rain, infiltration and inflow of each cell; empty where there are none.
        storage supplies: [Supply],
        /// Tables over time, sources and laws of infiltration: see [`TABLE`].
        storage tables: [u32],
    }
}

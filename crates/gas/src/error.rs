//! Why a gas cannot be set up.

use corpuscle_model::ModelError;

/// Why a gas cannot be set up. The text says what is wrong, where, and what to do.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SetupError {
    /// A number that cannot be.
    #[error("gas: {what} is {value}: it must be {must}")]
    Value {
        /// The cause.
        what: String,
        /// The number.
        value: f64,
        /// What it must be.
        must: &'static str,
    },
    /// More balls than there is room for in any order.
    #[error(
        "gas: {what} would fill {packing:.4} of its region; no arrangement of equal {shape} fills more than {limit:.4} ({shown_by}), \
         and here, with {count} of them between these sides, {fits:.4}. Ask for fewer or smaller balls, or a larger region"
    )]
    TooDense {
        /// Which balls.
        what: String,
        /// Part of the region that they would fill.
        packing: f64,
        /// Disks or balls.
        shape: &'static str,
        /// Largest part that equal balls can fill.
        limit: f64,
        /// The reference.
        shown_by: &'static str,
        /// How many balls.
        count: usize,
        /// Part that they can fill on the best lattice found in this region.
        fits: f64,
    },
    /// A random arrangement that was not reached.
    #[error(
        "gas: {what} would fill {packing:.4} of its region; balls that grow from a random start jam at {reached:.4} at the latest \
         (random arrangements end near {limit}). Ask for a lattice, which exists up to {lattice:.4}, or for fewer balls"
    )]
    Jammed {
        /// Which balls.
        what: String,
        /// Part of the region that they would fill.
        packing: f64,
        /// Part that was reached, or that is known not to be.
        reached: f64,
        /// Part at which random arrangements jam.
        limit: f64,
        /// Largest part that equal balls can fill.
        lattice: f64,
    },
    /// Balls that overlap each other or a wall at the start.
    #[error("gas: {what} overlaps {other} at the start by {depth:.3e}. Move one of them, or make it smaller")]
    Overlap {
        /// Which ball.
        what: String,
        /// With what.
        other: String,
        /// How far.
        depth: f64,
    },
    /// A ball that does not fit into its box.
    #[error("gas: a ball of radius {radius} does not fit into a box that is {length} wide along {axis}; {must}")]
    TooWide {
        /// Its radius.
        radius: f64,
        /// The box's length.
        length: f64,
        /// The axis.
        axis: char,
        /// What must hold.
        must: &'static str,
    },
    /// Things that do not go together.
    #[error("gas: {0}")]
    Contradiction(String),
}

impl From<SetupError> for ModelError {
    fn from(error: SetupError) -> Self {
        ModelError::Setup(error.to_string())
    }
}

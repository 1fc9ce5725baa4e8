//! Why a solid cannot be used.

use std::path::PathBuf;

/// Why a solid cannot be used. The text says what is wrong, where, and what to do.
#[derive(Debug, thiserror::Error)]
pub enum SolidError {
    /// A size that cannot be.
    #[error("{what} is {value}: it must be {must}")]
    Size {
        /// The cause.
        what: &'static str,
        /// The number.
        value: f64,
        /// What it must be.
        must: &'static str,
    },
    /// A profile that bounds no solid of revolution.
    #[error("the profile cannot be turned into a solid: {0}")]
    Profile(String),
    /// A mesh file that cannot be opened.
    #[error("cannot read the mesh {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A mesh file whose content cannot be used.
    #[error("{}: {what}", path.display())]
    Mesh {
        /// The file.
        path: PathBuf,
        /// What is wrong, and what to do.
        what: String,
    },
    /// More particles than there is memory for.
    #[error(
        "a solid of {volume:.3e} m³ and {area:.3e} m² of surface would take about {count:.1e} particles {spacing} m apart, \
         more than the {most:.0e} that are possible: give a larger spacing or fewer layers"
    )]
    TooManySamples {
        /// Its volume, m³.
        volume: f64,
        /// Its surface, m².
        area: f64,
        /// The requested distance, m.
        spacing: f64,
        /// About how many particles that makes.
        count: f64,
        /// How many are possible.
        most: f64,
    },
}

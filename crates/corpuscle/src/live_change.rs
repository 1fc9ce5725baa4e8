//! Live changes: changes of a running scene.

use corpuscle_dew::LiveChange as Dew;
use corpuscle_gas::LiveChange as Gas;
use corpuscle_model::{Model, ModelError};
use serde::{Deserialize, Serialize};

/// A change of a running model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum LiveChange {
    /// Of a gas.
    Gas(Gas),
    /// Of a flood.
    Flood(corpuscle_flood::LiveChange),
    /// Of dew.
    Dew(Dew),
}

impl From<Gas> for LiveChange {
    fn from(change: Gas) -> Self {
        Self::Gas(change)
    }
}

impl From<corpuscle_flood::LiveChange> for LiveChange {
    fn from(change: corpuscle_flood::LiveChange) -> Self {
        Self::Flood(change)
    }
}

impl From<Dew> for LiveChange {
    fn from(change: Dew) -> Self {
        Self::Dew(change)
    }
}

impl From<corpuscle_dew::SourceChange> for LiveChange {
    fn from(change: corpuscle_dew::SourceChange) -> Self {
        Self::Dew(Dew::Source(change))
    }
}

impl LiveChange {
    pub(crate) fn change(self, model: &mut dyn Model) -> Result<(), ModelError> {
        match self {
            Self::Gas(change) => change.change(model),
            Self::Flood(change) => change.change(model),
            Self::Dew(change) => change.change(model),
        }
    }
}

//! What a hand changes while a scene runs.

use corpuscle_dew::ByHand as Dew;
use corpuscle_flood::ByHand as Flood;
use corpuscle_gas::ByHand as Gas;
use corpuscle_model::{Model, ModelError};

/// A change of a model that runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ByHand {
    /// Of a gas.
    Gas(Gas),
    /// Of a flood.
    Flood(Flood),
    /// Of dew.
    Dew(Dew),
}

impl From<Gas> for ByHand {
    fn from(change: Gas) -> Self {
        Self::Gas(change)
    }
}

impl From<Flood> for ByHand {
    fn from(change: Flood) -> Self {
        Self::Flood(change)
    }
}

impl From<Dew> for ByHand {
    fn from(change: Dew) -> Self {
        Self::Dew(change)
    }
}

impl From<corpuscle_dew::SourceByHand> for ByHand {
    fn from(change: corpuscle_dew::SourceByHand) -> Self {
        Self::Dew(Dew::Source(change))
    }
}

impl ByHand {
    pub(crate) fn change(self, model: &mut dyn Model) -> Result<(), ModelError> {
        match self {
            Self::Gas(change) => change.change(model),
            Self::Flood(change) => change.change(model),
            Self::Dew(change) => change.change(model),
        }
    }
}

//! Errors of scenes that cannot be opened.

use corpuscle_model::ModelError;

/// The error of a scene that cannot be opened, by what is wrong with it.
pub(crate) fn setup(text: impl std::fmt::Display) -> ModelError {
    ModelError::Setup(text.to_string())
}

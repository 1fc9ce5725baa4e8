//! Where the floods of cases are computed.

pub(super) use crate::device::rounding;
use corpuscle_model::{GpuModel, ModelError};

/// A flood that is set up, on the GPU where one takes the steps.
pub(super) fn ready<F: GpuModel>(mut flood: F) -> Result<F, ModelError> {
    if let Some(gpu) = crate::device::gpu() {
        flood.use_gpu(gpu)?;
    }
    Ok(flood)
}

/// The bound of the water's relative error in the ledger.
pub(super) fn water_rounding() -> f64 {
    rounding(1e-12, 1e-6)
}

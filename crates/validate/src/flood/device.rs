//! Where the floods of cases are computed.

use corpuscle_flood::Flood;
use corpuscle_gpu::Gpu;
use corpuscle_model::ModelError;
use std::cell::RefCell;

thread_local! {
    /// The card that takes the steps of the case that this thread runs, if one does.
    static CARD: RefCell<Option<Gpu>> = const { RefCell::new(None) };
}

/// Lets a card take the steps of all floods that `case` sets up.
pub(crate) fn on_card<T>(gpu: Option<Gpu>, case: impl FnOnce() -> T) -> T {
    let before = CARD.replace(gpu);
    let result = case();
    CARD.replace(before);
    result
}

/// Whether a card takes the steps.
pub(super) fn is_card() -> bool {
    CARD.with_borrow(Option::is_some)
}

/// A flood that is set up, on the card where one takes the steps.
pub(super) fn ready(mut flood: Flood) -> Result<Flood, ModelError> {
    if let Some(gpu) = CARD.with_borrow(Clone::clone) {
        flood.use_card(gpu)?;
    }
    Ok(flood)
}

/// The bound of a measure that is exact but for rounding: of double precision on the CPU, or of single precision on the card.
pub(super) fn rounding(double: f64, single: f64) -> f64 {
    if is_card() { single } else { double }
}

/// The bound of the water's relative error in the ledger.
pub(super) fn water_rounding() -> f64 {
    rounding(1e-12, 1e-6)
}

/// Refuses what the card's program has not.
pub(super) fn refuse_on_card(what: &str) -> Result<(), ModelError> {
    if is_card() { Err(ModelError::Setup(format!("the graphics card cannot yet compute {what}"))) } else { Ok(()) }
}

//! Cases of the dew model.

mod dew_point;
mod slide;

use crate::Case;

pub(crate) const CASES: &[Case] = &[dew_point::DEW_POINT, slide::SLIDE];

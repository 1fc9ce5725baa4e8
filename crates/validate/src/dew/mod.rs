//! Cases of the dew model.

mod dew_point;

use crate::Case;

pub(crate) const CASES: &[Case] = &[dew_point::DEW_POINT];

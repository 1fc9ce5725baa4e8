//! A device that is lost: the page is loaded again with the scene that its address names.

use web_sys::js_sys::Date;
use web_sys::{Storage, window};

/// Where the time of the last loss is kept while the tab is open, ms.
const KEY: &str = "corpuscle-device-lost";
/// A device that is lost again so soon is not opened again, ms.
const SOON: f64 = 20_000.0;
/// A page that is loaded so soon after a loss was loaded for it, ms.
const LOADED: f64 = 15_000.0;

/// Loads the page again; false where the device was lost a moment ago already, or the page cannot be loaded.
pub(super) fn open_again() -> bool {
    let (Some(window), Some(storage)) = (window(), storage()) else { return false };
    let is_again = since(&storage).is_some_and(|since| since < SOON);
    let noted = storage.set_item(KEY, &Date::now().to_string()).is_ok();
    noted && !is_again && window.location().reload().is_ok()
}

/// True where the page was loaded for a lost device.
pub(super) fn take_note() -> bool {
    storage().and_then(|storage| since(&storage)).is_some_and(|since| since < LOADED)
}

fn storage() -> Option<Storage> {
    window()?.session_storage().ok()?
}

/// Time since the last loss, ms.
fn since(storage: &Storage) -> Option<f64> {
    let at: f64 = storage.get_item(KEY).ok()??.parse().ok()?;
    Some(Date::now() - at)
}

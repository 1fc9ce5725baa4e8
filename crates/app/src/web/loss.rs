//! A device that is lost: the page is loaded again with the scene that its address names.

use wasm_bindgen::JsValue;
use web_sys::js_sys::Date;
use web_sys::{Storage, window};

/// Where the time of the last loss is kept while the tab is open, ms.
const KEY: &str = "corpuscle-device-lost";
/// Set while the page is loaded again to be drawn without WebGPU.
const WITHOUT: &str = "corpuscle-without-webgpu";
/// A device that is lost again so soon is not opened again, ms.
const SOON: f64 = 20_000.0;
/// A page that is loaded so soon after a loss was loaded for it, ms.
const LOADED: f64 = 15_000.0;

/// Loads the page again, to be drawn without WebGPU where the device was lost a moment ago already. Where that cannot be, `error` is said by
/// the page: the lost device draws no more.
pub(super) fn open_again(error: &str) {
    if reload().is_none() {
        // A page that takes no text stays as it is.
        let _ = say(&format!("{error}. Load the page again to go on."));
    }
}

fn reload() -> Option<()> {
    let (window, storage) = (window()?, storage()?);
    if since(&storage).is_some_and(|since| since < SOON) {
        storage.set_item(WITHOUT, "true").ok()?;
    }
    storage.set_item(KEY, &Date::now().to_string()).ok()?;
    window.location().reload().ok()
}

/// True where this load of the page is to be drawn without WebGPU.
pub(super) fn without_webgpu() -> bool {
    let Some(storage) = storage() else { return false };
    let without = storage.get_item(WITHOUT).ok().flatten().is_some();
    without && storage.remove_item(WITHOUT).is_ok()
}

/// Shows a text over the page.
fn say(text: &str) -> Result<(), JsValue> {
    let document = window().and_then(|window| window.document()).ok_or("there is no page")?;
    let said = document.create_element("div")?;
    said.set_id("said");
    said.set_attribute("role", "alert")?;
    said.set_text_content(Some(text));
    document.body().ok_or("the page has no body")?.append_child(&said)?;
    Ok(())
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

//! The window in a browser: what the page and its worker call. Elsewhere this crate is empty.
#![cfg(target_arch = "wasm32")]

use corpuscle_app::web;
use wasm_bindgen::prelude::*;
use web_sys::HtmlCanvasElement;

/// The window on a canvas of a page.
#[wasm_bindgen]
pub struct Page(web::Page);

#[wasm_bindgen]
impl Page {
    /// Opens the window on a canvas, with the scene that the page's address names; by WebGL where there is no WebGPU.
    ///
    /// # Errors
    /// A text that says why there is no window.
    pub async fn open(canvas: HtmlCanvasElement, has_webgpu: bool) -> Result<Page, JsValue> {
        web::Page::open(canvas, has_webgpu).await.map(Self)
    }

    /// What is shown, as JSON.
    pub fn state(&self) -> String {
        self.0.state()
    }
}

/// Serves the page that started this worker: runs the physics.
///
/// # Errors
/// Where this is no worker.
#[wasm_bindgen]
pub fn serve() -> Result<(), JsValue> {
    corpuscle_app::physics::serve()
}

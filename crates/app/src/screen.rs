//! Where pictures are drawn and shown: the window's own device.

use corpuscle::gpu::{Gpu, wgpu};
use corpuscle_render::{Inlay, InlayPainter};
use egui::PaintCallbackInfo;
use egui_wgpu::{CallbackResources, CallbackTrait};
use std::sync::Arc;

/// The window's device, and the painter that lays pictures into the window.
#[derive(Clone)]
pub struct Screen {
    /// The device.
    pub gpu: Gpu,
    pub(crate) inlays: Arc<InlayPainter>,
}

/// A picture on the device, to be shown in the window.
#[derive(Clone)]
pub(crate) struct OnScreen(pub Inlay);

impl Screen {
    /// The screen of a window that is drawn on a device in a format.
    pub fn new(gpu: Gpu, format: wgpu::TextureFormat) -> Self {
        let inlays = Arc::new(InlayPainter::new(&gpu, format));
        Self { gpu, inlays }
    }
}

impl CallbackTrait for OnScreen {
    fn paint(&self, _info: PaintCallbackInfo, pass: &mut wgpu::RenderPass<'static>, _resources: &CallbackResources) {
        self.0.draw(pass);
    }
}

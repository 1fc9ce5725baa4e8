//! Pictures that the window's device draws.

use super::Drawn;
use crate::Screen;
use crate::screen::OnScreen;
use crate::snapshot::Snapshot;
use crate::view_state::{ViewState, moment};
use corpuscle::Error;
use corpuscle::gpu::{GpuKind, Image};
use corpuscle::pictures::{Pictures, Shown};
use egui::{Painter, Rect};

/// What draws pictures on the window's device.
pub(super) struct DevicePainting {
    screen: Screen,
    pictures: Pictures,
    on_screen: Option<OnScreen>,
}

impl DevicePainting {
    pub fn new(screen: Screen, pictures: Pictures) -> Self {
        Self { screen, pictures, on_screen: None }
    }

    /// True for a GPU in hardware.
    pub fn is_hardware(&self) -> bool {
        self.screen.gpu.kind == GpuKind::Hardware
    }

    /// Draws a picture of a snapshot.
    pub fn draw(&mut self, snapshot: &Snapshot, drawn: &Drawn, paper: [f32; 3]) -> Result<Shown, Error> {
        self.pictures.resize(drawn.size, drawn.samples)?;
        let shown = self.pictures.show(&moment(snapshot), &drawn.camera_offset, drawn.quality, paper)?;
        self.on_screen = Some(OnScreen(self.pictures.inlay(&shown, &self.screen.inlays)));
        Ok(shown)
    }

    /// Takes a picture that was drawn elsewhere.
    pub fn take(&mut self, image: &Image) -> Result<(), String> {
        let inlay = self.screen.inlays.image(&self.screen.gpu, image).map_err(|error| error.to_string())?;
        self.on_screen = Some(OnScreen(inlay));
        Ok(())
    }

    pub fn lift(&mut self, view_state: ViewState) {
        view_state.lift(&mut self.pictures);
    }

    /// Lays the last picture into a rectangle.
    pub fn paint(&self, painter: &Painter, rect: Rect) {
        if let Some(on_screen) = &self.on_screen {
            painter.add(egui_wgpu::Callback::new_paint_callback(rect, on_screen.clone()));
        }
    }
}

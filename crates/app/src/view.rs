//! The window of the system.

use crate::meter::Meter;
use crate::physics::Backend;
use crate::{Measurement, Meshes, Screen, Start, Window};
use corpuscle::gpu::{Gpu, wgpu};
use egui_wgpu::{RenderState, WgpuSetup, WgpuSetupCreateNew};
use std::sync::{Arc, Mutex, PoisonError};

/// Size of the window at first, points.
const SIZE: [f32; 2] = [1360.0, 840.0];
/// Smallest size of the window, points.
const LEAST: [f32; 2] = [720.0, 480.0];

/// Why the window cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    /// The system has no display, or no device that can draw on it.
    #[error("no window can be opened: {0}; `corpuscle run` and `corpuscle render` need no display")]
    NoDisplay(String),
}

/// Opens the window, and returns when it is closed. Scenes are computed on `backend`. With `measure` it counts pictures for so many seconds,
/// and closes.
///
/// # Errors
/// [`ViewError`] where there is no display, or nothing that draws on it.
pub fn view(start: Start, backend: Backend, measure: Option<f64>) -> Result<Option<Measurement>, ViewError> {
    keep_memory();
    let measured = Arc::new(Mutex::new(None));
    let meter = measure.map(|seconds| Meter::new(seconds, measured.clone()));
    let wgpu_options = egui_wgpu::WgpuConfiguration {
        wgpu_setup: WgpuSetup::CreateNew(setup()),
        ..egui_wgpu::WgpuConfiguration::default()
    };
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Corpuscle")
            .with_app_id("corpuscle")
            .with_inner_size(SIZE)
            .with_min_inner_size(LEAST),
        renderer: eframe::Renderer::Wgpu,
        dithering: false,
        wgpu_options,
        ..eframe::NativeOptions::default()
    };
    let create = move |context: &eframe::CreationContext<'_>| {
        let state = context.wgpu_render_state.as_ref().ok_or("the window has no GPU")?;
        let screen = screen(state);
        if let Some(meshes) = Meshes::new(&screen.gpu, state.target_format) {
            context.egui_ctx.add_plugin(meshes);
        }
        let window = Window::new(&context.egui_ctx, Some(screen), start, backend)?;
        Ok(Box::new(App { window, meter }) as Box<dyn eframe::App>)
    };
    let ended = eframe::run_native("Corpuscle", options, Box::new(create));
    ended.map_err(|error| ViewError::NoDisplay(reason(&error)))?;
    Ok(measured.lock().unwrap_or_else(PoisonError::into_inner).take())
}

/// The reason why there is no window. The toolkit's own text for a missing display names its source files, and is not
/// shown.
fn reason(error: &eframe::Error) -> String {
    match error {
        eframe::Error::Winit(_) | eframe::Error::WinitEventLoop(_) => {
            "no display was found; on Linux, DISPLAY or WAYLAND_DISPLAY must name one that can be reached".into()
        }
        error => error.to_string(),
    }
}

/// Lets the system's allocator keep what is freed. Software in place of a GPU takes some megabytes for every picture and frees them;
/// given back to the system and taken again, they cost it a page fault for each 4 kB, 2 ms a picture. glibc keeps twice as much as the
/// largest piece that was ever freed, up to 32 MiB; other allocators are not changed by this.
fn keep_memory() {
    drop(std::hint::black_box(Vec::<u8>::with_capacity(31 << 20)));
}

/// The device that a window needs: the best that can draw on it.
fn setup() -> WgpuSetupCreateNew {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor.flags = wgpu::InstanceFlags::empty();
    setup.native_adapter_selector = Some(Arc::new(|adapters, surface| {
        let fits = |adapter: &&wgpu::Adapter| surface.is_none_or(|surface| adapter.is_surface_supported(surface));
        let best = adapters.iter().filter(fits).min_by_key(|adapter| Gpu::rank(adapter));
        best.cloned().ok_or_else(|| "no GPU, nor software in its place, can draw on this display".into())
    }));
    setup.device_descriptor = Arc::new(Gpu::request);
    setup
}

fn screen(state: &RenderState) -> Screen {
    let gpu = Gpu::of(&state.adapter, state.device.clone(), state.queue.clone());
    Screen::new(gpu, state.target_format)
}

struct App {
    window: Window,
    meter: Option<Meter>,
}

impl eframe::App for App {
    /// The colour of panels, so that these need not be filled: software in place of a GPU fills slowly.
    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        self.window.ui(ui);
        if let Some(meter) = &mut self.meter
            && meter.tick(&self.window)
        {
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
        }
    }
}

//! The window in a page of a browser.

mod elements;
mod loss;

use crate::meter::Meter;
use crate::physics::Backend;
use crate::{Embedded, Measurement, Meshes, Screen, Start, Window, link};
use corpuscle::gpu::{Gpu, wgpu};
use eframe::Renderer;
use egui_wgpu::{WgpuSetup, WgpuSetupCreateNew};
use elements::Elements;
use serde_json::{Map, Value, json};
use std::sync::{Arc, Mutex, PoisonError};
use wasm_bindgen::prelude::*;
use web_sys::HtmlCanvasElement;

/// The window on a canvas of a page.
pub struct Page(eframe::WebRunner);

/// What the address of a page says beside the scene: words after `?`.
struct Words {
    /// `embed`: the picture and the strip below it alone; `embed=picture`: without the strip.
    embedded: Option<Embedded>,
    /// `measure=SECONDS`: pictures are counted.
    measure: Option<f64>,
    /// `speed=TIMES`: the pace of scenes, over their own.
    speed: Option<f64>,
    /// `backend=cpu`, `backend=gpu`: what takes the steps.
    backend: Backend,
}

impl Words {
    fn of(search: &str) -> Self {
        let words: Vec<_> = search.trim_start_matches('?').split('&').collect();
        let number = |name| words.iter().find_map(|word| word.strip_prefix(name)?.parse::<f64>().ok());
        let (measure, speed) = (number("measure="), number("speed="));
        let backend = match words.iter().find_map(|word| word.strip_prefix("backend=")) {
            Some("cpu") => Backend::Cpu,
            Some("gpu") => Backend::Gpu,
            _ => Backend::Auto,
        };
        let embedded = words.iter().find_map(|word| match *word {
            "embed" => Some(Embedded { has_strip: true }),
            "embed=picture" => Some(Embedded { has_strip: false }),
            _ => None,
        });
        Self { embedded, measure, speed, backend }
    }
}

impl Page {
    /// Opens the window on a canvas, with the scene that the page's address names; without WebGPU it is drawn by WebGL, pictures as discs
    /// and maps.
    ///
    /// # Errors
    /// A text that says why there is no window.
    pub async fn open(canvas: HtmlCanvasElement, has_webgpu: bool) -> Result<Self, JsValue> {
        console_error_panic_hook::set_once();
        let location = web_sys::window().ok_or("there is no page")?.location();
        let (hash, words) = (location.hash()?, Words::of(&location.search()?));
        let elements = Elements::new()?;
        let mut setup = WgpuSetupCreateNew::without_display_handle();
        setup.instance_descriptor.backends = wgpu::Backends::BROWSER_WEBGPU;
        setup.device_descriptor = Arc::new(Gpu::request);
        let wgpu_options =
            egui_wgpu::WgpuConfiguration { wgpu_setup: WgpuSetup::CreateNew(setup), ..Default::default() };
        let renderer = if has_webgpu && !loss::without_webgpu() { Renderer::Wgpu } else { Renderer::Glow };
        let options = eframe::WebOptions { renderer, wgpu_options, dithering: false, ..Default::default() };
        let create = move |context: &eframe::CreationContext<'_>| {
            context.egui_ctx.add_plugin(elements);
            Ok(Box::new(App::new(context, &hash, &words)?) as Box<dyn eframe::App>)
        };
        let runner = eframe::WebRunner::new();
        runner.start(canvas, options, Box::new(create)).await?;
        Ok(Self(runner))
    }

    /// What is shown, as JSON: the scene, its time, its particles, whether it plays, its gauges, the last error, and the pictures that were counted.
    pub fn state(&self) -> String {
        self.0.app_mut::<App>().map_or_else(|| "null".into(), |app| app.state().to_string())
    }
}

struct App {
    window: Window,
    /// The device; none without WebGPU.
    gpu: Option<Gpu>,
    /// True once the device was found lost.
    is_lost: bool,
    /// The link that stands in the page's address; empty without one.
    link: String,
    meter: Option<Meter>,
    measured: Arc<Mutex<Option<Measurement>>>,
}

impl App {
    fn new(context: &eframe::CreationContext<'_>, hash: &str, words: &Words) -> Result<Self, String> {
        let screen = context.wgpu_render_state.as_ref().map(|state| {
            let gpu = Gpu::of(&state.adapter, state.device.clone(), state.queue.clone());
            if let Some(meshes) = Meshes::new(&gpu, state.target_format) {
                context.egui_ctx.add_plugin(meshes);
            }
            Screen::new(gpu, state.target_format)
        });
        let gpu = screen.as_ref().map(|screen| screen.gpu.clone());
        let (start, fault) = match link::read(hash) {
            Ok(start) => (start, None),
            Err(fault) => (Start::Welcome, Some(fault)),
        };
        let window = Window::new(&context.egui_ctx, screen, start, words.backend);
        let mut window = window.map_err(|error| error.to_string())?;
        if let Some(fault) = fault {
            window.show_error(fault);
        }
        let link = hash.trim_start_matches('#').to_owned();
        if loss::take_note() && link.is_empty() {
            window.show_error("The graphics device was lost: open the scene again, or drop its files again.".into());
        } else if loss::take_note() {
            window.notify("The graphics device was lost: the scene was opened again.".into());
        }
        if let Some(embedded) = words.embedded {
            window.embed(embedded);
        }
        if let Some(speed) = words.speed {
            window.set_speed(speed);
        }
        let measured = Arc::<Mutex<Option<Measurement>>>::default();
        let meter = words.measure.map(|seconds| Meter::new(seconds, measured.clone()));
        Ok(Self { window, gpu, is_lost: false, link, meter, measured })
    }

    /// Has the page's address name the open scene with its changes; a scene without a link leaves no link of another there.
    fn update_link(&mut self) {
        if !self.window.has_scene() {
            return;
        }
        let link = self.window.link().unwrap_or_default();
        if link != self.link {
            self.link = link;
            // A page that may not change its address stays as it is.
            let _ = show_link(&self.link);
        }
    }

    fn state(&self) -> Value {
        let snapshot = self.window.snapshot();
        let gauges = snapshot.iter().flat_map(|snapshot| {
            let measures = &snapshot.measures;
            measures.names.iter().cloned().zip(measures.gauges.iter().map(|value| Value::from(*value)))
        });
        let camera = self.window.camera_offset();
        let measured = *self.measured.lock().unwrap_or_else(PoisonError::into_inner);
        json!({
            "link": self.window.link(),
            "time": snapshot.as_ref().map(|snapshot| snapshot.frame.time),
            "particles": snapshot.as_ref().map(|snapshot| snapshot.particles),
            "playing": snapshot.as_ref().is_some_and(|snapshot| snapshot.playing),
            "measured_at": snapshot.as_ref().map(|snapshot| snapshot.measures.time),
            "gauges": gauges.collect::<Map<_, _>>(),
            "opening": self.window.is_waiting(),
            "error": self.window.fault(),
            "camera": camera.map(|camera| json!({ "turn": camera.turn, "shift": camera.shift, "zoom": camera.zoom })),
            "webgpu": self.gpu.is_some(),
            "computed_on": self.window.computed_on(),
            "pictures_per_s": measured.map(|measured| measured.pictures_per_s),
            "slowest_picture_s": measured.map(|measured| measured.slowest_s),
        })
    }
}

impl eframe::App for App {
    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        if let Some(Err(error)) = self.gpu.as_ref().map(Gpu::check)
            && !self.is_lost
        {
            self.is_lost = true;
            loss::open_again(&error.to_string());
        }
        self.window.ui(ui);
        if let Some(meter) = &mut self.meter
            && meter.tick(&self.window)
        {
            self.meter = None;
        }
        self.update_link();
    }

    fn as_any_mut(&mut self) -> Option<&mut dyn std::any::Any> {
        Some(self)
    }
}

/// Puts a link into the page's address; an empty one leaves an address without any.
fn show_link(link: &str) -> Result<(), JsValue> {
    let window = web_sys::window().ok_or("there is no page")?;
    let location = window.location();
    let address = match link {
        "" => format!("{}{}", location.pathname()?, location.search()?),
        link => format!("#{link}"),
    };
    window.history()?.replace_state_with_url(&JsValue::NULL, "", Some(&address))
}

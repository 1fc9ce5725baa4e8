//! A window off screen, with a device that draws it.

mod reference;

use corpuscle::gpu::{Gpu, GpuKind, require_gpu, wgpu};
use corpuscle_app::physics::Backend;
use corpuscle_app::{Meshes, Screen, Start, Window};
use egui::mutex::RwLock;
use egui::{Role, TexturesDelta, vec2};
use egui_kittest::kittest::Queryable;
use egui_kittest::{Harness, TestRenderer};
use std::cell::RefCell;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Size of the window, points.
const SIZE: [f32; 2] = [1360.0, 840.0];
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// A window off screen.
#[allow(dead_code)]
pub struct Stage {
    pub harness: Harness<'static, Option<Window>>,
    pub screen: Screen,
    pub renderer: Arc<RwLock<egui_wgpu::Renderer>>,
}

/// Keeps the window's textures on its device.
struct Textures(Gpu, Arc<RwLock<egui_wgpu::Renderer>>);

impl TestRenderer for Textures {
    fn handle_delta(&mut self, delta: &mut TexturesDelta) {
        let mut renderer = self.1.write();
        for (id, images) in delta.set.drain() {
            for image in images {
                renderer.update_texture(&self.0.device, &self.0.queue, id, &image);
            }
        }
        for id in delta.free.drain() {
            renderer.free_texture(&id);
        }
    }
}

/// A window with the first page; none, after a line that says so, where there is no device.
pub fn stage(test: &str) -> Option<Stage> {
    stage_in(test, egui::Theme::Light, Start::Welcome)
}

/// The same as software draws it in the system's window.
pub fn stage_of_software(test: &str) -> Option<Stage> {
    stage_by(test, egui::Theme::Light, Start::Welcome, Drawn::ByMeshes)
}

/// A window in a theme that begins so.
pub fn stage_in(test: &str, theme: egui::Theme, start: Start) -> Option<Stage> {
    stage_by(test, theme, start, Drawn::Plain)
}

/// A window whose device is taken for a GPU, which computes too.
#[allow(dead_code)]
pub fn stage_of_gpu(test: &str) -> Option<Stage> {
    let mut device = require_gpu(test)?;
    device.kind = GpuKind::Hardware;
    Some(stage_on(device, egui::Theme::Light, Start::Welcome, Drawn::Plain, Backend::Gpu))
}

/// A window without a device of its own: pictures are sketched.
#[allow(dead_code)]
pub fn stage_without_device(test: &str) -> Option<Stage> {
    stage_by(test, egui::Theme::Light, Start::Welcome, Drawn::Sketched)
}

/// How the window is drawn.
#[derive(Clone, Copy, PartialEq)]
enum Drawn {
    Plain,
    ByMeshes,
    /// Its pictures with its own shapes.
    Sketched,
}

fn stage_by(test: &str, theme: egui::Theme, start: Start, drawn: Drawn) -> Option<Stage> {
    Some(stage_on(require_gpu(test)?, theme, start, drawn, Backend::Auto))
}

fn stage_on(gpu: Gpu, theme: egui::Theme, start: Start, drawn: Drawn, backend: Backend) -> Stage {
    let renderer = egui_wgpu::Renderer::new(
        &gpu.device,
        FORMAT,
        egui_wgpu::RendererOptions { dithering: false, ..Default::default() },
    );
    let renderer = Arc::new(RwLock::new(renderer));
    let screen = Screen::new(gpu.clone(), FORMAT);
    // The window sets its letters before the first picture, as it does in the system's window.
    let made = Rc::new(RefCell::new(None));
    let (own, made_first) = (Some(screen.clone()), made.clone());
    let harness = Harness::builder()
        .with_size(vec2(SIZE[0], SIZE[1]))
        .with_theme(theme)
        .with_step_dt(1.0 / 60.0)
        .renderer(Textures(screen.gpu.clone(), renderer.clone()))
        .with_context_setup(move |context| {
            if let Some(meshes) = Meshes::new(&gpu, FORMAT).filter(|_| drawn == Drawn::ByMeshes) {
                context.add_plugin(meshes);
            }
            *made_first.borrow_mut() =
                Some(Window::new(context, own.filter(|_| drawn != Drawn::Sketched), start, backend).unwrap());
        })
        .build_ui_state(
            move |ui, window: &mut Option<Window>| {
                if window.is_none() {
                    *window = made.borrow_mut().take();
                }
                window.as_mut().expect("it was made before").ui(ui);
            },
            None,
        );
    Stage { harness, screen, renderer }
}

impl Stage {
    /// The window.
    pub fn window(&self) -> &Window {
        self.harness.state().as_ref().expect("it was shown")
    }

    /// Simulated time that is shown, s.
    pub fn time(&self) -> f64 {
        self.window().snapshot().map_or(f64::NAN, |snapshot| snapshot.frame.time)
    }

    /// Shows the window again and again for so long.
    pub fn run(&mut self, time: Duration) {
        let start = Instant::now();
        while start.elapsed() < time {
            self.harness.step();
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// Shows the window until something holds of it.
    pub fn until(&mut self, most: Duration, what: &str, holds: impl Fn(&Window) -> bool) {
        let start = Instant::now();
        while !holds(self.window()) {
            assert!(start.elapsed() < most, "not so after {most:?}: {what}; {:?}", self.window().fault());
            self.run(Duration::from_millis(20));
        }
    }

    /// Clicks on what is called so.
    pub fn click(&mut self, name: &str) {
        self.harness.get_by_label(name).click();
        self.harness.step();
        self.harness.step();
    }

    /// Chooses a scene by its title, wherever in its list it stands, as a screen reader does.
    pub fn choose(&mut self, title: &str) {
        self.harness.get_by_role_and_label(Role::Button, title).click_accesskit();
        self.harness.step();
        self.harness.step();
    }

    /// True where something is called so.
    pub fn has(&self, name: &str) -> bool {
        self.harness.query_all_by_label(name).next().is_some()
    }

    /// Gives the window another size, points.
    pub fn resize(&mut self, size: [f32; 2]) {
        self.harness.set_size(vec2(size[0], size[1]));
        self.run(Duration::from_millis(100));
    }

    /// Size of the picture of the scene, points.
    pub fn picture_size(&self) -> [f32; 2] {
        self.harness.get_by_label("Picture of the scene").rect().size().into()
    }

    /// Clicks on a position of the picture, in parts of its width and height.
    pub fn click_picture(&mut self, part: [f32; 2]) {
        let rect = self.harness.get_by_label("Picture of the scene").rect();
        let at = rect.min + vec2(part[0], part[1]) * rect.size();
        self.harness.hover_at(at);
        self.harness.step();
        self.harness.drag_at(at);
        self.harness.step();
        self.harness.drop_at(at);
        self.harness.step();
        self.harness.step();
    }

    /// Drags what is called so by some points.
    pub fn drag(&mut self, name: &str, by: [f32; 2]) {
        let from = self.harness.get_by_label(name).rect().center();
        self.harness.hover_at(from);
        self.harness.step();
        self.harness.drag_at(from);
        self.harness.step();
        for part in 1..=4 {
            self.harness.hover_at(from + 0.25 * part as f32 * vec2(by[0], by[1]));
            self.harness.step();
        }
        self.harness.drop_at(from + vec2(by[0], by[1]));
        self.harness.step();
        self.harness.step();
    }

    /// Zooms the picture by a factor, the pointer at its middle.
    pub fn zoom(&mut self, times: f32) {
        let middle = self.harness.get_by_label("Picture of the scene").rect().center();
        self.harness.hover_at(middle);
        self.harness.step();
        self.harness.event(egui::Event::Zoom(times));
        self.harness.step();
        self.run(Duration::from_millis(50));
    }

    /// Touches the bar of a finished run's time, in parts of its length.
    pub fn touch_bar(&mut self, part: f32) {
        let bar = |label: String| label.starts_with("Time ");
        let rect = self.harness.get_by(|node| node.role() == Role::Slider && node.label().is_some_and(bar)).rect();
        let at = rect.min + vec2(part, 0.5) * rect.size();
        self.harness.hover_at(at);
        self.harness.step();
        self.harness.drag_at(at);
        self.harness.step();
        self.harness.drop_at(at);
        self.harness.step();
        self.harness.step();
    }

    /// Opens a file as if it was dropped on the window.
    pub fn drop_file(&mut self, path: &std::path::Path) {
        let context = self.harness.ctx.clone();
        if let Some(window) = self.harness.state_mut() {
            window.open_dropped(&context, path.to_owned());
        }
    }

    /// Goes on by so many steps, each in full.
    pub fn steps(&mut self, count: u32) {
        for _ in 0..count {
            let before = self.time();
            self.key(egui::Key::ArrowRight);
            self.until(Duration::from_secs(30), "a step", |window| {
                window.snapshot().is_some_and(|snapshot| snapshot.frame.time > before)
            });
        }
    }

    /// Compares picture and parameters with the reference of a name, at half their size: it shows what it was when it was looked at.
    /// Where it changed on purpose: run with `CORPUSCLE_NEW_REFERENCE=1`, look at it, and keep it.
    pub fn same_as_reference(&mut self, name: &str) {
        // What stands still is drawn with all there is.
        self.run(Duration::from_millis(400));
        self.until(Duration::from_secs(60), "all there is", Window::is_complete);
        self.run(Duration::from_millis(100));
        let rect = self.harness.get_by_label("Picture of the scene").rect();
        let whole = self.picture(name);
        let found = reference::half(&whole, [rect.left(), rect.top(), SIZE[0], rect.bottom()].map(|at| at as u32));
        reference::compare(name, &found);
    }

    /// The window, to be set up.
    pub fn window_mut(&mut self) -> &mut Window {
        self.harness.state_mut().as_mut().expect("it was shown")
    }

    /// True where something is called so at its beginning.
    pub fn has_beginning(&self, words: &str) -> bool {
        self.harness.query_all_by(|node| node.label().is_some_and(|label| label.starts_with(words))).next().is_some()
    }

    /// Types a number into the field that is called so.
    pub fn type_into(&mut self, name: &str, words: &str) {
        self.harness.get_by_role_and_label(Role::SpinButton, name).click();
        self.harness.step();
        self.harness.step();
        self.harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
        self.harness.event(egui::Event::Text(words.into()));
        self.harness.step();
        self.key(egui::Key::Enter);
    }

    /// Presses a key.
    pub fn key(&mut self, key: egui::Key) {
        self.harness.key_press(key);
        self.harness.step();
        self.harness.step();
    }

    /// The window as an image: width, height, and its pixels. Where the environment names a folder `CORPUSCLE_SHOTS`, it is put there.
    pub fn picture(&mut self, name: &str) -> corpuscle::gpu::Image {
        self.harness.step();
        let image = draw(&self.screen, &self.renderer, &self.harness);
        if let Some(folder) = std::env::var_os("CORPUSCLE_SHOTS") {
            let file = PathBuf::from(folder).join(format!("{name}.png"));
            corpuscle::output::write_picture(&file, [image.width, image.height], &image.rgba).unwrap();
        }
        image
    }
}

pub fn draw(
    screen: &Screen,
    renderer: &RwLock<egui_wgpu::Renderer>,
    harness: &Harness<'static, Option<Window>>,
) -> corpuscle::gpu::Image {
    let Gpu { device, queue, .. } = &screen.gpu;
    let [width, height] = SIZE.map(|length| length as u32);
    let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("window"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let descriptor = egui_wgpu::ScreenDescriptor { size_in_pixels: [width, height], pixels_per_point: 1.0 };
    let shapes = harness.ctx.tessellate(harness.output().shapes.clone(), 1.0);
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut renderer = renderer.write();
    renderer.update_buffers(device, queue, &mut encoder, &shapes, &descriptor);
    {
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("window"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color { r: 0.965, g: 0.969, b: 0.976, a: 1.0 }),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..wgpu::RenderPassDescriptor::default()
        });
        renderer.render(&mut pass.forget_lifetime(), &shapes, &descriptor);
    }
    queue.submit([encoder.finish()]);
    corpuscle::gpu::read_rgba8(&screen.gpu, &texture).unwrap()
}

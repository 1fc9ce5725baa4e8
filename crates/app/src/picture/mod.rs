//! The picture in the middle: drawn on the window's device, with a camera that the user rotates, pans and zooms.

mod device;
mod paused;
mod sketch;

use crate::offscreen::OffscreenRenderer;
use crate::overlay::Over;
use crate::physics::open_pictures;
use crate::snapshot::Snapshot;
use crate::{Screen, style};
use corpuscle::Error;
use corpuscle::pictures::{CameraOffset, Pictures, Quality, Scenery, Shown, Sketches};
use corpuscle_render::Lens;
use device::DevicePainting;
use egui::{Color32, MultiTouchInfo, PointerButton, Pos2, Rect, Response, Role, Sense, Ui, WidgetInfo};
use glam::DVec3;
use sketch::SketchPainting;
use std::sync::Arc;
use std::time::Duration;
use web_time::Instant;

/// Rotation of the camera per point of pointer motion, radians.
const TURN: f64 = 0.008;
/// Smallest and largest zoom.
const ZOOM: [f64; 2] = [0.3, 200.0];
/// Time without change after which a paused scene is drawn with full quality.
const STILL: Duration = Duration::from_millis(350);

/// The quality that the user chose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum QualitySetting {
    /// Full with a GPU and at rest; simple in motion without a GPU.
    #[default]
    Auto,
    /// Always simple.
    Simple,
    /// Always full.
    Full,
}

/// The picture of a scene.
pub struct Picture {
    painting: Painting,
    scenery: Arc<Scenery>,
    shown: Option<Shown>,
    /// What was drawn last.
    drawn: Option<Drawn>,
    /// The full-quality picture requested since something last changed, with the number of the request.
    requested: Option<(u64, Drawn)>,
    /// How the user moved the camera.
    pub camera_offset: CameraOffset,
    /// When the partition was lifted, s.
    lifted: Option<f64>,
    /// The quality chosen.
    pub quality: QualitySetting,
    /// When something last changed.
    changed: Instant,
    /// Height of the legend, points.
    key_height: f32,
    /// The last error of drawing.
    fault: Option<String>,
}

/// What draws it.
enum Painting {
    /// The window's device.
    Device(Box<DevicePainting>),
    /// The window's own shapes, where there is no such device.
    Sketch(Box<SketchPainting>),
}

impl Painting {
    fn open(screen: Option<&Screen>, pictures: Option<Pictures>, scenery: &Scenery) -> Result<Self, Error> {
        let Some(screen) = screen else {
            return Ok(Self::Sketch(Box::new(SketchPainting::new(Sketches::open(scenery)?))));
        };
        let pictures = pictures.map_or_else(|| open_pictures(&screen.gpu, scenery), Ok)?;
        Ok(Self::Device(Box::new(DevicePainting::new(screen.clone(), pictures))))
    }
}

/// What a picture was drawn from.
#[derive(Clone, PartialEq)]
struct Drawn {
    /// The snapshot, by its address.
    of: usize,
    camera_offset: CameraOffset,
    quality: Quality,
    size: [u32; 2],
    samples: u32,
    paper: Color32,
}

impl Picture {
    /// The picture of a scene that was opened, with its pictures where they are open already; sketched where there is no screen.
    ///
    /// # Errors
    /// Where something cannot be drawn.
    pub fn open(screen: Option<&Screen>, pictures: Option<Pictures>, scenery: Scenery) -> Result<Self, Error> {
        Ok(Self {
            painting: Painting::open(screen, pictures, &scenery)?,
            scenery: Arc::new(scenery),
            shown: None,
            drawn: None,
            requested: None,
            camera_offset: CameraOffset::default(),
            lifted: None,
            quality: QualitySetting::Auto,
            changed: Instant::now(),
            key_height: 0.0,
            fault: None,
        })
    }

    /// True where it is sketched.
    pub fn is_sketch(&self) -> bool {
        matches!(self.painting, Painting::Sketch(_))
    }

    /// Resets the camera.
    pub fn reset(&mut self) {
        self.camera_offset = CameraOffset { plan: self.camera_offset.plan, ..CameraOffset::default() };
    }

    /// What was drawn last.
    pub fn shown(&self) -> Option<&Shown> {
        self.shown.as_ref()
    }

    /// Begins the picture of a snapshot with the last camera, so that the device draws while the rest of the window is laid out.
    /// If the camera has changed after all, it is drawn again.
    pub fn draw_ahead(&mut self, snapshot: &Arc<Snapshot>, visuals: &egui::Visuals) {
        let (paper, linear) = style::paper(visuals);
        let Some(last) = self.drawn.clone().filter(|last| last.paper == paper) else { return };
        let (quality, samples) = self.work(false);
        let drawn =
            Drawn { of: Arc::as_ptr(snapshot) as usize, camera_offset: self.camera_offset, quality, samples, ..last };
        self.draw_as(snapshot, drawn, linear);
    }

    /// Draws a picture, unless it is drawn already.
    fn draw_as(&mut self, snapshot: &Snapshot, drawn: Drawn, linear: [f32; 3]) {
        if self.drawn.as_ref() != Some(&drawn) {
            match self.draw(snapshot, &drawn, linear) {
                Ok(()) => self.fault = None,
                Err(error) => self.fault = Some(error.to_string()),
            }
            self.drawn = Some(drawn);
        }
    }

    /// Fills the rest of the window with the picture of a snapshot; returns the response of its area. The full-quality
    /// picture of a paused scene is drawn by the offscreen renderer.
    pub fn ui(
        &mut self,
        ui: &mut Ui,
        snapshot: &Arc<Snapshot>,
        moves: bool,
        offscreen: &OffscreenRenderer,
    ) -> Response {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, ui.is_enabled(), "Picture of the scene"));
        self.follow_hand(ui, rect, &response);
        let scale = ui.pixels_per_point();
        let size = [rect.width(), rect.height()].map(|length| ((length * scale).round() as u32).clamp(16, 8192));
        let (paper, linear) = style::paper(ui.visuals());
        let still = self.note_change(ui, snapshot, moves, size, paper);
        let [quick, best] = [false, true].map(|still| {
            let (quality, samples) = self.work(still);
            Drawn {
                of: Arc::as_ptr(snapshot) as usize,
                camera_offset: self.camera_offset,
                quality,
                size,
                samples,
                paper,
            }
        });
        if !still {
            self.requested = None;
        }
        if !still || self.drawn.as_ref() != Some(&best) {
            let needs_full = still && quick != best;
            self.draw_as(snapshot, quick, linear);
            if needs_full {
                self.request(snapshot, best, linear, offscreen);
            }
        }
        self.key_height = self.paint(ui, rect);
        response
    }

    /// Height of the legend over the picture, points.
    pub fn key_height(&self) -> f32 {
        self.key_height
    }

    /// The point of the world, m, that appears at a position in the window, in the plane through the camera's target that faces the camera: of a
    /// flat gas its own plane. None before the first picture.
    pub fn below(&self, rect: Rect, at: Pos2) -> Option<[f64; 3]> {
        let shown = self.shown.as_ref()?;
        let [right, up] = axes(shown);
        let point = height(shown) / f64::from(rect.height());
        let off = at - rect.center();
        Some((shown.camera.target + point * (f64::from(off.x) * right - f64::from(off.y) * up)).into())
    }

    /// True where the last picture has full quality.
    pub fn is_complete(&self) -> bool {
        self.drawn.as_ref().is_some_and(|drawn| drawn.samples > 1 || self.is_sketch())
    }

    /// Records that the partition of a gas was lifted.
    pub fn lift_partition(&mut self, time: f64) {
        self.lifted = Some(time);
        let view_state = self.view_state();
        match &mut self.painting {
            Painting::Device(device) => device.lift(view_state),
            Painting::Sketch(sketch) => sketch.lift(time),
        }
        (self.drawn, self.requested) = (None, None);
    }

    /// True where nothing has changed for a while; else requests a repaint for when that may be.
    fn note_change(&mut self, ui: &Ui, snapshot: &Arc<Snapshot>, moves: bool, size: [u32; 2], paper: Color32) -> bool {
        let same = self.drawn.as_ref().is_some_and(|drawn| {
            drawn.of == Arc::as_ptr(snapshot) as usize
                && (drawn.camera_offset, drawn.size, drawn.paper) == (self.camera_offset, size, paper)
        });
        if !same || moves {
            self.changed = Instant::now();
        }
        let since = self.changed.elapsed();
        if since < STILL && !moves {
            ui.ctx().request_repaint_after(STILL.saturating_sub(since));
        }
        since >= STILL
    }

    /// The quality, and samples each way in a pixel.
    fn work(&self, still: bool) -> (Quality, u32) {
        let is_hardware = match &self.painting {
            Painting::Device(device) => device.is_hardware(),
            Painting::Sketch(_) => return (Quality::Simple, 1),
        };
        match self.quality {
            QualitySetting::Simple => (Quality::Simple, if is_hardware || still { 2 } else { 1 }),
            QualitySetting::Full => (Quality::Full, if is_hardware || still { 2 } else { 1 }),
            QualitySetting::Auto => (
                if is_hardware || still { Quality::Full } else { Quality::Simple },
                if is_hardware || still { 2 } else { 1 },
            ),
        }
    }

    fn draw(&mut self, snapshot: &Snapshot, drawn: &Drawn, paper: [f32; 3]) -> Result<(), Error> {
        self.shown = Some(match &mut self.painting {
            Painting::Device(device) => device.draw(snapshot, drawn, paper)?,
            Painting::Sketch(sketch) => sketch.draw(snapshot, drawn.camera_offset, drawn.size),
        });
        Ok(())
    }

    fn paint(&mut self, ui: &Ui, rect: Rect) -> f32 {
        let painter = ui.painter_at(rect);
        match &mut self.painting {
            Painting::Device(device) => device.paint(&painter, rect),
            Painting::Sketch(sketch) => sketch.paint(&painter, rect, style::paper(ui.visuals()).0),
        }
        let over = |shown| Over { shown, rect, painter: &painter, dark: ui.visuals().dark_mode };
        let key_height = self.shown.as_ref().map_or(0.0, |shown| over(shown).paint());
        if let Some(fault) = &self.fault {
            let font = egui::FontId::proportional(13.5);
            painter.text(rect.center(), egui::Align2::CENTER_CENTER, fault, font, ui.visuals().error_fg_color);
        }
        key_height
    }

    /// Rotates, pans and zooms.
    fn follow_hand(&mut self, ui: &Ui, rect: Rect, response: &Response) {
        if response.double_clicked() {
            self.reset();
        }
        let Some(shown) = &self.shown else { return };
        let flat = matches!(shown.camera.lens, Lens::Orthographic { .. });
        if let Some(touch) = ui.input(|input| input.multi_touch()) {
            return self.follow_fingers(rect, &touch);
        }
        let shift = ui.input(|input| input.modifiers.shift);
        let (turns, shifts) = (
            response.dragged_by(PointerButton::Primary) && !flat && !shift,
            response.dragged_by(PointerButton::Secondary)
                || response.dragged_by(PointerButton::Middle)
                || response.dragged_by(PointerButton::Primary) && (flat || shift),
        );
        let moved = response.drag_delta();
        let [right, up] = axes(shown);
        let point = height(shown) / f64::from(rect.height());
        if turns {
            let away = shown.camera.eye - shown.camera.target;
            let own = (away.z / away.length()).asin() - self.camera_offset.turn[1];
            self.camera_offset.turn_by(own, [-f64::from(moved.x) * TURN, f64::from(moved.y) * TURN]);
        }
        if shifts {
            self.shift_by(point * (f64::from(moved.y) * up - f64::from(moved.x) * right));
        }
        if response.hovered() {
            let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
            let times = f64::from(pinch) * (f64::from(scroll) * 0.004).exp();
            if let Some(pointer) = response.hover_pos().filter(|_| times != 1.0) {
                self.zoom_at(times, pointer, rect);
            }
        }
    }

    /// Pans with two fingers, and zooms as they part.
    fn follow_fingers(&mut self, rect: Rect, touch: &MultiTouchInfo) {
        let Some(shown) = &self.shown else { return };
        let [right, up] = axes(shown);
        let point = height(shown) / f64::from(rect.height());
        let moved = touch.translation_delta;
        self.shift_by(point * (f64::from(moved.y) * up - f64::from(moved.x) * right));
        if rect.contains(touch.center_pos) {
            self.zoom_at(f64::from(touch.zoom_delta), touch.center_pos, rect);
        }
    }

    /// Zooms by a factor; what lies under a position stays there.
    fn zoom_at(&mut self, times: f64, at: Pos2, rect: Rect) {
        let Some(shown) = &self.shown else { return };
        let [right, up] = axes(shown);
        let point = height(shown) / f64::from(rect.height());
        let zoom = (self.camera_offset.zoom * times).clamp(ZOOM[0], ZOOM[1]);
        let off = at - rect.center();
        let towards = point * (f64::from(off.x) * right - f64::from(off.y) * up);
        let part = 1.0 - self.camera_offset.zoom / zoom;
        self.camera_offset.zoom = zoom;
        self.shift_by(part * towards);
    }

    fn shift_by(&mut self, by: DVec3) {
        self.camera_offset.shift = (DVec3::from(self.camera_offset.shift) + by).into();
    }
}

/// To the right and up in the picture, of length 1.
fn axes(shown: &Shown) -> [DVec3; 2] {
    let forward = (shown.camera.target - shown.camera.eye).normalize_or(DVec3::NEG_Z);
    let right = forward.cross(shown.camera.up).normalize_or(DVec3::X);
    [right, right.cross(forward)]
}

/// Height of the world in the picture at the camera's target, m.
fn height(shown: &Shown) -> f64 {
    match shown.camera.lens {
        Lens::Orthographic { height } => height,
        Lens::Perspective { field_of_view } => {
            2.0 * (shown.camera.eye - shown.camera.target).length() * (0.5 * field_of_view).tan()
        }
    }
}

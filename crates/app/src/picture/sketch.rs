//! Pictures as discs and a map, drawn with the window's own shapes where no device draws them.

use crate::snapshot::Snapshot;
use crate::view_state::moment;
use corpuscle::pictures::{CameraOffset, GroundMap, Shown, Sketch, SketchView, Sketches};
use egui::epaint::Vertex;
use egui::{
    Color32, ColorImage, Context, Mesh, Painter, Pos2, Rect, Shape, Stroke, TextureHandle, TextureOptions, pos2, vec2,
};
use std::sync::Arc;

/// Side of the picture of a disc, pixels; the part of its radius that a darker rim takes; and how dark that is.
const DISC: usize = 64;
const RIM: f32 = 0.16;
const DARK: f32 = 0.62;
/// Least radius of a disc, points.
const LEAST_RADIUS: f32 = 1.3;
/// Width of lines, points.
const LINE: f32 = 1.4;
/// What the picture says of itself.
const REMARK: &str = "drawn as discs and maps: this browser offers no WebGPU";

/// What draws sketches.
pub(super) struct SketchPainting {
    sketches: Sketches,
    sketch: Option<Sketch>,
    /// The ground until it is a texture.
    ground: Option<GroundMap>,
    textures: Option<Textures>,
}

/// Pictures that are drawn again and again.
struct Textures {
    discs: TextureHandle,
    /// The ground, and its south-western and north-eastern corners, m.
    ground: Option<(TextureHandle, [[f64; 2]; 2])>,
}

impl SketchPainting {
    pub fn new(sketches: Sketches) -> Self {
        let ground = sketches.ground();
        Self { sketches, sketch: None, ground, textures: None }
    }

    /// Sketches a snapshot for a picture of a size.
    pub fn draw(&mut self, snapshot: &Snapshot, camera_offset: CameraOffset, size: [u32; 2]) -> Shown {
        let aspect = f64::from(size[0]) / f64::from(size[1]);
        let mut sketch = self.sketches.sketch(&SketchView { camera_offset, aspect }, &moment(snapshot));
        sketch.shown.overlay.remark = REMARK.into();
        let shown = sketch.shown.clone();
        self.sketch = Some(sketch);
        shown
    }

    pub fn lift(&mut self, time: f64) {
        self.sketches.lift_partition(time);
    }

    /// Draws the last sketch into a rectangle, on paper of a colour.
    pub fn paint(&mut self, painter: &Painter, rect: Rect, paper: Color32) {
        painter.rect_filled(rect, 0.0, paper);
        let textures = match &mut self.textures {
            Some(textures) => textures,
            none => none.insert(Textures::new(painter.ctx(), self.ground.take())),
        };
        let Some(sketch) = &self.sketch else { return };
        let over = Over { sketch, rect };
        if let Some((ground, corners)) = &textures.ground {
            over.ground(painter, ground, *corners);
        }
        for line in &sketch.lines {
            let [r, g, b] = line.colour;
            let points: Option<Vec<Pos2>> = line.points.iter().map(|point| over.position(*point)).collect();
            if let Some(points) = points.filter(|points| points.len() > 1) {
                painter.add(Shape::line(points, Stroke::new(LINE, Color32::from_rgb(r, g, b))));
            }
        }
        painter.add(Shape::mesh(over.patches(&textures.discs)));
        painter.add(Shape::mesh(over.discs(&textures.discs)));
    }
}

impl Textures {
    fn new(context: &Context, ground: Option<GroundMap>) -> Self {
        let discs = context.load_texture("discs", discs(), TextureOptions::LINEAR);
        let ground = ground.map(|GroundMap { image, corners }| {
            let size = [image.width, image.height].map(|length| length as usize);
            let pixels = ColorImage::from_rgba_unmultiplied(size, &image.rgba);
            (context.load_texture("ground", pixels, TextureOptions::LINEAR), corners)
        });
        Self { discs, ground }
    }
}

/// Two white discs with smooth edges, one beside the other, the second with a darker rim; each disc of a sketch is one of them in another
/// colour.
fn discs() -> ColorImage {
    let middle = 0.5 * DISC as f32;
    let pixel = |index: usize| {
        let [x, y] = [index % DISC, index / (2 * DISC)].map(|at| at as f32 + 0.5 - middle);
        let inside = middle - 1.0 - x.hypot(y);
        let dark = if index / DISC % 2 == 1 { DARK } else { 1.0 };
        let bright = dark + (1.0 - dark) * (inside / (RIM * middle)).clamp(0.0, 1.0);
        let opacity = (inside + 0.5).clamp(0.0, 1.0);
        let [bright, opacity] = [bright * opacity, opacity].map(|part| (255.0 * part) as u8);
        Color32::from_rgba_premultiplied(bright, bright, bright, opacity)
    };
    ColorImage::new([2 * DISC, DISC], (0..2 * DISC * DISC).map(pixel).collect())
}

/// A sketch that fills a rectangle.
struct Over<'a> {
    sketch: &'a Sketch,
    rect: Rect,
}

impl Over<'_> {
    fn aspect(&self) -> f64 {
        f64::from(self.rect.width()) / f64::from(self.rect.height())
    }

    fn position(&self, point: [f64; 3]) -> Option<Pos2> {
        crate::overlay::position(&self.sketch.shown, self.rect, point)
    }

    fn ground(&self, painter: &Painter, ground: &TextureHandle, corners: [[f64; 2]; 2]) {
        if let [Some(one), Some(other)] = corners.map(|[x, y]| self.position([x, y, 0.0])) {
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            painter.image(ground.id(), Rect::from_two_pos(one, other), whole, Color32::WHITE);
        }
    }

    /// All patches as one mesh, the nearest last.
    fn patches(&self, texture: &TextureHandle) -> Arc<Mesh> {
        let Shown { stage, camera, .. } = &self.sketch.shown;
        let projection = camera.projection(stage, self.aspect());
        let seen = |patch: &corpuscle::pictures::Patch| {
            let mut nearness = 0.0;
            let mut corners = [Pos2::ZERO; 4];
            for (corner, at) in patch.corners.iter().zip(&mut corners) {
                let ball = projection.ball(*corner, 0.0)?;
                *at = self.at(ball.at);
                nearness += ball.nearness;
            }
            let [r, g, b] = patch.colour;
            Some((nearness, corners, Color32::from_rgb(r, g, b)))
        };
        let mut patches: Vec<_> = self.sketch.patches.iter().filter_map(seen).collect();
        patches.sort_by(|one, other| one.0.total_cmp(&other.0));
        let mut mesh = Mesh::with_texture(texture.id());
        for (_, corners, color) in patches {
            // The middle of the disc without a rim is white.
            add_square(&mut mesh, corners.map(|pos| Vertex { pos, uv: pos2(0.25, 0.5), color }));
        }
        Arc::new(mesh)
    }

    /// The position in the window of one in the picture, parts of its width and height.
    fn at(&self, [x, y]: [f64; 2]) -> Pos2 {
        self.rect.min + vec2(x as f32 * self.rect.width(), y as f32 * self.rect.height())
    }

    /// All discs as one mesh, the nearest last.
    fn discs(&self, texture: &TextureHandle) -> Arc<Mesh> {
        let Shown { stage, camera, .. } = &self.sketch.shown;
        let projection = camera.projection(stage, self.aspect());
        let seen = |disc: &corpuscle::pictures::Disc| {
            let ball = projection.ball(disc.position, disc.radius)?;
            let at = self.at(ball.at);
            let radius = (ball.radius as f32 * self.rect.height()).max(LEAST_RADIUS);
            let [r, g, b] = disc.colour;
            Some((ball.nearness, at, radius, Color32::from_rgb(r, g, b), disc.has_rim))
        };
        let mut discs: Vec<_> = self.sketch.discs.iter().filter_map(seen).collect();
        discs.sort_by(|one, other| one.0.total_cmp(&other.0));
        let mut mesh = Mesh::with_texture(texture.id());
        mesh.reserve_vertices(4 * discs.len());
        mesh.reserve_triangles(2 * discs.len());
        for (_, at, radius, color, has_rim) in discs {
            let left = if has_rim { 0.5 } else { 0.0 };
            let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]: [f32; 2]| Vertex {
                pos: at + radius * vec2(2.0 * x - 1.0, 2.0 * y - 1.0),
                uv: pos2(left + 0.5 * x, y),
                color,
            });
            add_square(&mut mesh, corners);
        }
        Arc::new(mesh)
    }
}

fn add_square(mesh: &mut Mesh, corners: [Vertex; 4]) {
    let first = mesh.vertices.len() as u32;
    mesh.vertices.extend(corners);
    mesh.add_triangle(first, first + 1, first + 2);
    mesh.add_triangle(first, first + 2, first + 3);
}

//! Axes, walls, marks and legend over a picture, drawn with the window's own text and lines.

use corpuscle::pictures::Shown;
use corpuscle_drawing::svg::Anchor;
use corpuscle_render::{Border, ColourTable, Key, LineStyle, Mark};
use egui::{Align2, Color32, CornerRadius, FontId, Mesh, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2};

/// Colours of text on light and on dark background, and of its outline on a lit picture.
const INK: [Color32; 2] = [Color32::from_rgb(0x3c, 0x46, 0x50), Color32::from_rgb(0xb8, 0xc2, 0xcc)];
const HALO: Color32 = Color32::from_rgba_premultiplied(150, 150, 150, 150);
/// Colours of thermal walls, trajectories and pistons.
const THERMAL_WALL: Color32 = Color32::from_rgb(0xe0, 0x6a, 0x10);
const TRAJECTORY: Color32 = Color32::from_rgb(0xc2, 0x18, 0x5b);
/// Edges of regions of measurement, on a light and on a dark ground.
const REGION: [Color32; 2] = [Color32::from_rgb(0x00, 0x70, 0x5f), Color32::from_rgb(0x4d, 0xc9, 0xb0)];
const PISTON: [Color32; 2] = [Color32::from_rgb(0x6b, 0x78, 0x85), Color32::from_rgb(0x7d, 0x89, 0x96)];
/// Thickness of a piston and its rod, points.
const BLOCK: f32 = 14.0;
const ROD: f32 = 8.0;
/// Width of the colour bar of a legend, height of a row, and space between entries, points.
const BAR: f32 = 130.0;
const ROW: f32 = 22.0;
const GAP: f32 = 20.0;

/// Draws the overlay of a picture that fills a rectangle.
pub struct Over<'a> {
    /// The picture.
    pub shown: &'a Shown,
    /// The rectangle that it fills.
    pub rect: Rect,
    /// The painter to draw with.
    pub painter: &'a Painter,
    /// True in the dark theme.
    pub dark: bool,
}

/// Height in points below which a picture has no key of colours.
const SMALL: f32 = 280.0;

impl Over<'_> {
    /// Draws the overlay; returns the height of its legend, points.
    pub fn paint(&self) -> f32 {
        self.axes();
        for border in &self.shown.overlay.borders {
            self.border(border);
        }
        for mark in &self.shown.overlay.marks {
            self.mark(mark);
        }
        for (position, label) in &self.shown.overlay.labels {
            if let Some(at) = self.position(*position) {
                self.text(at, Align2::CENTER_CENTER, label, 12.5);
            }
        }
        // A small picture, as in another page, would be covered by it.
        let key = if self.rect.height() < SMALL { 0.0 } else { self.key() };
        let corner = self.rect.right_bottom() - vec2(12.0, 10.0);
        self.text(corner, Align2::RIGHT_BOTTOM, &self.shown.overlay.remark, 11.5);
        key
    }

    /// The position in the window of a point of the world, m.
    pub fn position(&self, point: [f64; 3]) -> Option<Pos2> {
        position(self.shown, self.rect, point)
    }

    fn is_dark(&self) -> bool {
        self.dark && self.shown.on_paper
    }

    fn ink(&self) -> Color32 {
        INK[usize::from(self.is_dark())]
    }

    fn text(&self, at: Pos2, anchor: Align2, text: &str, size: f32) {
        let font = FontId::proportional(size);
        if !self.shown.on_paper {
            for off in [vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0)] {
                self.painter.text(at + off, anchor, text, font.clone(), HALO);
            }
        }
        self.painter.text(at, anchor, text, font, self.ink());
    }

    fn axes(&self) {
        let Some(axes) = &self.shown.overlay.axes else { return };
        let size = [f64::from(self.rect.width()), f64::from(self.rect.height())];
        let at = |[x, y]: [f64; 2]| self.rect.min + vec2(x as f32, y as f32);
        let line = Stroke::new(1.0, self.ink().gamma_multiply(0.8));
        for axis in axes.on_page(&self.shown.stage, &self.shown.camera, size) {
            let anchor = match axis.anchor {
                Anchor::Start => Align2::LEFT_CENTER,
                Anchor::Middle => Align2::CENTER_CENTER,
                Anchor::End => Align2::RIGHT_CENTER,
            };
            self.painter.line_segment(axis.line.map(at), line);
            for (tick, number_at, number) in &axis.ticks {
                self.painter.line_segment(tick.map(at), line);
                self.text(at(*number_at), anchor, number, 11.5);
            }
            self.text(at(axis.name.0), anchor, &axis.name.1, 12.0);
        }
    }

    fn line_of(&self, style: LineStyle) -> Stroke {
        let wall =
            if self.is_dark() { Color32::from_rgb(0xd6, 0xdd, 0xe4) } else { Color32::from_rgb(0x17, 0x21, 0x2b) };
        match style {
            LineStyle::Wall => Stroke::new(2.0, wall),
            LineStyle::ThermalWall => Stroke::new(3.5, THERMAL_WALL),
            LineStyle::Periodic => Stroke::new(1.2, self.ink()),
            LineStyle::Partition => Stroke::new(2.5, wall),
            LineStyle::Region => Stroke::new(1.8, REGION[usize::from(self.is_dark())]),
            LineStyle::Trajectory => Stroke::new(1.7, TRAJECTORY),
        }
    }

    fn stroke(&self, ends: [Pos2; 2], style: LineStyle) {
        let stroke = self.line_of(style);
        match style {
            LineStyle::Periodic => self.painter.extend(Shape::dashed_line(&ends, stroke, 5.0, 4.0)),
            _ => {
                self.painter.line_segment(ends, stroke);
            }
        }
    }

    fn border(&self, border: &Border) {
        let at = |[x, y]: [f64; 2]| self.position([x, y, 0.0]);
        // y is up in the world and down in the window.
        let out = |[x, y]: [f64; 2]| vec2(x as f32, -y as f32);
        match border {
            Border::Line { style, ends, outwards } => {
                let ([Some(one), Some(other)], stroke) = (ends.map(at), self.line_of(*style)) else { return };
                let beyond = out(*outwards) * 0.5 * stroke.width;
                self.stroke([one + beyond, other + beyond], *style);
            }
            Border::Piston { ends, outwards, rod } => {
                let [Some(one), Some(other)] = ends.map(at) else { return };
                let middle = std::array::from_fn(|k| 0.5 * (ends[0][k] + ends[1][k]));
                let tip = at(std::array::from_fn(|k| {
                    let middle: [f64; 2] = middle;
                    middle[k] + rod * outwards[k]
                }));
                let (Some(middle), Some(tip)) = (at(middle), tip) else { return };
                let (out, colour) = (out(*outwards), PISTON[usize::from(self.is_dark())]);
                let long = (tip - middle).length().max(BLOCK) + 8.0;
                let aside = vec2(out.y, out.x) * 0.5 * ROD;
                let rod = Rect::from_two_pos(middle - aside, middle + aside + out * long);
                let block = Rect::from_two_pos(one, other + out * BLOCK);
                self.painter.rect_filled(rod, CornerRadius::same(2), colour.gamma_multiply(0.8));
                self.painter.rect_filled(block, CornerRadius::same(2), colour);
            }
        }
    }

    fn mark(&self, mark: &Mark) {
        match mark {
            Mark::Start(position) => {
                let Some(at) = self.position(*position) else { return };
                self.painter.circle(at, 4.0, Color32::WHITE, Stroke::new(2.0, TRAJECTORY));
            }
            Mark::Ring(position, radius) => ring(self, *position, *radius, TRAJECTORY),
        }
    }

    /// Draws the legend of colours and lines; returns its height, points.
    fn key(&self) -> f32 {
        let overlay = &self.shown.overlay;
        let mut rows: Vec<(String, Row<'_>)> = match &overlay.key {
            Some(Key::Values(label, table)) => vec![(label.clone(), Row::Bar(table))],
            Some(Key::Kinds(kinds)) => {
                kinds.iter().map(|(name, [r, g, b])| (name.clone(), Row::Dot(Color32::from_rgb(*r, *g, *b)))).collect()
            }
            None => Vec::new(),
        };
        rows.extend(overlay.lines.iter().map(|(style, name)| (name.clone(), Row::Line(*style))));
        if rows.is_empty() {
            return 0.0;
        }
        let wide = |text: &str| self.painter.layout_no_wrap(text.into(), FontId::proportional(12.0), INK[0]).size().x;
        let widths: Vec<f32> = rows.iter().map(|(name, row)| row.width(&wide, name)).collect();
        let most = self.rect.width() - 24.0;
        // Wrapped to the width of the picture.
        let (mut lines, mut at) = (vec![0.0_f32], Vec::new());
        for width in widths {
            let line = lines.last_mut().expect("there is one at first");
            let line = if *line > 0.0 && *line + width > most {
                lines.push(0.0);
                lines.last_mut().expect("it was added")
            } else {
                line
            };
            let left = *line;
            *line += width + GAP;
            at.push(vec2(left, (lines.len() - 1) as f32 * ROW));
        }
        let width = lines.iter().copied().fold(0.0, f32::max) - GAP;
        let size = vec2(width, lines.len() as f32 * ROW) + vec2(18.0, 8.0);
        let panel = Rect::from_min_size(self.rect.min + vec2(12.0, 10.0), size);
        let (ground, ink) = match self.is_dark() {
            true => (Color32::TRANSPARENT, INK[1]),
            false if self.shown.on_paper => (Color32::TRANSPARENT, INK[0]),
            false => (Color32::from_rgba_unmultiplied(255, 255, 255, 200), INK[0]),
        };
        self.painter.rect_filled(panel, CornerRadius::same(7), ground);
        for ((name, row), off) in rows.iter().zip(at) {
            self.row(panel.min + vec2(9.0, 4.0) + off, name, row, ink, &wide);
        }
        panel.bottom() - self.rect.top()
    }

    fn row(&self, at: Pos2, name: &str, row: &Row<'_>, ink: Color32, wide: &impl Fn(&str) -> f32) {
        let text = |x: f32, text: &str| {
            let at = at + vec2(x, 0.5 * ROW);
            self.painter.text(at, Align2::LEFT_CENTER, text, FontId::proportional(12.0), ink)
        };
        match row {
            Row::Bar(table) => {
                let [low, high] = ends(table);
                let bar = wide(name) + 10.0 + wide(&low) + 6.0;
                text(0.0, name);
                text(wide(name) + 10.0, &low);
                self.painter.add(colours(Rect::from_min_size(at + vec2(bar, 0.5 * ROW - 4.5), vec2(BAR, 9.0)), table));
                text(bar + BAR + 6.0, &high);
            }
            Row::Dot(colour) => {
                self.painter.circle_filled(at + vec2(6.0, 0.5 * ROW), 5.5, *colour);
                text(17.0, name);
            }
            Row::Line(style) => {
                self.stroke([at + vec2(0.0, 0.5 * ROW), at + vec2(18.0, 0.5 * ROW)], *style);
                text(25.0, name);
            }
        }
    }
}

/// Draws a ring round a ball of a radius, m.
pub fn ring(over: &Over<'_>, position: [f64; 3], radius: f64, colour: Color32) {
    let Some(at) = over.position(position) else { return };
    let right = over.shown.camera.up.cross(over.shown.camera.eye - over.shown.camera.target).normalize_or_zero();
    let beside = over.position((glam::DVec3::from(position) + radius * right).into());
    let radius = beside.map_or(6.0, |beside| (beside - at).length());
    over.painter.circle_stroke(at, (radius + 3.0).max(7.0), Stroke::new(2.2, colour));
}

/// The position of a point of the world, m, in a rectangle that a picture fills.
pub fn position(shown: &Shown, rect: Rect, point: [f64; 3]) -> Option<Pos2> {
    let aspect = f64::from(rect.width()) / f64::from(rect.height());
    let [x, y] = shown.camera.project(&shown.stage, aspect, point)?;
    Some(pos2(rect.left() + x as f32 * rect.width(), rect.top() + y as f32 * rect.height()))
}

/// The sample in a row of the legend.
enum Row<'a> {
    Bar(&'a ColourTable),
    Dot(Color32),
    Line(LineStyle),
}

impl Row<'_> {
    fn width(&self, wide: &impl Fn(&str) -> f32, name: &str) -> f32 {
        match self {
            Self::Bar(table) => {
                let [low, high] = ends(table);
                wide(name) + 10.0 + wide(&low) + 6.0 + BAR + 6.0 + wide(&high)
            }
            Self::Dot(_) => 17.0 + wide(name),
            Self::Line(_) => 25.0 + wide(name),
        }
    }
}

/// The numbers at the ends of a bar.
fn ends(table: &ColourTable) -> [String; 2] {
    [table.low, table.high].map(|value| corpuscle_drawing::text::short_number(f64::from(value)))
}

/// The colours of a table from left to right.
fn colours(rect: Rect, table: &ColourTable) -> Mesh {
    const STEPS: u32 = 24;
    let mut mesh = Mesh::default();
    for step in 0..=STEPS {
        let part = step as f32 / STEPS as f32;
        let [r, g, b] = table.colour(table.low + part * (table.high - table.low));
        let x = rect.left() + part * rect.width();
        mesh.colored_vertex(pos2(x, rect.top()), Color32::from_rgb(r, g, b));
        mesh.colored_vertex(pos2(x, rect.bottom()), Color32::from_rgb(r, g, b));
        if step > 0 {
            let at = 2 * step;
            mesh.add_triangle(at - 2, at - 1, at);
            mesh.add_triangle(at - 1, at + 1, at);
        }
    }
    mesh
}

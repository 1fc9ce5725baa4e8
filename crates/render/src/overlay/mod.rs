//! The overlay of a picture: title, time, legend, scale bar, axes.

mod axes;
mod borders;
mod key;
mod north;

pub use axes::AxisOnPage;

use crate::{Camera, ColourTable, Lens, RenderError, Stage};
use corpuscle_drawing::bars::{scale_bar, scale_bar_width};
use corpuscle_drawing::png::svg_to_pixels;
use corpuscle_drawing::svg::{Anchor, Figure, Svg};
use corpuscle_drawing::text::prefix;
use corpuscle_gpu::Image;

/// Height of a picture in CSS pixels: letters keep their part of it.
const HEIGHT: f64 = 720.0;
/// Margin between the picture's border and the overlay.
const MARGIN: f64 = 26.0;
/// Width of a letter.
const LETTER: f64 = 7.0;
/// Height of a line of the caption, and its width at most, part of the picture's.
const LINE: f64 = 19.0;
const CAPTION: f64 = 0.6;
/// Space round an inset.
const PADDING: f64 = 10.0;

/// The overlay of a picture. Empty texts are left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Overlay {
    /// Title.
    pub title: String,
    /// The time.
    pub time: String,
    /// What colours mean.
    pub key: Option<Key>,
    /// Position of the legend.
    pub key_position: KeyPosition,
    /// Legend of the lines, drawn with that of the colours.
    pub lines: Vec<(LineStyle, String)>,
    /// A remark, in small letters in the lower right corner.
    pub remark: String,
    /// The sides of a flat box, and what stands in it.
    pub borders: Vec<Border>,
    /// Marks.
    pub marks: Vec<Mark>,
    /// Texts at positions, m.
    pub labels: Vec<([f64; 3], String)>,
    /// A bar of a round length, with this unit (empty in reduced units), where the lens is to scale.
    pub scale_bar: Option<String>,
    /// Axes along the edges of a box.
    pub axes: Option<Axes>,
    /// An arrow towards north, the world's y, in the upper right corner.
    pub north: bool,
    /// A text below the title.
    pub caption: String,
    /// A small drawing in a lower corner, where no legend stands.
    pub inset: Option<Figure>,
}

/// What colours mean.
#[derive(Debug, Clone, PartialEq)]
pub enum Key {
    /// A quantity with its unit, and the colours of its values.
    Values(String, ColourTable),
    /// Kinds of things with a colour each.
    Kinds(Vec<(String, [u8; 3])>),
}

/// Position of the legend.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum KeyPosition {
    /// In the lower left corner of the picture.
    #[default]
    Corner,
    /// In a row below the axes.
    Below,
    /// In a column to the right of the axes.
    Beside,
}

/// Style of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LineStyle {
    /// A wall.
    Wall,
    /// A thermal wall.
    ThermalWall,
    /// A periodic side: a dashed line.
    Periodic,
    /// A thin wall inside.
    Partition,
    /// An edge of a region of measurement.
    Region,
    /// A trajectory.
    Trajectory,
}

/// A side of a flat box, or what stands in it.
#[derive(Debug, Clone, PartialEq)]
pub enum Border {
    /// A line between two points, m, moved out of the box by half its width.
    Line {
        /// Its style.
        style: LineStyle,
        /// Its ends, m.
        ends: [[f64; 2]; 2],
        /// Outward unit normal of the box; 0 inside.
        outwards: [f64; 2],
    },
    /// A block that moves, with a rod.
    Piston {
        /// Ends of its inner face, m.
        ends: [[f64; 2]; 2],
        /// Outward unit normal of the box.
        outwards: [f64; 2],
        /// Length of the rod, m.
        rod: f64,
    },
}

/// A mark.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mark {
    /// A white dot: the start of a trajectory.
    Start([f64; 3]),
    /// A ring round a ball of this radius, m: the ball of the trajectory.
    Ring([f64; 3], f64),
}

/// Axes along the edges of a box.
#[derive(Debug, Clone, PartialEq)]
pub struct Axes {
    /// Smallest corner, m.
    pub from: [f64; 3],
    /// Largest corner, m; flat where the third numbers are equal.
    pub to: [f64; 3],
    /// Unit of lengths; empty in reduced units.
    pub unit: String,
    /// Exaggeration of lengths along z.
    pub heights: f64,
}

/// The page that is drawn on, in CSS pixels.
struct Page<'a> {
    svg: Svg,
    size: [f64; 2],
    stage: &'a Stage,
    camera: &'a Camera,
}

/// Projection of the world to a page.
struct Sheet<'a> {
    size: [f64; 2],
    stage: &'a Stage,
    camera: &'a Camera,
}

impl Sheet<'_> {
    /// Position on the page of a point of the world, m.
    fn position(&self, point: [f64; 3]) -> Option<[f64; 2]> {
        let [width, height] = self.size;
        let [x, y] = self.camera.project(self.stage, width / height, point)?;
        Some([x * width, y * height])
    }
}

impl Page<'_> {
    /// Position on the page of a point of the world, m.
    fn position(&self, point: [f64; 3]) -> Option<[f64; 2]> {
        Sheet { size: self.size, stage: self.stage, camera: self.camera }.position(point)
    }
}

impl Overlay {
    /// The overlay as an image for a picture of `size` pixels.
    ///
    /// # Errors
    /// [`RenderError::Overlay`].
    pub fn image(&self, stage: &Stage, camera: &Camera, size: [u32; 2]) -> Result<Image, RenderError> {
        let scale = f64::from(size[1]) / HEIGHT;
        let figure = self.figure(stage, camera, size);
        let (width, height, rgba) = svg_to_pixels(&figure, scale as f32).map_err(RenderError::Overlay)?;
        Ok(fitted(Image { width, height, rgba }, size))
    }

    /// The overlay as a drawing for a picture of `size` pixels: 720 units high, so that letters keep their part of the picture.
    pub fn figure(&self, stage: &Stage, camera: &Camera, size: [u32; 2]) -> Figure {
        let scale = f64::from(size[1]) / HEIGHT;
        let mut page = Page { svg: Svg::default(), size: [f64::from(size[0]) / scale, HEIGHT], stage, camera };
        if let Some(axes) = &self.axes {
            axes.draw(&mut page);
        }
        page.svg.text([MARGIN, MARGIN + 18.0], Anchor::Start, "over-title", &self.title);
        page.svg.text([page.size[0] - MARGIN, MARGIN + 18.0], Anchor::End, "over-title", &self.time);
        borders::draw(&mut page, &self.borders);
        self.marks.iter().for_each(|mark| borders::draw_mark(&mut page, mark));
        for (position, label) in &self.labels {
            if let Some([x, y]) = page.position(*position) {
                page.svg.text([x, y + 5.0], Anchor::Middle, "over", label);
            }
        }
        self.draw_key(&mut page);
        page.svg.text([page.size[0] - MARGIN, HEIGHT - MARGIN + 8.0], Anchor::End, "over-number", &self.remark);
        self.draw_caption(&mut page);
        let bottom = self.draw_scale_bar(&mut page);
        self.draw_inset(&mut page, bottom);
        if self.north {
            north::draw(&mut page);
        }
        page.svg.finish(page.size, &self.title)
    }

    fn draw_caption(&self, page: &mut Page<'_>) {
        let letters = (CAPTION * page.size[0] / LETTER) as usize;
        for (number, line) in lines(&self.caption, letters).iter().enumerate() {
            let baseline = MARGIN + 40.0 + LINE * number as f64;
            page.svg.text([MARGIN, baseline], Anchor::Start, "over", line);
        }
    }

    /// Draws the scale bar, where the lens is to scale; returns where the corner is free above it.
    fn draw_scale_bar(&self, page: &mut Page<'_>) -> f64 {
        let free = HEIGHT - MARGIN - if self.remark.is_empty() { 0.0 } else { 20.0 };
        let (Some(unit), Lens::Orthographic { height }) = (&self.scale_bar, page.camera.lens) else { return free };
        let at = [page.size[0] - MARGIN - 10.0, HEIGHT - MARGIN - 24.0];
        let scale = HEIGHT / height;
        // As wide as the bar, and as its length in words.
        let width = scale_bar_width(scale).max(60.0);
        page.svg.rectangle([at[0] - width - 10.0, at[1] - 8.0], [width + 20.0, 38.0], "panel");
        scale_bar(&mut page.svg, scale, unit, at);
        at[1] - 20.0
    }

    /// Draws the inset, in the right corner above a height on the page.
    fn draw_inset(&self, page: &mut Page<'_>, bottom_right: f64) {
        let Some(inset) = &self.inset else { return };
        let [width, height] = inset.size().map(|length| length + 2.0 * PADDING);
        let has_legend = self.key.is_some() || !self.lines.is_empty();
        let corner = |axes: &Axes| Some([page.position(axes.to)?[0] - PADDING, page.position(axes.from)?[1] - PADDING]);
        let [left, bottom] = match (self.key_position, self.axes.as_ref().and_then(corner)) {
            // Legend and numbers stand round the axes, so it lies within them.
            (KeyPosition::Below | KeyPosition::Beside, Some([right, bottom])) => [right - width, bottom],
            (KeyPosition::Corner, _) if has_legend => [page.size[0] - MARGIN - width, bottom_right],
            _ => [MARGIN, HEIGHT - MARGIN],
        };
        page.svg.rectangle([left, bottom - height], [width, height], "inset");
        page.svg.place([left + PADDING, bottom - height + PADDING], inset);
    }
}

/// A text broken between words into lines of so many letters at most; a longer word has a line of its own.
fn lines(text: &str, letters: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= letters => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// An image cut or padded to a size: the page's width need not be whole pixels.
fn fitted(image: Image, [width, height]: [u32; 2]) -> Image {
    if [image.width, image.height] == [width, height] {
        return image;
    }
    let mut rgba = vec![0; 4 * width as usize * height as usize];
    let row = 4 * width.min(image.width) as usize;
    for (to, from) in rgba.chunks_exact_mut(4 * width as usize).zip(image.rgba.chunks_exact(4 * image.width as usize)) {
        to[..row].copy_from_slice(&from[..row]);
    }
    Image { width, height, rgba }
}

/// Divisor of the numbers of axes, and prefix of their unit, where the longest axis has this length.
fn axis_unit(longest: f64, unit: &str) -> (f64, String) {
    if unit.is_empty() {
        return (1.0, String::new());
    }
    // Up to a few thousand reads well: 2000 m, not 2 km.
    let (factor, prefix) = prefix(0.2 * longest);
    (factor, format!("{prefix}{unit}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn captions_are_broken_between_words() {
        assert_eq!(lines("", 10), Vec::<String>::new());
        assert_eq!(lines("a dam breaks  over\na sill", 12), ["a dam breaks", "over a sill"]);
        assert_eq!(lines("Überschwemmungsgebiet am Fluss", 8), ["Überschwemmungsgebiet", "am Fluss"]);
    }
}

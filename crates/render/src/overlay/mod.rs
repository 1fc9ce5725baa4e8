//! What lies over a picture: title, time, the key of colours, scale bar, axes.

mod axes;

use crate::{Camera, ColourTable, Lens, RenderError, Stage};
use corpuscle_drawing::bars::{prefix, scale_bar, value_bar};
use corpuscle_drawing::colour::hex;
use corpuscle_drawing::png::svg_to_pixels;
use corpuscle_drawing::svg::{Anchor, Svg};
use corpuscle_gpu::Image;

/// Height of a picture in CSS pixels: letters keep their part of it.
const HEIGHT: f64 = 720.0;
/// Space between the picture's border and what lies over it.
const MARGIN: f64 = 26.0;
/// Width of a bar of colours, and of a letter.
const BAR: f64 = 240.0;
const LETTER: f64 = 7.0;

/// What lies over a picture. Empty texts are left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Overlay {
    /// What is seen.
    pub title: String,
    /// The time.
    pub time: String,
    /// What colours mean.
    pub key: Option<Key>,
    /// A bar of a round length, with this unit (empty in reduced units), where the lens is to scale.
    pub scale_bar: Option<String>,
    /// Axes along the edges of a box.
    pub axes: Option<Axes>,
}

/// What colours mean.
#[derive(Debug, Clone, PartialEq)]
pub enum Key {
    /// A quantity with its unit, and the colours of its values.
    Values(String, ColourTable),
    /// Kinds of things with a colour each.
    Kinds(Vec<(String, [u8; 3])>),
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
    /// How many times larger than they are lengths along z are drawn.
    pub heights: f64,
}

/// The page that is drawn on, in CSS pixels.
struct Page<'a> {
    svg: Svg,
    size: [f64; 2],
    stage: &'a Stage,
    camera: &'a Camera,
}

impl Page<'_> {
    /// Where a place of the world, m, is on the page.
    fn place(&self, point: [f64; 3]) -> Option<[f64; 2]> {
        let [width, height] = self.size;
        let [x, y] = self.camera.project(self.stage, width / height, point)?;
        Some([x * width, y * height])
    }
}

impl Overlay {
    /// The overlay as an image for a picture of `size` pixels.
    ///
    /// # Errors
    /// [`RenderError::Overlay`].
    pub fn image(&self, stage: &Stage, camera: &Camera, size: [u32; 2]) -> Result<Image, RenderError> {
        let scale = f64::from(size[1]) / HEIGHT;
        let mut page = Page { svg: Svg::default(), size: [f64::from(size[0]) / scale, HEIGHT], stage, camera };
        if let Some(axes) = &self.axes {
            axes.draw(&mut page);
        }
        page.svg.text([MARGIN, MARGIN + 18.0], Anchor::Start, "over-title", &self.title);
        page.svg.text([page.size[0] - MARGIN, MARGIN + 18.0], Anchor::End, "over-title", &self.time);
        match &self.key {
            Some(Key::Values(label, table)) => draw_values(&mut page, label, table),
            Some(Key::Kinds(kinds)) => draw_kinds(&mut page, kinds),
            None => {}
        }
        if let (Some(unit), Lens::Orthographic { height }) = (&self.scale_bar, camera.lens) {
            let at = [page.size[0] - MARGIN - 10.0, HEIGHT - MARGIN - 24.0];
            panel(&mut page.svg, [at[0] - 190.0, at[1] - 8.0], [200.0, 38.0]);
            scale_bar(&mut page.svg, HEIGHT / height, unit, at);
        }
        let figure = page.svg.finish(page.size, &self.title);
        let (width, height, rgba) = svg_to_pixels(&figure, scale as f32).map_err(RenderError::Overlay)?;
        Ok(fitted(Image { width, height, rgba }, size))
    }
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

fn panel(svg: &mut Svg, place: [f64; 2], size: [f64; 2]) {
    svg.rectangle(place, size, "panel");
}

fn draw_values(page: &mut Page<'_>, label: &str, table: &ColourTable) {
    let top = HEIGHT - MARGIN - 56.0;
    panel(&mut page.svg, [MARGIN - 12.0, top - 12.0], [BAR + 40.0, 74.0]);
    page.svg.text([MARGIN + 2.0, top + 4.0], Anchor::Start, "text", label);
    let range = [f64::from(table.low), f64::from(table.high)];
    let colour = |part: f64| table.colour(table.low + (table.high - table.low) * part as f32);
    value_bar(&mut page.svg, range, colour, [MARGIN + 8.0, top + 14.0], BAR);
}

fn draw_kinds(page: &mut Page<'_>, kinds: &[(String, [u8; 3])]) {
    let longest = kinds.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0) as f64;
    let top = HEIGHT - MARGIN - 20.0 * kinds.len() as f64;
    panel(&mut page.svg, [MARGIN - 12.0, top - 6.0], [longest * LETTER + 50.0, 20.0 * kinds.len() as f64 + 12.0]);
    for (row, (name, colour)) in kinds.iter().enumerate() {
        let y = top + 10.0 + 20.0 * row as f64;
        page.svg.circles([([MARGIN + 6.0, y], 6.0)], &hex(*colour), "balls");
        page.svg.text([MARGIN + 20.0, y + 4.0], Anchor::Start, "text", name);
    }
}

/// What the numbers of axes are divided by, and its name, where the longest has this length.
fn axis_unit(longest: f64, unit: &str) -> (f64, String) {
    if unit.is_empty() {
        return (1.0, String::new());
    }
    // Up to a few thousand reads well: 2000 m, not 2 km.
    let (factor, prefix) = prefix(0.2 * longest);
    (factor, format!("{prefix}{unit}"))
}

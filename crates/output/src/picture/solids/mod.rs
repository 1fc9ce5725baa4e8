//! Pictures of solids: drops true to scale, or a field in colours.

mod drops;
mod field;
mod trace;
mod view;

pub(crate) use drops::Cap;
pub(crate) use view::{Vector, View};

use super::bars::{scale_bar, value_bar};
use super::colour::of_part;
use super::png::{data_url, encode_rgb};
use super::svg::{Anchor, Figure, Svg};
use corpuscle_model::{SolidShape, Surface};
use drops::{light, mix};
use field::Field;
use rayon::prelude::*;
use trace::{Hit, Screen};
use view::dot;

/// Solids to be drawn.
pub(crate) struct SolidsPicture<'a> {
    pub surfaces: &'a [Surface],
    /// Corners of the room; parts of solids beyond are cut off.
    pub room: [Vector; 2],
    pub view: View,
    /// Largest width and height, CSS pixels.
    pub most: [f64; 2],
}

/// Colour of a solid that faces the light, and of the background.
const SOLID: Vector = [116.0, 139.0, 152.0];
const BEHIND: Vector = [240.0, 243.0, 246.0];

/// Pixels for a CSS pixel.
const FINENESS: f64 = 1.7;

/// A picture narrower than this has no room for words and a scale bar side by side, CSS pixels.
const BESIDE: f64 = 420.0;

/// Room round the solids, over their size.
const MARGIN: f64 = 0.03;

impl SolidsPicture<'_> {
    /// Drops on the solids, with a scale bar, `caption` and a smaller `note` below.
    ///
    /// # Errors
    /// What cannot be encoded.
    pub(crate) fn drops(&self, caps: &[Cap], caption: &str, note: &str) -> Result<Figure, String> {
        let (screen, hits) = self.seen();
        let mut colours = plain(&screen, &hits);
        drops::draw(&screen, caps, &hits, self.mist(&hits), &mut colours);
        self.compose(&screen, &colours, |svg, top, width| {
            svg.text([0.0, top + 16.0], Anchor::Start, "text", caption);
            svg.text([0.0, top + 33.0], Anchor::Start, "small", note);
            let words = if note.is_empty() { 22.0 } else { 40.0 };
            let bar = bar_below(width, top, words);
            scale_bar(svg, 1.0 / (screen.pixel * FINENESS), "m", bar);
            (top + words).max(bar[1] + 26.0)
        })
    }

    /// The field `values` on the first of the solids, from 0 to its largest value, `title` with unit below.
    ///
    /// # Errors
    /// What cannot be encoded.
    pub(crate) fn field(&self, values: &[f64], title: &str) -> Result<Figure, String> {
        let (screen, hits) = self.seen();
        let most = values.iter().copied().filter(|value| value.is_finite()).fold(0.0, f64::max);
        let most = if most > 0.0 { most } else { 1.0 };
        let field = Field::new(&self.surfaces[0], values);
        let mut colours = plain(&screen, &hits);
        for (colour, hit) in colours.iter_mut().zip(&hits).filter(|(_, hit)| hit.solid == Some(0)) {
            if let Some(value) = field.at(hit.position, hit.normal) {
                let bright = 0.85 + 0.15 * (-dot(hit.normal, screen.view.ahead)).max(0.0);
                let shown = of_part(value / most).map(|channel| f64::from(channel) * bright);
                *colour = mix(BEHIND, shown, hit.cover);
            }
        }
        self.compose(&screen, &colours, |svg, top, width| {
            svg.text([0.0, top + 16.0], Anchor::Start, "text", title);
            let bar = bar_below(width, top, 24.0);
            scale_bar(svg, 1.0 / (screen.pixel * FINENESS), "m", bar);
            value_bar(
                svg,
                [0.0, most],
                of_part,
                [14.0, (top + 24.0).max(bar[1] + 30.0)],
                (0.7 * width).clamp(150.0, 300.0),
            )
        })
    }

    /// The part of each pixel that drops too small to be followed cover.
    fn mist(&self, hits: &[Hit]) -> Vec<f64> {
        let covered = self.surfaces.iter().map(|surface| {
            let part = surface.scalar("unseen_covered_part").filter(|part| part.iter().any(|&part| part > 0.0))?;
            Some(Field::new(surface, part))
        });
        let parts: Vec<Option<Field<'_>>> = covered.collect();
        let of = |hit: &Hit| {
            let part = parts[hit.solid?].as_ref()?;
            part.at(hit.position, hit.normal)
        };
        hits.par_iter().with_min_len(256).map(|hit| of(hit).unwrap_or(0.0)).collect()
    }

    fn seen(&self) -> (Screen, Vec<Hit>) {
        let shapes: Vec<SolidShape> = self.surfaces.iter().map(|surface| surface.shape.clone()).collect();
        let screen = self.screen(&shapes);
        let hits = screen.trace(&shapes, self.room);
        (screen, hits)
    }

    fn screen(&self, shapes: &[SolidShape]) -> Screen {
        let boxes = shapes.iter().map(|shape| {
            let [from, to] = shape.bounds;
            let clipped = [
                std::array::from_fn(|axis| from[axis].max(self.room[0][axis])),
                std::array::from_fn(|axis| to[axis].min(self.room[1][axis])),
            ];
            self.view.around(clipped)
        });
        let start = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        let [low, high] = boxes.fold(start, |[low, high], [from, to]| {
            [[0, 1].map(|k| low[k].min(from[k])), [0, 1].map(|k| high[k].max(to[k]))]
        });
        let margin = MARGIN * (high[0] - low[0]).max(high[1] - low[1]);
        let [width, height] = [0, 1].map(|k| high[k] - low[k] + 2.0 * margin);
        let pixel = (width / self.most[0]).max(height / self.most[1]) / FINENESS;
        let count = |length: f64| ((length / pixel).ceil() as usize).max(1);
        Screen {
            view: self.view,
            corner: [low[0] - margin, high[1] + margin],
            pixel,
            width: count(width),
            height: count(height),
        }
    }

    /// The pixels as a figure, with what `below` draws under them; it gives its lower end.
    fn compose(
        &self,
        screen: &Screen,
        colours: &[Vector],
        below: impl FnOnce(&mut Svg, f64, f64) -> f64,
    ) -> Result<Figure, String> {
        let bytes: Vec<u8> = colours.iter().flatten().map(|value| value.round().clamp(0.0, 255.0) as u8).collect();
        let url = data_url(&encode_rgb(screen.width as u32, screen.height as u32, &bytes)?);
        let size = [screen.width, screen.height].map(|pixels| pixels as f64 / FINENESS);
        let mut svg = Svg::default();
        svg.image([0.0, 0.0], size, &url, 1.0);
        let width = size[0].max(330.0);
        let end = below(&mut svg, size[1] + 6.0, size[0]);
        Ok(svg.finish([width, end + 6.0], "Solids and the drops on them"))
    }
}

/// Where the scale bar ends, right and top: beside the words under a picture, or below them where it is narrow.
fn bar_below(width: f64, top: f64, words: f64) -> [f64; 2] {
    if width < BESIDE { [width.max(110.0) - 8.0, top + words + 4.0] } else { [width - 8.0, top + 6.0] }
}

/// The solids alone.
fn plain(screen: &Screen, hits: &[Hit]) -> Vec<Vector> {
    let light = light(screen);
    let colour = |hit: &Hit| match hit.solid {
        None => BEHIND,
        Some(_) => {
            let lit = dot(hit.normal, light).max(0.0);
            mix(BEHIND, SOLID.map(|channel| channel * (0.62 + 0.38 * lit)), hit.cover)
        }
    };
    hits.iter().map(colour).collect()
}

//! Balls in their box: flat in two dimensions, as shaded spheres in three.

mod flat;
mod key;
mod paint;
mod space;

use super::colour::Colour;
use super::svg::{Anchor, Figure, Svg};

/// A ball to be drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Disc {
    pub position: [f64; 3],
    pub radius: f64,
    pub colour: Colour,
}

/// How a side of the box is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    /// A wall.
    Wall,
    /// A wall at a temperature.
    Hot,
    /// No wall: what leaves comes in on the other side.
    Open,
    /// A wall that moves.
    Piston,
    /// No wall: what is in the box comes in or leaves there.
    Passage,
}

/// A thin wall across the box.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Across {
    /// Number of the axis that it stands across, and its position there.
    pub axis: usize,
    pub at: f64,
    /// A hole: from and to along the other axes.
    pub hole: Option<[Vec<f64>; 2]>,
}

/// The legend of the colours of balls.
#[derive(Debug, Clone, PartialEq)]
pub enum Key {
    /// Each kind of balls has its own: name and colour.
    Kinds(Vec<(String, Colour)>),
    /// Speed, from 0 to this, with its unit.
    Speed {
        /// The speed that has the last colour.
        most: f64,
        /// Its unit; empty in reduced units.
        unit: &'static str,
    },
}

/// Balls in their box.
#[derive(Debug, Clone)]
pub(crate) struct Balls {
    /// 2 or 3.
    pub dimensions: usize,
    /// Corners of the box now; in two dimensions the third numbers are 0.
    pub from: [f64; 3],
    pub to: [f64; 3],
    /// Corners of what the picture shows: pictures with the same are to the same scale.
    pub view: [[f64; 3]; 2],
    pub sides: [[Side; 2]; 3],
    pub partition: Option<Across>,
    pub discs: Vec<Disc>,
    /// Trajectory of one ball, and the ball.
    pub trajectory: Vec<[f64; 3]>,
    pub followed: Option<Disc>,
    pub key: Key,
    /// Unit of lengths, for the scale bar; empty in reduced units.
    pub unit: &'static str,
}

/// Largest width and height of a picture of the box, CSS pixels.
const MOST: [f64; 2] = [940.0, 700.0];

/// Width of the picture of a moment, one of three in a row.
const MOMENT: f64 = 314.0;

impl Balls {
    /// The picture with its key, and a title and subtitle above it if they are given.
    ///
    /// # Errors
    /// What cannot be encoded.
    pub(crate) fn figure(&self, heading: Option<[&str; 2]>) -> Result<Figure, String> {
        let picture = self.picture(1.0)?;
        let mut svg = Svg::default();
        let top = match heading {
            Some([title, subtitle]) => {
                svg.text([2.0, 28.0], Anchor::Start, "title heading", title);
                svg.text([2.0, 48.0], Anchor::Start, "small", subtitle);
                62.0
            }
            None => 4.0,
        };
        let [width, height] = picture.size();
        let page = MOST[0] + 2.0 * flat::MARGIN;
        svg.place([0.5 * (page - width), top], &picture);
        let end = self.draw_key(&mut svg, [2.0, top + height + 14.0], page, self.pixels_per_length());
        Ok(svg.finish([page, end], heading.map_or("Balls in their box", |[title, _]| title)))
    }

    /// The picture alone, small, with a caption below.
    ///
    /// # Errors
    /// What cannot be encoded.
    pub(crate) fn moment(&self, caption: &str) -> Result<Figure, String> {
        let [width, _] = self.picture_size();
        let scale = MOMENT / width;
        let picture = self.picture(scale)?;
        let height = picture.size()[1] * scale;
        let mut svg = Svg::default();
        svg.place_scaled([0.0, 2.0], scale, &picture);
        svg.text([2.0, height + 18.0], Anchor::Start, "text", caption);
        Ok(svg.finish([MOMENT, height + 26.0], caption))
    }

    /// The picture, drawn finely enough to be shown at `scale`.
    fn picture(&self, scale: f64) -> Result<Figure, String> {
        if self.dimensions == 2 { flat::picture(self, scale) } else { space::picture(self, scale) }
    }

    fn picture_size(&self) -> [f64; 2] {
        if self.dimensions == 2 { flat::size(self) } else { space::size(self) }
    }

    /// CSS pixels for a unit of length; none where near and far differ.
    fn pixels_per_length(&self) -> Option<f64> {
        (self.dimensions == 2).then(|| flat::scale(self))
    }
}

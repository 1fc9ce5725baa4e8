//! Pictures: charts and maps as SVG, and as PNG from the same SVG. They know no physics.

mod balls;
mod chart;
mod classes;
mod clip;
mod ground;
mod map;
mod plot;
mod relief;
mod resample;
mod solids;
mod window;

use corpuscle_drawing::{bars, colour, png, style, svg, text, ticks};

pub use balls::Key;
pub(crate) use balls::{Across, Balls, Disc, Side};
pub(crate) use chart::{Chart, Series};
pub(crate) use classes::{Classes, Ramp};
pub(crate) use colour::{Colour, from_hex, of_part};
pub(crate) use ground::Ground;
pub(crate) use map::{Layer, MapFigure, MapMark, MarkKind, Size, ground_image, heading, legend};
pub(crate) use plot::plot;
pub(crate) use png::{data_url, svg_to_png, svg_url};
pub(crate) use solids::{Cap, SolidsPicture, Vector, View};
pub(crate) use style::{FIGURE_CSS, Theme};
pub(crate) use svg::{Figure, beside, escape, stack};
pub(crate) use text::{area, number, short_number, time, volume};
pub(crate) use window::Window;

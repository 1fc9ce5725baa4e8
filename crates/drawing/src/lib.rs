//! Drawings as SVG and PNG: elements, a style sheet with the fonts that come along, numbers as people read them, round values
//! along axes, colours, and bars that say what colours and lengths mean. Knows no models and no files.

pub mod bars;
pub mod colour;
pub mod fonts;
pub mod png;
pub mod style;
pub mod svg;
pub mod text;
pub mod ticks;

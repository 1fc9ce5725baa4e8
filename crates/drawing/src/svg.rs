//! SVG, element by element.

use crate::style::{FIGURE_CSS, Theme};
use std::fmt::Write;

/// A drawing in the making. Units are CSS pixels, y downwards.
#[derive(Debug, Clone, Default)]
pub struct Svg {
    body: String,
}

/// A finished drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    width: f64,
    height: f64,
    /// Alternative text.
    title: String,
    body: String,
}

/// Which end of a text stands at its position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// Its start.
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

impl Anchor {
    fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Middle => "middle",
            Self::End => "end",
        }
    }
}

/// Text with the letters escaped that mean something in XML and HTML; control characters become spaces.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            '\n' => escaped.push('\n'),
            control if control.is_control() => escaped.push(' '),
            other => escaped.push(other),
        }
    }
    escaped
}

/// Coordinates to the hundredth of a pixel, without needless zeros.
fn at(value: f64) -> f64 {
    let rounded = (value * 100.0).round() / 100.0;
    if rounded == 0.0 { 0.0 } else { rounded }
}

impl Svg {
    /// A straight line.
    pub fn line(&mut self, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2], class: &str) {
        let [x1, y1, x2, y2] = [x1, y1, x2, y2].map(at);
        self.put(format_args!(r#"<line x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2}" class="{class}"/>"#));
    }

    /// A rectangle.
    pub fn rectangle(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], class: &str) {
        let [x, y, width, height] = [x, y, width, height].map(at);
        self.put(format_args!(r#"<rect x="{x}" y="{y}" width="{width}" height="{height}" class="{class}"/>"#));
    }

    /// A rectangle of a given colour.
    pub fn swatch(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], colour: &str) {
        let [x, y, width, height] = [x, y, width, height].map(at);
        self.put(format_args!(
            r#"<rect x="{x}" y="{y}" width="{width}" height="{height}" fill="{colour}" class="swatch"/>"#
        ));
    }

    /// A circle.
    pub fn circle(&mut self, [x, y]: [f64; 2], radius: f64, class: &str) {
        let [x, y, radius] = [x, y, radius].map(at);
        self.put(format_args!(r#"<circle cx="{x}" cy="{y}" r="{radius}" class="{class}"/>"#));
    }

    /// A text whose baseline starts, is centred or ends at a position.
    pub fn text(&mut self, [x, y]: [f64; 2], anchor: Anchor, class: &str, text: &str) {
        let ([x, y], anchor, text) = ([x, y].map(at), anchor.name(), escape(text));
        self.put(format_args!(r#"<text x="{x}" y="{y}" text-anchor="{anchor}" class="{class}">{text}</text>"#));
    }

    /// A circle of a class, with declarations of its own.
    pub fn styled_circle(&mut self, [x, y]: [f64; 2], radius: f64, class: &str, style: &str) {
        let [x, y, radius] = [x, y, radius].map(at);
        self.put(format_args!(r#"<circle cx="{x}" cy="{y}" r="{radius}" class="{class}" style="{style}"/>"#));
    }

    /// Circles of one class and fill.
    pub fn circles(&mut self, circles: impl IntoIterator<Item = ([f64; 2], f64)>, fill: &str, class: &str) {
        self.put(format_args!(r#"<g fill="{fill}" class="{class}">"#));
        for ([x, y], radius) in circles {
            let [x, y, radius] = [x, y, radius].map(at);
            self.put(format_args!(r#"<circle cx="{x}" cy="{y}" r="{radius}"/>"#));
        }
        self.put(format_args!("</g>"));
    }

    /// A line through points, closed or not; one that is not a number breaks it.
    pub fn path(&mut self, points: impl IntoIterator<Item = [f64; 2]>, closed: bool, class: &str) {
        self.styled_path(points, closed, class, "");
    }

    /// A [`Svg::path`] with declarations of its own.
    pub fn styled_path(&mut self, points: impl IntoIterator<Item = [f64; 2]>, closed: bool, class: &str, style: &str) {
        let mut data = String::new();
        let mut command = 'M';
        for point in points {
            if point.iter().all(|value| value.is_finite()) {
                let [x, y] = point.map(at);
                let _ = write!(data, "{command}{x} {y}");
                command = 'L';
            } else {
                command = 'M';
            }
        }
        if closed {
            data.push('Z');
        }
        let style = if style.is_empty() { String::new() } else { format!(r#" style="{style}""#) };
        self.put(format_args!(r#"<path d="{data}" class="{class}"{style}/>"#));
    }

    /// A picture stretched over a rectangle.
    pub fn image(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], url: &str, opacity: f64) {
        let [x, y, width, height] = [x, y, width, height].map(at);
        self.put(format_args!(
            r#"<image x="{x}" y="{y}" width="{width}" height="{height}" preserveAspectRatio="none" image-rendering="smooth" opacity="{opacity}" href="{url}"/>"#
        ));
    }

    /// Something that stands elsewhere on the page, one unit wide and high, stretched over a rectangle.
    pub fn reuse(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], reference: &str) {
        let [x, y, width, height] = [x, y, width, height].map(at);
        self.put(format_args!(r#"<use href="{reference}" transform="translate({x} {y}) scale({width} {height})"/>"#));
    }

    /// Another drawing, moved.
    pub fn place(&mut self, [x, y]: [f64; 2], figure: &Figure) {
        let ([x, y], body) = ([x, y].map(at), &figure.body);
        self.put(format_args!(r#"<g transform="translate({x} {y})">{body}</g>"#));
    }

    /// Another drawing, moved and made larger or smaller.
    pub fn place_scaled(&mut self, [x, y]: [f64; 2], scale: f64, figure: &Figure) {
        let ([x, y], body) = ([x, y].map(at), &figure.body);
        self.put(format_args!(r#"<g transform="translate({x} {y}) scale({scale:.4})">{body}</g>"#));
    }

    /// The finished drawing; `title` says what is seen.
    pub fn finish(self, [width, height]: [f64; 2], title: &str) -> Figure {
        Figure { width: at(width), height: at(height), title: title.to_owned(), body: self.body }
    }

    fn put(&mut self, element: std::fmt::Arguments<'_>) {
        let _ = writeln!(self.body, "{element}");
    }
}

/// Figures one below the other.
pub fn stack(figures: &[Figure], gap: f64) -> Figure {
    beside(figures, 1, [0.0, gap])
}

/// Figures in rows of `columns`, with gaps `[across, down]`; each column is as wide as the widest figure.
pub fn beside(figures: &[Figure], columns: usize, gap: [f64; 2]) -> Figure {
    let columns = columns.min(figures.len()).max(1);
    let width = figures.iter().map(|figure| figure.width).fold(0.0, f64::max);
    let mut svg = Svg::default();
    let mut top = 0.0;
    for row in figures.chunks(columns) {
        for (column, figure) in row.iter().enumerate() {
            svg.place([column as f64 * (width + gap[0]), top], figure);
        }
        top += row.iter().map(|figure| figure.height).fold(0.0, f64::max) + gap[1];
    }
    let titles: Vec<&str> = figures.iter().map(|figure| figure.title.as_str()).collect();
    let size = [columns as f64 * (width + gap[0]) - gap[0], (top - gap[1]).max(0.0)];
    svg.finish(size, &titles.join("; "))
}

impl Figure {
    /// The figure with empty space round it.
    pub fn with_margin(&self, margin: f64) -> Self {
        let mut svg = Svg::default();
        svg.place([margin, margin], self);
        svg.finish([self.width + 2.0 * margin, self.height + 2.0 * margin], &self.title)
    }

    /// Width and height, CSS pixels.
    pub fn size(&self) -> [f64; 2] {
        [self.width, self.height]
    }

    /// As part of a page that has the style sheet.
    pub fn inline(&self) -> String {
        let Self { width, height, title, body } = self;
        let title = escape(title);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
             style=\"max-width:{width}px\" role=\"img\" aria-label=\"{title}\">\n{body}</svg>\n"
        )
    }

    /// As a file of its own, on light ground.
    pub fn standalone(&self) -> String {
        let [width, height] = self.size();
        self.file(&format!("<rect width=\"{width}\" height=\"{height}\" class=\"page\"/>\n"))
    }

    /// As a file of its own without ground, to be laid over a picture.
    pub fn transparent(&self) -> String {
        self.file("")
    }

    fn file(&self, ground: &str) -> String {
        let Self { width, height, body, .. } = self;
        let style = Theme::Light.resolve(FIGURE_CSS);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
             height=\"{height}\">\n<style>{style}</style>\n{ground}{body}</svg>\n"
        )
    }
}

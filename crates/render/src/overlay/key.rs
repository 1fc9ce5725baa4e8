//! The legend of colours and lines.

use super::{Axes, HEIGHT, Key, KeyPosition, LETTER, LineStyle, MARGIN, Overlay, Page};
use crate::ColourTable;
use corpuscle_drawing::bars::value_bar;
use corpuscle_drawing::colour::hex;
use corpuscle_drawing::svg::Anchor;

/// Width of a colour bar.
const BAR: f64 = 230.0;
/// Height of a row, and space between two entries in one.
const ROW: f64 = 23.0;
const GAP: f64 = 30.0;
/// Where a column begins to the right of the axes, and a row below them.
const BESIDE: f64 = 40.0;
const BELOW: f64 = 66.0;
/// Length of a line's sample, and from there to its name.
const SAMPLE: f64 = 24.0;
const TO_NAME: f64 = 9.0;

/// An entry of the legend.
enum Entry<'a> {
    Values(&'a str, &'a ColourTable),
    Kind(&'a str, [u8; 3]),
    Line(LineStyle, &'a str),
}

impl Overlay {
    pub(super) fn draw_key(&self, page: &mut Page<'_>) {
        let mut entries: Vec<Entry<'_>> = match &self.key {
            Some(Key::Values(label, table)) => vec![Entry::Values(label, table)],
            Some(Key::Kinds(kinds)) => kinds.iter().map(|(name, colour)| Entry::Kind(name, *colour)).collect(),
            None => Vec::new(),
        };
        entries.extend(self.lines.iter().map(|(style, name)| Entry::Line(*style, name)));
        if entries.is_empty() {
            return;
        }
        let corner = |pick: fn(&Axes) -> [f64; 3]| self.axes.as_ref().and_then(|axes| page.position(pick(axes)));
        match (self.key_position, corner(|axes| axes.from), corner(|axes| axes.to)) {
            (KeyPosition::Beside, _, Some([right, top])) => draw_column(page, &entries, [right + BESIDE, top]),
            (KeyPosition::Below, Some([left, bottom]), _) => draw_row(page, &entries, [left, bottom + BELOW]),
            _ => draw_corner(page, &entries),
        }
    }
}

fn draw_corner(page: &mut Page<'_>, entries: &[Entry<'_>]) {
    let height: f64 = entries.iter().map(Entry::height).sum();
    let width = entries.iter().map(Entry::width).fold(0.0, f64::max);
    let top = HEIGHT - MARGIN - height;
    page.svg.rectangle([MARGIN - 12.0, top - 10.0], [width + 30.0, height + 16.0], "panel");
    draw_column(page, entries, [MARGIN, top]);
}

fn draw_column(page: &mut Page<'_>, entries: &[Entry<'_>], [left, mut top]: [f64; 2]) {
    for entry in entries {
        entry.draw(page, [left, top], false);
        top += entry.height();
    }
}

/// Draws entries side by side from a corner on, or, where they are too wide for that, in as many rows as they need, over the whole width of the page.
fn draw_row(page: &mut Page<'_>, entries: &[Entry<'_>], [left, top]: [f64; 2]) {
    let widths: Vec<f64> = entries.iter().map(Entry::width_in_row).collect();
    let is_one_row = left + widths.iter().sum::<f64>() + GAP * (widths.len() - 1) as f64 <= page.size[0] - MARGIN;
    let left = if is_one_row { left } else { MARGIN };
    let rows = rows(&widths, page.size[0] - MARGIN - left);
    let last = rows.iter().map(|(row, _)| *row).max().unwrap_or(0) as f64;
    // The last row is above the end of the page.
    let top = top.min(HEIGHT - ROW * (last + 1.0) - 4.0);
    for (entry, (row, from)) in entries.iter().zip(rows) {
        entry.draw(page, [left + from, top + ROW * row as f64], true);
    }
}

/// Row and begin of entries of these widths in rows of a length.
fn rows(widths: &[f64], length: f64) -> Vec<(usize, f64)> {
    let (mut row, mut from) = (0, 0.0);
    let position = |width: &f64| {
        if from > 0.0 && from + width > length {
            (row, from) = (row + 1, 0.0);
        }
        let position = (row, from);
        from += width + GAP;
        position
    };
    widths.iter().map(position).collect()
}

/// Width of a name.
fn wide(name: &str) -> f64 {
    LETTER * name.chars().count() as f64 + TO_NAME
}

impl Entry<'_> {
    fn height(&self) -> f64 {
        match self {
            Self::Values(..) => 62.0,
            Self::Kind(..) | Self::Line(..) => ROW,
        }
    }

    fn width(&self) -> f64 {
        match self {
            Self::Values(..) => BAR,
            Self::Kind(name, _) => 14.0 + wide(name),
            Self::Line(_, name) => SAMPLE + wide(name),
        }
    }

    /// Width in a row, where the name of values stands before their bar.
    fn width_in_row(&self) -> f64 {
        let name = if let Self::Values(name, _) = self { wide(name) } else { 0.0 };
        self.width() + name
    }

    /// Draws it from a position on; in a row the name of values stands before their bar, in a column above it.
    fn draw(&self, page: &mut Page<'_>, [left, top]: [f64; 2], in_a_row: bool) {
        let name_at = |from: f64| [from + TO_NAME, top + 13.0];
        match self {
            Self::Values(label, table) => {
                page.svg.text([left, top + 13.0], Anchor::Start, "over", label);
                let position = if in_a_row { [left + wide(label) + 6.0, top + 2.0] } else { [left, top + 21.0] };
                let range = [f64::from(table.low), f64::from(table.high)];
                let colour = |part: f64| table.colour(table.low + (table.high - table.low) * part as f32);
                value_bar(&mut page.svg, range, colour, position, BAR);
            }
            Self::Kind(name, colour) => {
                page.svg.circles([([left + 7.0, top + 8.0], 7.0)], &hex(*colour), "balls");
                page.svg.text(name_at(left + 14.0), Anchor::Start, "over", name);
            }
            Self::Line(style, name) => {
                page.svg.line([left, top + 8.0], [left + SAMPLE, top + 8.0], style.class());
                page.svg.text(name_at(left + SAMPLE), Anchor::Start, "over", name);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_that_do_not_fit_begin_a_row() {
        assert_eq!(rows(&[100.0, 100.0, 100.0], 400.0), [(0, 0.0), (0, 130.0), (0, 260.0)]);
        assert_eq!(rows(&[100.0, 100.0, 100.0], 300.0), [(0, 0.0), (0, 130.0), (1, 0.0)]);
        // One that is wider than a row has one of its own.
        assert_eq!(rows(&[500.0, 100.0], 300.0), [(0, 0.0), (1, 0.0)]);
    }
}

//! Maps: relief, a classed field over it, marked positions, legend and scale bar.

use super::classes::Classes;
use super::clip::inside_unit_square;
use super::colour::hex;
use super::ground::Ground;
use super::png::{encode_indexed, encode_rgb};
use super::relief::{contour_interval, relief};
use super::resample::resample;
use super::svg::{Anchor, Figure, Svg};
use super::text::{number, short_number};
use super::ticks;

/// Size of a map, and what is drawn round it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Size {
    /// A whole page's width: coordinates, names, legend.
    Full,
    /// Half a page: legend and scale.
    Compact,
    /// A third: the map alone, and its caption.
    Thumb,
}

impl Size {
    /// Largest width and height of the map itself, CSS pixels.
    fn most(self) -> [f64; 2] {
        match self {
            Self::Full => [902.0, 860.0],
            Self::Compact => [480.0, 520.0],
            Self::Thumb => [314.0, 340.0],
        }
    }

    /// Space left and right of the map.
    fn sides(self) -> [f64; 2] {
        match self {
            Self::Full => [74.0, 24.0],
            _ => [1.0, 1.0],
        }
    }
}

/// A classed field as a picture.
#[derive(Debug, Clone)]
pub(crate) struct Layer {
    /// URL of the picture.
    pub url: String,
    /// Its classes.
    pub classes: Classes,
}

/// Kind of a mark on a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum MarkKind {
    /// A gauge: one point.
    Gauge,
    /// Water coming in: at a point or along a line.
    Inflow,
    /// A section: a line.
    Section,
    /// An obstacle: the corners of a polygon.
    Obstacle,
}

/// A mark: its name, and points in the terrain's own coordinates.
#[derive(Debug, Clone)]
pub(crate) struct MapMark {
    pub kind: MarkKind,
    pub name: String,
    pub points: Vec<[f64; 2]>,
}

/// A map to be drawn.
#[derive(Debug, Clone)]
pub(crate) struct MapFigure<'a> {
    /// The ground it shows.
    pub ground: &'a Ground,
    /// URL of the relief; `#name` for one that stands elsewhere on the page, one unit wide and high.
    pub relief_url: &'a str,
    /// The field over it.
    pub layer: Option<&'a Layer>,
    /// Marks.
    pub marks: &'a [MapMark],
    /// Size.
    pub size: Size,
    /// Title and subtitle above the map.
    pub heading: Option<[&'a str; 2]>,
    /// Alternative text; the caption of a [`Size::Thumb`].
    pub title: &'a str,
}

/// The relief of a ground as PNG.
///
/// # Errors
/// What cannot be encoded.
pub(crate) fn ground_image(ground: &Ground) -> Result<Vec<u8>, String> {
    let [width, height] = ground.pixels.map(|count| count as u32);
    encode_rgb(width, height, &relief(ground))
}

impl Layer {
    /// The picture of a field (a value for each cell of the map grid), `reduction` times coarser than the relief, as PNG:
    /// a colour for each class and a darker one along the shore.
    ///
    /// # Errors
    /// What cannot be encoded.
    pub(crate) fn image(
        ground: &Ground,
        values: &[f32],
        classes: &Classes,
        reduction: usize,
    ) -> Result<Vec<u8>, String> {
        let [width, height] = ground.pixels.map(|count| count.div_ceil(reduction));
        let pixels = resample(values, ground.grid, [width, height]);
        let shore = classes.colours.len() + 1;
        let dry = |x: usize, y: usize| pixels[y * width + x].is_nan();
        let index = |index: usize| {
            let (x, y) = (index % width, index / width);
            let beside_dry = x > 0 && dry(x - 1, y)
                || x + 1 < width && dry(x + 1, y)
                || y > 0 && dry(x, y - 1)
                || y + 1 < height && dry(x, y + 1);
            match pixels[index] {
                value if value.is_nan() => 0,
                _ if beside_dry => shore as u8,
                value => classes.class_of(f64::from(value)) as u8 + 1,
            }
        };
        let indices: Vec<u8> = (0..pixels.len()).map(index).collect();
        let last = classes.colours[classes.colours.len() / 2].map(|channel| channel / 2);
        let colours = classes.colours.iter().map(|[r, g, b]| [*r, *g, *b, 255]);
        let palette: Vec<[u8; 4]> =
            std::iter::once([0; 4]).chain(colours).chain([[last[0], last[1], last[2], 200]]).collect();
        encode_indexed(width as u32, height as u32, &indices, &palette)
    }
}

/// A title and a subtitle alone, for several maps together.
pub(crate) fn heading(title: &str, subtitle: &str) -> Figure {
    let mut svg = Svg::default();
    svg.text([1.0, 20.0], Anchor::Start, "title heading", title);
    svg.text([1.0, 40.0], Anchor::Start, "small", subtitle);
    svg.finish([440.0, 50.0], title)
}

/// The classes of a field without a map, for several maps together.
pub(crate) fn legend(classes: &Classes) -> Figure {
    let mut svg = Svg::default();
    svg.text([1.0, 20.0], Anchor::Start, "text", &classes.title);
    draw_class_bar(&mut svg, classes, [1.0, 29.0], 420.0);
    svg.finish([440.0, 60.0], &format!("Legend: {}", classes.title))
}

/// Where the map lies in its figure.
#[derive(Debug, Clone, Copy)]
struct Frame {
    corner: [f64; 2],
    size: [f64; 2],
    width: f64,
}

impl Frame {
    fn position(&self, part: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| self.corner[axis] + part[axis] * self.size[axis])
    }

    fn bottom(&self) -> f64 {
        self.corner[1] + self.size[1]
    }

    fn right(&self) -> f64 {
        self.corner[0] + self.size[0]
    }
}

impl MapFigure<'_> {
    /// The map as a figure.
    pub(crate) fn figure(&self) -> Figure {
        let frame = self.frame();
        let mut svg = Svg::default();
        if let Some([title, subtitle]) = self.heading {
            svg.text([frame.corner[0], 28.0], Anchor::Start, "title heading", title);
            svg.text([frame.corner[0], 48.0], Anchor::Start, "small", subtitle);
        }
        self.draw_relief(&mut svg, &frame);
        if let Some(layer) = self.layer {
            svg.image(frame.corner, frame.size, &layer.url, 0.88);
        }
        self.draw_marks(&mut svg, &frame);
        svg.rectangle(frame.corner, frame.size, "frame");
        let bottom = match self.size {
            Size::Thumb => {
                svg.text([frame.corner[0], frame.bottom() + 17.0], Anchor::Start, "text", self.title);
                frame.bottom() + 24.0
            }
            Size::Compact => {
                draw_north(&mut svg, &frame, 0.75);
                self.draw_legend(&mut svg, &frame, frame.bottom() + 20.0)
            }
            Size::Full => {
                draw_north(&mut svg, &frame, 1.0);
                self.draw_ticks(&mut svg, &frame);
                let end = self.draw_legend(&mut svg, &frame, frame.bottom() + 52.0);
                self.draw_key(&mut svg, &frame, end + 10.0)
            }
        };
        svg.finish([frame.width, bottom], &format!("Map: {}", self.title))
    }

    fn frame(&self) -> Frame {
        let [east, south] = self.ground.pixels.map(|count| count as f64);
        let [most_width, most_height] = self.size.most();
        let scale = (most_width / east).min(most_height / south);
        let size = [east * scale, south * scale];
        let [left, right] = self.size.sides();
        // Legend and scale bar need their width even below a narrow map.
        let width = match self.size {
            Size::Full => (left + size[0] + right).max(620.0),
            Size::Compact => most_width + left + right,
            Size::Thumb => size[0] + left + right,
        };
        let x = left + 0.5 * (width - left - size[0] - right);
        Frame { corner: [x, if self.heading.is_some() { 62.0 } else { 8.0 }], size, width }
    }

    fn draw_relief(&self, svg: &mut Svg, frame: &Frame) {
        if self.relief_url.starts_with('#') {
            svg.reuse(frame.corner, frame.size, self.relief_url);
        } else {
            svg.image(frame.corner, frame.size, self.relief_url, 1.0);
        }
    }

    fn draw_marks(&self, svg: &mut Svg, frame: &Frame) {
        let (obstacles, marks): (Vec<_>, Vec<_>) = self.marks.iter().partition(|mark| mark.kind == MarkKind::Obstacle);
        for obstacle in obstacles {
            let parts: Vec<_> = obstacle.points.iter().map(|point| self.ground.part(*point)).collect();
            let corners: Vec<_> = inside_unit_square(&parts).into_iter().map(|part| frame.position(part)).collect();
            draw_mark(svg, MarkKind::Obstacle, &corners);
        }
        if self.size == Size::Thumb {
            return;
        }
        let mut taken: Vec<[f64; 4]> = Vec::new();
        let mut names = Vec::new();
        for mark in marks {
            let points: Vec<[f64; 2]> =
                mark.points.iter().map(|point| frame.position(self.ground.part(*point))).collect();
            let Some(anchor) = draw_mark(svg, mark.kind, &points) else { continue };
            taken.push([anchor[0] - 6.0, anchor[1] - 6.0, anchor[0] + 6.0, anchor[1] + 6.0]);
            names.push((anchor, mark.name.as_str()));
        }
        if self.size == Size::Full {
            names.into_iter().for_each(|(anchor, name)| draw_name(svg, frame, anchor, name, &mut taken));
        }
    }

    fn draw_ticks(&self, svg: &mut Svg, frame: &Frame) {
        let ground = self.ground;
        let suffix = if ground.geographic { "°" } else { "" };
        let label = |value: f64, step: f64| {
            let text = if step >= 1.0 && value.abs() < 1e7 { number(value.round()) } else { ticks::label(value, step) };
            let plain = if step >= 1.0 && value.abs() < 1000.0 { ticks::label(value, step) } else { text };
            plain + suffix
        };
        let [west, north] = ground.corner;
        let [east, south] = [west + ground.own_extent[0], north - ground.own_extent[1]];
        let step = ticks::step(east - west, (frame.size[0] / 85.0).max(2.0) as usize);
        for value in ticks::multiples(west, east, step) {
            let [x, _] = frame.position(ground.part([value, north]));
            svg.line([x, frame.bottom()], [x, frame.bottom() + 5.0], "axis");
            svg.text([x, frame.bottom() + 18.0], Anchor::Middle, "number", &label(value, step));
        }
        let step = ticks::step(north - south, (frame.size[1] / 70.0).max(2.0) as usize);
        for value in ticks::multiples(south, north, step) {
            let [_, y] = frame.position(ground.part([west, value]));
            svg.line([frame.corner[0] - 5.0, y], [frame.corner[0], y], "axis");
            svg.text([frame.corner[0] - 9.0, y + 4.0], Anchor::End, "number", &label(value, step));
        }
    }

    /// Classes at the left, scale bar at the right. Gives the lower end.
    fn draw_legend(&self, svg: &mut Svg, frame: &Frame, top: f64) -> f64 {
        let [left, right] = match self.size {
            Size::Full if frame.size[0] > 500.0 => [frame.corner[0], frame.right()],
            Size::Full => [self.size.sides()[0], frame.width - self.size.sides()[1]],
            _ => [1.0, frame.width - 1.0],
        };
        let space = 0.6 * (right - left);
        if let Some(layer) = self.layer {
            svg.text([left, top], Anchor::Start, "text", &layer.classes.title);
            if layer.classes.names.is_empty() {
                draw_class_bar(svg, &layer.classes, [left, top + 9.0], space);
            } else {
                draw_named_classes(svg, &layer.classes, [left, top + 9.0], space);
            }
        }
        self.draw_scale_bar(svg, frame, [right, top], 0.3 * (right - left));
        let has_values = self.layer.is_some_and(|layer| !layer.classes.names.is_empty());
        top + if has_values { 54.0 } else { 40.0 }
    }

    /// A bar of a round length in two light and two dark parts, ending at `[right, top]`.
    fn draw_scale_bar(&self, svg: &mut Svg, frame: &Frame, [right, top]: [f64; 2], space: f64) {
        let metres_per_pixel = self.ground.extent[0] / frame.size[0];
        let length = ticks::step(space.min(0.5 * frame.size[0]) * metres_per_pixel * 0.5, 1);
        let length = if length > space * metres_per_pixel { length / 2.0 } else { length };
        let (divisor, unit) = if length >= 2000.0 { (1000.0, "km") } else { (1.0, "m") };
        let width = length / metres_per_pixel;
        let left = right - width - 24.0;
        for part in 0..4 {
            let class = if part % 2 == 0 { "bar-dark" } else { "bar-light" };
            svg.rectangle([left + part as f64 * width / 4.0, top + 12.0], [width / 4.0, 5.0], class);
        }
        let length = length / divisor;
        for (part, unit) in [(0.0, String::new()), (0.5, String::new()), (1.0, format!(" {unit}"))] {
            let text = format!("{}{unit}", (part * length * 1e6).round() / 1e6);
            svg.text([left + part * width, top + 32.0], Anchor::Middle, "number", &text);
        }
    }

    /// What the marks are, and remarks on contours, coordinates and stretching. Gives the lower end.
    fn draw_key(&self, svg: &mut Svg, frame: &Frame, top: f64) -> f64 {
        let start = frame.corner[0].min(frame.width - 546.0);
        let (mut x, y) = (start, top + 12.0);
        let kinds = [
            (MarkKind::Gauge, "gauge"),
            (MarkKind::Inflow, "inflow"),
            (MarkKind::Section, "section"),
            (MarkKind::Obstacle, "obstacle"),
        ];
        for (kind, name) in kinds {
            if !self.marks.iter().any(|mark| mark.kind == kind) {
                continue;
            }
            let points = match kind {
                MarkKind::Section => vec![[x, y - 4.0], [x + 20.0, y - 4.0]],
                MarkKind::Obstacle => vec![[x, y - 9.0], [x + 14.0, y - 9.0], [x + 14.0, y], [x, y]],
                _ => vec![[x + 7.0, y - 4.0]],
            };
            let wide = if kind == MarkKind::Section { 26.0 } else { 18.0 };
            draw_mark(svg, kind, &points);
            svg.text([x + wide, y], Anchor::Start, "small", name);
            x += wide + name.len() as f64 * 6.5 + 18.0;
        }
        svg.text([x, y], Anchor::Start, "small", &self.remarks());
        y + 10.0
    }

    fn remarks(&self) -> String {
        let ground = self.ground;
        let mut remarks = Vec::new();
        if let Some(interval) = contour_interval(ground) {
            let decimals = ticks::label(interval, interval);
            remarks.push(format!("contours every {decimals} m"));
        }
        remarks.push(match &ground.system {
            Some(system) => format!("coordinates {system}"),
            None => "coordinates in m, no reference system".into(),
        });
        let [east, north] = ground.extent;
        let [width, height] = ground.pixels.map(|count| count as f64);
        let stretch = (height / north) / (width / east);
        if stretch > 1.02 {
            remarks.push(format!("stretched {} times north–south", short_number(stretch)));
        } else if stretch < 0.98 {
            remarks.push(format!("stretched {} times east–west", short_number(1.0 / stretch)));
        }
        remarks.join("  ·  ")
    }
}

/// Draws a mark and gives the point that its name belongs to.
fn draw_mark(svg: &mut Svg, kind: MarkKind, points: &[[f64; 2]]) -> Option<[f64; 2]> {
    let (first, last) = (*points.first()?, *points.last()?);
    match kind {
        MarkKind::Gauge => svg.circle(first, 4.5, "gauge"),
        MarkKind::Obstacle => svg.path(points.iter().copied(), true, "obstacle"),
        MarkKind::Section => {
            svg.path(points.iter().copied(), false, "section-under");
            svg.path(points.iter().copied(), false, "section");
            return Some(last);
        }
        MarkKind::Inflow if points.len() > 1 => {
            svg.path(points.iter().copied(), false, "inflow-line");
            return Some([0, 1].map(|axis| 0.5 * (first[axis] + last[axis])));
        }
        MarkKind::Inflow => {
            let corner = |[x, y]: [f64; 2]| [first[0] + x, first[1] + y];
            svg.path([[-7.0, -6.0], [7.0, -6.0], [0.0, 7.0]].map(corner), true, "inflow");
        }
    }
    Some(first)
}

/// Writes a name beside a point, where it overlaps least and stays on the map.
fn draw_name(svg: &mut Svg, frame: &Frame, [x, y]: [f64; 2], name: &str, taken: &mut Vec<[f64; 4]>) {
    let width = name.chars().count() as f64 * 7.0;
    // Beside a point at the upper or lower edge, but not beyond it.
    let beside = (y + 4.0).clamp(frame.corner[1] + 14.0, (frame.bottom() - 6.0).max(frame.corner[1] + 14.0));
    let sides = [
        ([x + 9.0, beside], Anchor::Start, x + 9.0),
        ([x - 9.0, beside], Anchor::End, x - 9.0 - width),
        ([x, y - 10.0], Anchor::Middle, x - 0.5 * width),
        ([x, y + 19.0], Anchor::Middle, x - 0.5 * width),
    ];
    let map = [frame.corner[0], frame.corner[1], frame.right(), frame.bottom()];
    let cost = |left: f64, baseline: f64| {
        let own = [left, baseline - 11.0, left + width, baseline + 3.0];
        let outside = width * 14.0 - overlap(own, map);
        // In whole pixels, so that rounding does not choose between equals.
        (outside * 4.0 + taken.iter().map(|other| overlap(own, *other)).sum::<f64>()).round()
    };
    let best = sides.into_iter().min_by(|a, b| cost(a.2, a.0[1]).total_cmp(&cost(b.2, b.0[1])));
    let Some((position, anchor, left)) = best else { return };
    taken.push([left, position[1] - 11.0, left + width, position[1] + 3.0]);
    svg.text(position, anchor, "label", name);
}

/// Common area of two boxes (left, top, right, bottom).
fn overlap(a: [f64; 4], b: [f64; 4]) -> f64 {
    let side = |axis: usize| (a[axis + 2].min(b[axis + 2]) - a[axis].max(b[axis])).max(0.0);
    side(0) * side(1)
}

fn draw_north(svg: &mut Svg, frame: &Frame, scale: f64) {
    let [x, y] = [frame.right() - 24.0 * scale, frame.corner[1] + 16.0 * scale];
    let tip = [[0.0, -8.0], [8.0, 14.0], [0.0, 9.0], [-8.0, 14.0]];
    svg.path(tip.map(|[dx, dy]| [x + dx * scale, y + dy * scale]), true, "north");
    svg.text([x, y + 14.0 * scale + 13.0], Anchor::Middle, "label", "N");
}

/// Classes side by side, with the edges below.
fn draw_class_bar(svg: &mut Svg, classes: &Classes, [x, y]: [f64; 2], space: f64) {
    let width = (space / classes.colours.len() as f64).min(64.0);
    for (class, colour) in classes.colours.iter().enumerate() {
        svg.swatch([x + class as f64 * width, y], [width, 12.0], &hex(*colour));
    }
    for (edge, label) in classes.labels.iter().enumerate() {
        svg.text([x + (edge + 1) as f64 * width, y + 26.0], Anchor::Middle, "number", label);
    }
}

/// Classes side by side, with their names and values below.
fn draw_named_classes(svg: &mut Svg, classes: &Classes, [x, y]: [f64; 2], space: f64) {
    let width = (space / classes.colours.len() as f64).min(120.0);
    for (class, colour) in classes.colours.iter().enumerate() {
        let left = x + class as f64 * width;
        svg.swatch([left, y], [width, 12.0], &hex(*colour));
        svg.text([left + 0.5 * width, y + 26.0], Anchor::Middle, "number", &classes.names[class]);
        svg.text([left + 0.5 * width, y + 40.0], Anchor::Middle, "number", &classes.values(class));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::Window;
    use crate::picture::classes::Ramp;
    use crate::picture::png::{data_url, svg_to_png};
    use corpuscle_terrain::{Bounds, Terrain};

    fn ground(size: [f64; 2]) -> Ground {
        let bounds = Bounds { x_min: 0.0, x_max: size[0], y_min: 0.0, y_max: size[1] };
        let terrain = Terrain::gridded(bounds, 10.0, |x, y| 0.01 * x + 2.0 * (y / 30.0).sin());
        let grid = terrain.map_grid();
        Ground::of(&terrain, &Window::whole([grid.columns, grid.rows]))
    }

    #[test]
    fn maps_of_any_shape_can_be_drawn() {
        let marks = [
            MapMark { kind: MarkKind::Gauge, name: "G & <1>".into(), points: vec![[50.0, 50.0]] },
            MapMark { kind: MarkKind::Inflow, name: "river".into(), points: vec![[0.0, 50.0]] },
            MapMark { kind: MarkKind::Section, name: "S".into(), points: vec![[20.0, 0.0], [20.0, 100.0]] },
            MapMark { kind: MarkKind::Obstacle, name: "O".into(), points: vec![[5.0, 5.0], [15.0, 5.0], [5.0, 30.0]] },
        ];
        for extent in [[400.0, 200.0], [4000.0, 20.0], [20.0, 4000.0]] {
            let ground = ground(extent);
            let values = vec![1.0; ground.grid[0] * ground.grid[1]];
            let classes = Classes::of(Ramp::Depth, "Depth, m", &values);
            let url = data_url(&Layer::image(&ground, &values, &classes, 4).unwrap());
            let layer = Layer { url, classes };
            for size in [Size::Full, Size::Compact, Size::Thumb] {
                let map = MapFigure {
                    ground: &ground,
                    relief_url: "#relief",
                    layer: Some(&layer),
                    marks: &marks,
                    size,
                    heading: None,
                    title: "t",
                };
                let figure = map.figure();
                assert!(figure.size()[0] <= 1001.0, "{extent:?} {size:?}");
                assert!(!figure.inline().contains("NaN"));
                assert!(figure.inline().contains("\"obstacle\""), "{extent:?} {size:?}");
            }
        }
    }

    #[test]
    fn a_png_shows_the_colours_of_the_classes() {
        let ground = ground([200.0, 100.0]);
        let values = vec![3.0; 200];
        let classes = Classes::of(Ramp::Depth, "Depth, m", &values);
        let relief = data_url(&ground_image(&ground).unwrap());
        let layer = Layer { url: data_url(&Layer::image(&ground, &values, &classes, 1).unwrap()), classes };
        let map = MapFigure {
            ground: &ground,
            relief_url: &relief,
            layer: Some(&layer),
            marks: &[],
            size: Size::Compact,
            heading: None,
            title: "t",
        };
        let png = svg_to_png(&map.figure()).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        let middle = (info.height / 3 * info.width + info.width / 2) as usize * 3;
        let [red, _, blue] = [0, 1, 2].map(|channel| i32::from(pixels[middle + channel]));
        assert!(blue > red + 40, "blue water: {red} {blue}");
    }
}

//! Balls in two dimensions: to scale, seen from above.

use super::paint::Flat;
use super::{Balls, Disc, MOST, Side};
use crate::picture::colour::Colour;
use crate::picture::colour::hex;
use crate::picture::png::data_url;
use crate::picture::svg::{Figure, Svg};

/// Space round the box for its walls, CSS pixels.
pub(super) const MARGIN: f64 = 18.0;

/// More balls than this are painted as a picture of pixels; fewer are circles, sharp at any size.
const MOST_CIRCLES: usize = 2500;

/// Pixels of a painted picture for a CSS pixel.
const FINENESS: f64 = 2.0;

/// CSS pixels for a unit of length.
pub(super) fn scale(balls: &Balls) -> f64 {
    let [from, to] = balls.view;
    let [width, height] = [0, 1].map(|axis| to[axis] - from[axis]);
    (MOST[0] / width).min(MOST[1] / height)
}

/// Width and height of the picture.
pub(super) fn size(balls: &Balls) -> [f64; 2] {
    let ([from, to], scale) = (balls.view, scale(balls));
    [0, 1].map(|axis| (to[axis] - from[axis]) * scale + 2.0 * MARGIN)
}

/// The picture.
pub(super) fn picture(balls: &Balls, shown_at: f64) -> Result<Figure, String> {
    let size = size(balls);
    let paper = Paper { origin: [balls.view[0][0], balls.view[1][1]], scale: scale(balls) };
    let mut svg = Svg::default();
    let [left_top, right_bottom] =
        [[balls.from[0], balls.to[1]], [balls.to[0], balls.from[1]]].map(|corner| paper.position(corner));
    let inside = [right_bottom[0] - left_top[0], right_bottom[1] - left_top[1]];
    svg.rectangle(left_top, inside, "paper");
    if balls.discs.len() > MOST_CIRCLES {
        let url = data_url(&paint(balls, &paper, size, FINENESS * shown_at)?);
        svg.image([0.0, 0.0], size, &url, 1.0);
    } else {
        draw_circles(&mut svg, balls, &paper);
    }
    draw_way(&mut svg, balls, &paper);
    draw_walls(&mut svg, balls, left_top, right_bottom);
    draw_partition(&mut svg, balls, &paper);
    Ok(svg.finish(size, "Balls in their box"))
}

/// From lengths to CSS pixels, y downwards.
struct Paper {
    origin: [f64; 2],
    scale: f64,
}

impl Paper {
    fn position(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [MARGIN + (x - self.origin[0]) * self.scale, MARGIN + (self.origin[1] - y) * self.scale]
    }

    fn of(&self, position: [f64; 3]) -> [f64; 2] {
        self.position([position[0], position[1]])
    }
}

/// Circles of one colour together.
fn draw_circles(svg: &mut Svg, balls: &Balls, paper: &Paper) {
    let mut order: Vec<&Disc> = balls.discs.iter().collect();
    order.sort_by_key(|disc| disc.colour);
    for group in order.chunk_by(|a, b| a.colour == b.colour) {
        let circles = group.iter().map(|disc| (paper.of(disc.position), disc.radius * paper.scale));
        svg.circles(circles, &hex(group[0].colour), "balls");
    }
}

fn paint(balls: &Balls, paper: &Paper, size: [f64; 2], fineness: f64) -> Result<Vec<u8>, String> {
    let mut canvas = Flat::new(size.map(|length| (length * fineness).ceil() as usize));
    for disc in &balls.discs {
        let position = paper.of(disc.position).map(|length| length * fineness);
        canvas.disc(position, disc.radius * paper.scale * fineness, disc.colour);
    }
    canvas.png()
}

fn draw_way(svg: &mut Svg, balls: &Balls, paper: &Paper) {
    for class in ["trajectory-under", "trajectory"] {
        if !balls.trajectory.is_empty() {
            svg.path(balls.trajectory.iter().map(|point| paper.of(*point)), false, class);
        }
    }
    if let Some(start) = balls.trajectory.first() {
        svg.circle(paper.of(*start), 4.0, "trajectory-start");
    }
    if let Some(disc) = &balls.followed {
        let radius = (disc.radius * paper.scale).max(3.0);
        let fill = |[r, g, b]: Colour| format!("fill:rgb({r},{g},{b})");
        svg.styled_circle(paper.of(disc.position), radius, "trajectory-end", &fill(disc.colour));
    }
}

fn draw_walls(svg: &mut Svg, balls: &Balls, [left, top]: [f64; 2], [right, bottom]: [f64; 2]) {
    // Drawn just outside the box, so that a ball at the wall touches its edge.
    let out = |side: Side| if side == Side::Hot { 2.0 } else { 1.5 };
    let [[west, east], [south, north], _] = balls.sides;
    let sides = [
        (west, [[left - out(west), top], [left - out(west), bottom]], [-1.0, 0.0]),
        (east, [[right + out(east), top], [right + out(east), bottom]], [1.0, 0.0]),
        (south, [[left, bottom + out(south)], [right, bottom + out(south)]], [0.0, 1.0]),
        (north, [[left, top - out(north)], [right, top - out(north)]], [0.0, -1.0]),
    ];
    for (side, ends, outwards) in sides {
        match side {
            Side::Wall => svg.line(ends[0], ends[1], "wall"),
            Side::Hot => svg.line(ends[0], ends[1], "wall-hot"),
            Side::Open => svg.line(ends[0], ends[1], "wall-open"),
            Side::Passage => {}
            Side::Piston => {
                let moved = |end: [f64; 2]| [end[0] + 12.0 * outwards[0], end[1] + 12.0 * outwards[1]];
                svg.path([ends[0], ends[1], moved(ends[1]), moved(ends[0])], true, "piston");
            }
        }
    }
}

fn draw_partition(svg: &mut Svg, balls: &Balls, paper: &Paper) {
    let Some(partition) = &balls.partition else { return };
    let along = 1 - partition.axis.min(1);
    let mut stretches = vec![[balls.from[along], balls.to[along]]];
    if let Some([from, to]) = &partition.hole {
        stretches = vec![[balls.from[along], from[0]], [to[0], balls.to[along]]];
    }
    for stretch in stretches {
        let ends = stretch.map(|position| {
            paper.position(if along == 1 { [partition.at, position] } else { [position, partition.at] })
        });
        svg.line(ends[0], ends[1], "partition");
    }
}

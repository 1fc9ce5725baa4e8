//! Drops as they look on a solid: clear water, lit from above, that shows light below and dark above, as a lens does.

use super::trace::{Hit, Screen};
use super::view::{Vector, dot, normalised};

/// A drop to be drawn: a cap of a ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cap {
    /// Middle of the covered disk, m.
    pub position: Vector,
    /// The outward normal of the solid.
    pub normal: Vector,
    /// Radius of the covered disk, m.
    pub radius: f64,
    /// Height above the solid, m.
    pub height: f64,
}

/// A drop smaller than this scatters light as mist, pixels.
const SMALLEST: f64 = 1.8;

/// Colour of the mist of drops too small to be seen one by one, the most of it that is seen, and how much whiter than the area that
/// they cover.
const MIST: Vector = [226.0, 233.0, 238.0];
const THICKEST: f64 = 0.9;
const WHITER: f64 = 2.0;

/// Where the light comes from: above the left shoulder.
pub(super) fn light(screen: &Screen) -> Vector {
    let view = screen.view;
    normalised(std::array::from_fn(|axis| 0.7 * view.up[axis] - 0.45 * view.right[axis] - 0.9 * view.ahead[axis]))
}

/// Draws drops over the picture of the solids. `mist` is the fraction of each pixel that drops too small to be followed cover.
pub(super) fn draw(screen: &Screen, caps: &[Cap], hits: &[Hit], mut mist: Vec<f64>, colours: &mut [Vector]) {
    let mut order: Vec<&Cap> = caps.iter().filter(|cap| dot(cap.normal, screen.view.ahead) < 0.0).collect();
    // The farthest first.
    order.sort_by(|a, b| screen.view.position(b.position)[2].total_cmp(&screen.view.position(a.position)[2]));
    let before = colours.to_vec();
    for cap in &order {
        if cap.radius < SMALLEST * screen.pixel {
            add_mist(screen, cap, hits, &mut mist);
        }
    }
    for (colour, mist) in colours.iter_mut().zip(&mist) {
        let thick = THICKEST * (1.0 - f64::exp(-WHITER * mist));
        *colour = mix(*colour, MIST, thick);
    }
    for cap in order.into_iter().filter(|cap| cap.radius >= SMALLEST * screen.pixel) {
        draw_cap(screen, cap, hits, &before, colours);
    }
}

/// What a drop covers, over the pixels round its middle.
fn add_mist(screen: &Screen, cap: &Cap, hits: &[Hit], mist: &mut [f64]) {
    let position = screen.view.position(cap.position);
    let [x, y] = screen.pixel_of(position).map(f64::floor);
    let across = -dot(cap.normal, screen.view.ahead);
    let covered = std::f64::consts::PI * (cap.radius / screen.pixel).powi(2) * across;
    // Three by three pixels, the middle most.
    for (dx, dy, share) in
        (0..9).map(|k| (k % 3 - 1, k / 3 - 1, [1.0, 2.0, 1.0][k as usize % 3] * [1.0, 2.0, 1.0][k as usize / 3]))
    {
        let (column, row) = (x + f64::from(dx), y + f64::from(dy));
        if column < 0.0 || row < 0.0 || column as usize >= screen.width || row as usize >= screen.height {
            continue;
        }
        let pixel = row as usize * screen.width + column as usize;
        if hits[pixel].solid.is_some() && position[2] < hits[pixel].depth + 3.0 * screen.pixel {
            mist[pixel] += covered * share / 16.0;
        }
    }
}

fn draw_cap(screen: &Screen, cap: &Cap, hits: &[Hit], before: &[Vector], colours: &mut [Vector]) {
    let ball = (cap.radius * cap.radius + cap.height * cap.height) / (2.0 * cap.height);
    let centre: Vector = std::array::from_fn(|axis| cap.position[axis] + (cap.height - ball) * cap.normal[axis]);
    let middle = screen.view.position(centre);
    let [x, y] = screen.pixel_of(middle);
    let reach = ball / screen.pixel + 1.0;
    let range = |at: f64, most: usize| (at - reach).max(0.0) as usize..((at + reach).max(0.0) as usize + 1).min(most);
    let light = light(screen);
    for row in range(y, screen.height) {
        for column in range(x, screen.width) {
            let away = [column as f64 + 0.5 - x, y - row as f64 - 0.5].map(|pixels| pixels * screen.pixel);
            let across = (away[0] * away[0] + away[1] * away[1]).sqrt();
            // A soft edge, a pixel wide.
            let cover = ((ball - across) / screen.pixel + 0.5).clamp(0.0, 1.0);
            let towards = (ball * ball - across * across).max(0.0).sqrt();
            let outward: Vector = screen.view.point([away[0] / ball, away[1] / ball, -towards / ball]);
            let surface: Vector = std::array::from_fn(|axis| centre[axis] + ball * outward[axis]);
            let above = dot(surface, cap.normal) - dot(cap.position, cap.normal);
            let pixel = row * screen.width + column;
            let is_hidden = middle[2] - towards > hits[pixel].depth + 2.0 * screen.pixel;
            if cover == 0.0 || above < -0.5 * screen.pixel || is_hidden {
                continue;
            }
            let colour = water(screen, normalised(outward), light, before[pixel]);
            colours[pixel] = mix(colours[pixel], colour, cover);
        }
    }
}

/// Colour of water whose surface points `outward`, over a solid of this colour.
fn water(screen: &Screen, outward: Vector, light: Vector, below: Vector) -> Vector {
    let facing = (-dot(outward, screen.view.ahead)).clamp(0.0, 1.0);
    let upward = dot(outward, screen.view.up);
    // Seen through the drop, up is down.
    let lens = -0.42 * upward;
    let rim = (1.0 - facing).powi(3);
    let half = normalised(std::array::from_fn(|axis| light[axis] - screen.view.ahead[axis]));
    let glint = dot(outward, half).max(0.0).powi(90);
    let clear: Vector =
        std::array::from_fn(|k| (below[k] * 1.06 + [4.0, 9.0, 14.0][k]) * (1.0 + lens) * (1.0 - 0.5 * rim));
    mix(clear, [255.0; 3], 0.95 * glint).map(|value| value.clamp(0.0, 255.0))
}

pub(super) fn mix(from: Vector, to: Vector, part: f64) -> Vector {
    std::array::from_fn(|k| from[k] + (to[k] - from[k]) * part)
}

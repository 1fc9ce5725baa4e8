//! Zones where water comes in, is held, or goes out.

use crate::polygon::is_inside;
use corpuscle_scene::Table;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// Inflowing water raises the surface where it comes in no faster than this, m/s: the area it is spread over follows.
const FASTEST_RISE: f64 = 0.5;

/// A discharge into the water.
#[derive(Debug, Clone)]
pub(crate) struct Source {
    pub zone: Zone,
    /// Discharge over time, m3/s.
    pub discharge: Table,
    pub velocity: [f64; 2],
}

/// A part of the plane.
#[derive(Debug, Clone)]
pub(crate) enum Zone {
    /// A disc.
    Disc { centre: [f64; 2], radius: f64 },
    /// A band on both sides of a line.
    Band { line: Vec<[f64; 2]>, half_width: f64 },
    /// A polygon.
    Polygon(Vec<[f64; 2]>),
}

impl Zone {
    /// A disc wide enough for `discharge` m3/s.
    pub fn at(centre: [f64; 2], discharge: f64, spacing: f64) -> Self {
        let needed = (discharge / FASTEST_RISE / std::f64::consts::PI).sqrt();
        Self::Disc { centre, radius: needed.max(2.0 * spacing) }
    }

    /// A band wide enough for `discharge` m3/s.
    pub fn along(line: Vec<[f64; 2]>, discharge: f64, spacing: f64) -> Self {
        let length: f64 = line.windows(2).map(|pair| distance(pair[0], pair[1])).sum();
        let needed = 0.5 * discharge / FASTEST_RISE / length;
        Self::Band { line, half_width: needed.max(spacing) }
    }

    /// A position in it, at random.
    pub fn any(&self, random: &mut ChaCha8Rng) -> [f64; 2] {
        match self {
            Self::Disc { centre, radius } => {
                let r = radius * random.random_range(0.0..1.0_f64).sqrt();
                let (sin, cos) = random.random_range(0.0..std::f64::consts::TAU).sin_cos();
                [centre[0] + r * cos, centre[1] + r * sin]
            }
            Self::Band { line, half_width } => {
                let length: f64 = line.windows(2).map(|pair| distance(pair[0], pair[1])).sum();
                let mut along = random.random_range(0.0..length);
                let beside = random.random_range(-half_width..*half_width);
                let pair = line
                    .windows(2)
                    .find(|pair| {
                        let here = along <= distance(pair[0], pair[1]);
                        along -= if here { 0.0 } else { distance(pair[0], pair[1]) };
                        here
                    })
                    .unwrap_or(&line[line.len() - 2..]);
                let part = along / distance(pair[0], pair[1]);
                let direction = [0, 1].map(|axis| (pair[1][axis] - pair[0][axis]) / distance(pair[0], pair[1]));
                [
                    pair[0][0] + part * (pair[1][0] - pair[0][0]) - beside * direction[1],
                    pair[0][1] + part * (pair[1][1] - pair[0][1]) + beside * direction[0],
                ]
            }
            Self::Polygon(corners) => {
                let [low, high] = rectangle(corners);
                loop {
                    let [x, y] =
                        [0, 1].map(|axis| low[axis] + random.random_range(0.0..1.0) * (high[axis] - low[axis]));
                    if is_inside(corners, x, y) {
                        return [x, y];
                    }
                }
            }
        }
    }

    /// Whether it holds a position.
    pub fn contains(&self, x: f64, y: f64) -> bool {
        match self {
            Self::Disc { centre, radius } => distance(*centre, [x, y]) <= *radius,
            Self::Band { line, half_width } => {
                line.windows(2).any(|pair| from_piece(pair[0], pair[1], [x, y]) <= *half_width)
            }
            Self::Polygon(corners) => is_inside(corners, x, y),
        }
    }

    /// A disc round all of it: its middle and radius.
    pub fn round(&self) -> ([f64; 2], f64) {
        let (positions, margin) = match self {
            Self::Disc { centre, radius } => return (*centre, *radius),
            Self::Band { line, half_width } => (line, *half_width),
            Self::Polygon(corners) => (corners, 0.0),
        };
        let [low, high] = rectangle(positions);
        let middle = [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]));
        (middle, 0.5 * distance(low, high) + margin)
    }

    /// How far it reaches from its middle, m.
    pub fn reach(&self) -> f64 {
        self.round().1
    }
}

fn rectangle(positions: &[[f64; 2]]) -> [[f64; 2]; 2] {
    let low = [0, 1].map(|axis| positions.iter().map(|position| position[axis]).fold(f64::INFINITY, f64::min));
    let high = [0, 1].map(|axis| positions.iter().map(|position| position[axis]).fold(f64::NEG_INFINITY, f64::max));
    [low, high]
}

/// Distance of a position from the straight piece between two others, m.
fn from_piece(a: [f64; 2], b: [f64; 2], position: [f64; 2]) -> f64 {
    let [along, to] = [b, position].map(|end| [end[0] - a[0], end[1] - a[1]]);
    let part = (to[0] * along[0] + to[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]);
    let part = part.clamp(0.0, 1.0);
    distance(position, [a[0] + part * along[0], a[1] + part * along[1]])
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn positions_lie_in_their_zone() {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let disc = Zone::at([3.0, 4.0], 2.0, 0.1);
        let band = Zone::along(vec![[0.0, 0.0], [10.0, 0.0], [10.0, 20.0]], 3.0, 0.5);
        let (mut first, mut second) = (0, 0);
        for _ in 0..2000 {
            let p = disc.any(&mut random);
            assert!(distance(p, [3.0, 4.0]) <= (4.0 / std::f64::consts::PI).sqrt());
            let [x, y] = band.any(&mut random);
            assert!((-0.5..=10.5).contains(&x) && (-0.5..=20.0).contains(&y), "{x} {y}");
            if y.abs() <= 0.5 && x < 9.5 { first += 1 } else { second += 1 }
        }
        // A third of the line is its first part.
        assert!((550..750).contains(&first), "{first} {second}");
    }
    #[test]
    fn zones_hold_the_positions_in_them() {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let bay = vec![[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [5.0, 4.0], [0.0, 10.0]];
        let zones =
            [Zone::at([3.0, 4.0], 2.0, 0.1), Zone::along(vec![[0.0, 0.0], [10.0, 0.0]], 3.0, 0.5), Zone::Polygon(bay)];
        for zone in &zones {
            let ([x, y], reach) = zone.round();
            for _ in 0..500 {
                let position = zone.any(&mut random);
                assert!(zone.contains(position[0], position[1]) && distance(position, [x, y]) <= reach);
            }
            assert!(!zone.contains(5.0, 6.0) || zone.reach() < 5.0);
        }
    }
}

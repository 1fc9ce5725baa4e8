//! Exact solutions along one axis, as read from their files.

use corpuscle_model::ModelError;
use corpuscle_terrain::{Bounds, Terrain};
use std::path::Path;

/// Lines across a channel along which it is measured.
const LINES: usize = 7;

/// Depth and ground at positions along a channel, evenly apart; cubic between them.
#[derive(Debug, Clone)]
pub(super) struct Profile {
    pub x: Vec<f64>,
    pub depth: Vec<f64>,
    pub ground: Vec<f64>,
}

impl Profile {
    /// Reads the columns for position, depth and ground (numbered from 0).
    pub fn read(path: &Path, columns: [usize; 3]) -> Result<Self, ModelError> {
        let rows = numbers(path)?;
        let column = |k: usize| rows.iter().map(|row| row.get(k).copied().unwrap_or(f64::NAN)).collect();
        let [x, depth, ground] = columns.map(column);
        Ok(Self { x, depth, ground })
    }

    /// The water after 500 s of rain that moves along, in a channel of `round` m in which it comes round.
    pub fn of_mobile_rain(path: &Path, round: f64) -> Result<Self, ModelError> {
        let both = Self::read(path, [0, 1, 2])?;
        // The file has two times, 500 s and 1000 s; at the former the rain is between 6250 m and 9850 m.
        let half = both.x.len() / 2;
        let here = (0..half).filter(|&k| (5100.0..5000.0 + round).contains(&both.x[k]));
        let (x, depth): (Vec<f64>, Vec<f64>) = here.map(|k| (both.x[k].rem_euclid(round), both.depth[k])).unzip();
        Ok(Self { ground: vec![0.0; x.len()], x, depth })
    }

    /// Distance between positions, m.
    pub fn step(&self) -> f64 {
        self.x[1] - self.x[0]
    }

    /// From the first side of the first position's cell to the last side of the last one's, m.
    pub fn length(&self) -> f64 {
        self.x.len() as f64 * self.step()
    }

    /// A column at a position and its slope, by a cubic through four values (Catmull & Rom 1974); beyond the ends as at them.
    fn between(&self, values: &[f64], x: f64) -> (f64, f64) {
        let last = values.len() as i64 - 1;
        let at = (x - self.x[0]) / self.step();
        let first = at.floor();
        let value = |k: i64| values[(first as i64 + k).clamp(0, last) as usize];
        let [a, b, c, d] = [-1, 0, 1, 2].map(value);
        let t = at - first;
        let [linear, square, cube] = [0.5 * (c - a), a - 2.5 * b + 2.0 * c - 0.5 * d, 0.5 * (d - a) + 1.5 * (b - c)];
        let here = b + t * (linear + t * (square + t * cube));
        (here, (linear + t * (2.0 * square + t * 3.0 * cube)) / self.step())
    }

    /// Ground in a channel that runs on from its ends with the slopes `[before, behind]`.
    pub fn terrain(&self, bounds: Bounds, cell: f64, slopes: [f64; 2]) -> Terrain {
        let profile = self.clone();
        let (first, last) = (self.x[0], self.x[self.x.len() - 1]);
        Terrain::analytic(bounds, cell, move |x, _| {
            let (end, slope) = if x < first { (first, slopes[0]) } else { (last, slopes[1]) };
            if (first..=last).contains(&x) {
                let (height, slope) = profile.between(&profile.ground, x);
                return (height, [slope, 0.0]);
            }
            (profile.between(&profile.ground, end).0 + slope * (x - end), [slope, 0.0])
        })
    }

    /// Slope of the ground at a position; beyond the ends that at them.
    pub fn slope_at(&self, x: f64) -> f64 {
        let last = self.x.len() - 1;
        let (first, last) = (self.x[0] + self.step(), self.x[last] - self.step());
        self.between(&self.ground, x.clamp(first, last)).1
    }

    /// mean |h - h_exact| / mean h_exact over all positions, and lines across a strip `width` m wide.
    pub fn error_of(&self, depth: impl Fn(f64, f64) -> f64, width: f64) -> f64 {
        let (mut wrong, mut right) = (0.0, 0.0);
        for (&x, &exact) in self.x.iter().zip(&self.depth) {
            for line in 0..LINES {
                let found = depth(x, width * (line as f64 + 0.5) / LINES as f64);
                wrong += (found - exact).abs();
                right += exact;
            }
        }
        wrong / right
    }
}

/// The rows of numbers of a file; lines that begin with `#` are passed over.
pub(super) fn numbers(path: &Path) -> Result<Vec<Vec<f64>>, ModelError> {
    let refused = |what: String| ModelError::Setup(format!("{}: {what}", path.display()));
    let text = std::fs::read_to_string(path).map_err(|error| refused(error.to_string()))?;
    let lines = text.lines().filter(|line| !line.starts_with('#') && !line.trim().is_empty());
    let row = |line: &str| line.split_whitespace().map(str::parse).collect::<Result<Vec<f64>, _>>();
    lines.map(|line| row(line).map_err(|error| refused(format!("`{line}`: {error}")))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_its_places_a_profile_is_smooth_and_has_its_slope() {
        let x: Vec<f64> = (0..40).map(|k| 0.25 * f64::from(k)).collect();
        let wave: Vec<f64> = x.iter().map(|x| x.sin()).collect();
        let profile = Profile { x, depth: wave.clone(), ground: wave };
        for at in [1.1, 2.0, 4.33, 7.9] {
            let (value, slope) = profile.between(&profile.ground, at);
            assert!((value - at.sin()).abs() < 1e-3 && (slope - at.cos()).abs() < 1e-2, "{at}: {value} {slope}");
        }
    }
}

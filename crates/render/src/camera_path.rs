//! Moving cameras, for films.

use crate::{Camera, Lens};
use glam::DVec3;

/// A smooth path of a camera through given stations.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraPath {
    /// Times, s, and cameras; in order of time.
    stations: Vec<(f64, Camera)>,
}

impl CameraPath {
    /// A path through cameras at times; put in order. None without a station.
    pub fn through(mut stations: Vec<(f64, Camera)>) -> Option<Self> {
        stations.retain(|(time, _)| time.is_finite());
        stations.sort_by(|one, other| one.0.total_cmp(&other.0));
        stations.dedup_by(|later, earlier| later.0 == earlier.0);
        (!stations.is_empty()).then_some(Self { stations })
    }

    /// The camera at a time; before the first station and after the last it rests there.
    pub fn at(&self, time: f64) -> Camera {
        let next = self.stations.partition_point(|(at, _)| *at <= time);
        let last = self.stations.len() - 1;
        if next == 0 || next > last {
            return self.stations[next.min(last)].1;
        }
        let [before, from, to, after] = [next.saturating_sub(2), next - 1, next, (next + 1).min(last)];
        let station = |index: usize| &self.stations[index];
        let part = (time - station(from).0) / (station(to).0 - station(from).0);
        let smooth = |of: fn(&Camera) -> DVec3| {
            let points = [before, from, to, after].map(|index| (station(index).0, of(&station(index).1)));
            hermite(points, part)
        };
        let [start, end] = [station(from).1, station(to).1];
        Camera {
            eye: smooth(|camera| camera.eye),
            target: smooth(|camera| camera.target),
            up: smooth(|camera| camera.up).normalize_or(DVec3::Z),
            lens: between(start.lens, end.lens, part),
        }
    }
}

/// Between the second and the third of four points in time: a cubic through these, its speeds those from neighbour to neighbour
/// (Catmull & Rom 1974, for uneven times).
fn hermite([before, from, to, after]: [(f64, DVec3); 4], part: f64) -> DVec3 {
    let span = to.0 - from.0;
    let speed = |one: (f64, DVec3), other: (f64, DVec3)| {
        if other.0 > one.0 { (other.1 - one.1) / (other.0 - one.0) * span } else { DVec3::ZERO }
    };
    let (start, end) = (speed(before, to), speed(from, after));
    let (square, cube) = (part * part, part * part * part);
    from.1 * (2.0 * cube - 3.0 * square + 1.0)
        + start * (cube - 2.0 * square + part)
        + to.1 * (3.0 * square - 2.0 * cube)
        + end * (cube - square)
}

/// A projection between two of a kind; two of different kinds change half way.
fn between(from: Lens, to: Lens, part: f64) -> Lens {
    let mix = |a: f64, b: f64| a + (b - a) * part;
    match (from, to) {
        (Lens::Perspective { field_of_view: a }, Lens::Perspective { field_of_view: b }) => {
            Lens::Perspective { field_of_view: mix(a, b) }
        }
        (Lens::Orthographic { height: a }, Lens::Orthographic { height: b }) => {
            Lens::Orthographic { height: mix(a, b) }
        }
        _ if part < 0.5 => from,
        _ => to,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(x: f64) -> Camera {
        let lens = Lens::Perspective { field_of_view: 0.5 };
        Camera { eye: DVec3::new(x, x * x, 3.0), target: DVec3::ZERO, up: DVec3::Z, lens }
    }

    #[test]
    fn a_path_goes_through_its_stations_without_a_jerk() {
        let times = [0.0, 1.0, 3.0, 4.0];
        let path = CameraPath::through(times.map(|time| (time, camera(time))).to_vec()).unwrap();
        for time in times {
            assert!((path.at(time).eye - camera(time).eye).length() < 1e-12);
        }
        let speed = |time: f64| (path.at(time + 1e-6).eye - path.at(time).eye) / 1e-6;
        for time in [1.0, 3.0] {
            assert!((speed(time) - speed(time - 1e-6)).length() < 1e-4);
        }
        assert_eq!((path.at(-5.0), path.at(9.0)), (camera(0.0), camera(4.0)));
        assert!(CameraPath::through(Vec::new()).is_none());
    }
}

//! An estimate of the water that is still to come: from inflows, rain, and edges and zones that are held at a level.

use super::Flood;
use crate::edges::EdgeRule;
use crate::rain::Ground;
use corpuscle_scene::Table;

/// Rain makes at most so many particles for each cell of the ground: what falls on a cell that particles cover goes to
/// them. Measured: 2.0 on `flood/cloudburst`, where they run together in a brook.
const RAIN_PER_CELL: f64 = 2.0;

/// Discharge over a broad crest, over √g H^(3/2) and its width: (2/3)^(3/2) (Chow 1959, section 3-7: critical flow).
const CRITICAL_FLOW: f64 = 0.544;

/// Positions along each edge, and times, at which held levels are looked at.
const SAMPLES: usize = 100;

/// Positions along each side of the ground at which the room below a level is looked at.
const LATTICE: usize = 200;

/// A level over time along a rim: heights of the ground there, m, each with the width that it stands for, m.
struct Rim<'a> {
    level: &'a Table,
    ground: Vec<f64>,
    width: f64,
}

impl Flood {
    /// About how many particles come in from `from` to `until`, s, by inflows, rain, and what is held at a level. What
    /// leaves meanwhile is not taken off.
    pub fn particles_to_come(&self, from: f64, until: f64) -> f64 {
        let inflow: f64 = self.sources.iter().map(|source| source.discharge.integral(from, until)).sum();
        let rain = self.ground.as_ref().map_or(0.0, |ground| self.rain_to_come(ground, from, until));
        (inflow + self.held_to_come(from, until)) / self.volume + rain
    }

    /// Particles that rain makes: one of each film, but few where they cover the ground.
    fn rain_to_come(&self, ground: &Ground, from: f64, until: f64) -> f64 {
        let cells = ground.factor.iter().filter(|factor| **factor > 0.0).count() as f64;
        let most = (RAIN_PER_CELL * cells - self.inside().count() as f64).max(0.0);
        (ground.runoff(&self.state.wetness, from, until) / (ground.film * ground.area)).min(most)
    }

    /// Water that comes from where levels are held, m3: what flows over their rims at the critical depth, and no more
    /// than finds room below the highest of the levels.
    fn held_to_come(&self, from: f64, until: f64) -> f64 {
        let rims = self.rims();
        let times = || (0..SAMPLES).map(|k| from + (k as f64 + 0.5) / SAMPLES as f64 * (until - from));
        let highest =
            rims.iter().flat_map(|rim| times().map(|time| rim.level.at(time))).fold(f64::NEG_INFINITY, f64::max);
        let gravity = self.settings.gravity_m_per_s2;
        let discharge = |rim: &Rim, level: f64| {
            let per_width =
                rim.ground.iter().map(|ground| CRITICAL_FLOW * gravity.sqrt() * (level - ground).max(0.0).powf(1.5));
            per_width.sum::<f64>() * rim.width
        };
        let flow: f64 = rims
            .iter()
            .flat_map(|rim| times().map(move |time| (rim, rim.level.at(time))))
            .map(|(rim, level)| discharge(rim, level))
            .sum();
        let flow = flow / SAMPLES as f64 * (until - from);
        if flow > 0.0 { flow.min(self.room_below(highest)) } else { 0.0 }
    }

    /// The edges and zones that are held at a level.
    fn rims(&self) -> Vec<Rim<'_>> {
        let terrain = &self.surroundings.terrain;
        let bounds = terrain.bounds();
        let along = |k: usize| (k as f64 + 0.5) / SAMPLES as f64;
        let [width, height] = bounds.size();
        let levels = self.surroundings.edges.rules.iter().enumerate().filter_map(|(side, rule)| match rule {
            EdgeRule::Stage(level) => Some((side, level)),
            _ => None,
        });
        let edges = levels.map(|(side, level)| {
            let position = |k: usize| match side {
                0 => [bounds.x_min, bounds.y_min + along(k) * height],
                1 => [bounds.x_max, bounds.y_min + along(k) * height],
                2 => [bounds.x_min + along(k) * width, bounds.y_min],
                _ => [bounds.x_min + along(k) * width, bounds.y_max],
            };
            let ground = (0..SAMPLES).map(position).map(|[x, y]| terrain.height(x, y)).collect();
            let length = if side < 2 { height } else { width };
            (level, ground, length / SAMPLES as f64)
        });
        let zones = self.structures.held.iter().map(|held| {
            let ground: Vec<f64> = held.zone.looks().into_iter().map(|[x, y]| terrain.height(x, y)).collect();
            let width = held.zone.rim() / ground.len().max(1) as f64;
            (&held.level, ground, width)
        });
        edges.chain(zones).map(|(level, ground, width)| Rim { level, ground, width }).collect()
    }

    /// Room on the ground and on the water as it stands below a level, m3.
    fn room_below(&self, level: f64) -> f64 {
        let water = self.sampler(self.since());
        let terrain = &self.surroundings.terrain;
        let bounds = terrain.bounds();
        let [width, height] = bounds.size().map(|length| length / LATTICE as f64);
        let position = |k: usize, low: f64, size: f64| low + (k as f64 + 0.5) * size;
        let positions = (0..LATTICE * LATTICE)
            .map(|k| [position(k % LATTICE, bounds.x_min, width), position(k / LATTICE, bounds.y_min, height)]);
        let room = positions.map(|[x, y]| (level - terrain.height(x, y) - water.at(x, y).depth).max(0.0));
        room.sum::<f64>() * width * height
    }
}

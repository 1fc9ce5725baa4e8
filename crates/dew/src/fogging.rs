//! Where and since when the solids are wet, and when they were clear again.

use crate::drops::{Drops, Share, Site};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A solid is clear again when drops cover less of it than this part of the most that they ever covered.
const CLEAR: f64 = 0.01;

/// What was seen at a site.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Spot {
    /// The most water, kg.
    pub most_water: f64,
    /// When the first drop was on it, s.
    pub first: Option<f64>,
    /// For how long drops were on it, s.
    pub wet_for: f64,
}

/// What was seen of a solid.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Story {
    /// Area that drops cover, m2.
    pub covered: f64,
    /// Drops on it.
    pub drops: u64,
    /// When its first drop was seen, s.
    pub first: Option<f64>,
    /// The most area that drops covered, m2, and when, s.
    pub most: f64,
    /// When that was, s.
    pub most_at: f64,
    /// Since when it is clear again, s.
    pub clear: Option<f64>,
}

impl Story {
    fn see(&mut self, time: f64) {
        if self.covered > self.most {
            (self.most, self.most_at) = (self.covered, time);
        }
        if self.drops > 0 && self.first.is_none() {
            self.first = Some(time);
        }
        let is_clear = self.first.is_some() && self.covered < CLEAR * self.most;
        self.clear = if is_clear { self.clear.or(Some(time)) } else { None };
    }

    /// From when most was covered until it was clear, s.
    pub fn time_to_clear(&self) -> Option<f64> {
        self.clear.map(|clear| clear - self.most_at)
    }
}

/// What was seen of all solids.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Fogging {
    /// Of each site.
    pub spots: Vec<Spot>,
    /// Of each solid.
    pub stories: Vec<Story>,
}

impl Fogging {
    pub fn new(sites: usize, solids: usize) -> Self {
        Self { spots: vec![Spot::default(); sites], stories: vec![Story::default(); solids] }
    }

    /// Sees what is there at `time`, `step` s after the look before.
    pub fn see(&mut self, drops: &Drops, shares: &[Share], time: f64, step: f64) {
        for (spot, share) in self.spots.iter_mut().zip(shares) {
            spot.most_water = spot.most_water.max(share.water);
            if share.covered > 0.0 {
                spot.first = spot.first.or(Some(time));
                spot.wet_for += step;
            }
        }
        for story in &mut self.stories {
            (story.covered, story.drops) = (0.0, 0);
        }
        for drop in drops.drops() {
            let story = &mut self.stories[drop.solid as usize];
            story.covered += PI * drops.covered_radius(drop).powi(2);
            story.drops += 1;
        }
        self.stories.iter_mut().for_each(|story| story.see(time));
    }
}

/// Area of a solid on which water can condense, m2.
pub(crate) fn open_area(sites: &[Site], solid: usize) -> f64 {
    let of_solid = sites.iter().filter(|site| site.solid as usize == solid);
    of_solid.map(|site| (2.0 * site.half_width).powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::Story;

    #[test]
    fn a_solid_clears_and_fogs_again() {
        let mut story = Story::default();
        let mut see = |covered: f64, drops, time| {
            (story.covered, story.drops) = (covered, drops);
            story.see(time);
            story
        };
        assert_eq!(see(0.0, 0, 1.0), Story::default());
        assert_eq!(see(2.0, 5, 2.0).first, Some(2.0));
        assert_eq!(see(1.0, 5, 3.0).clear, None);
        assert_eq!(see(0.01, 1, 4.0).clear, Some(4.0));
        assert_eq!(see(0.0, 0, 5.0).time_to_clear(), Some(2.0));
        assert_eq!(see(0.5, 3, 6.0).clear, None);
    }
}

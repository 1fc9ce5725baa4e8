//! Where and since when the solids are wet, and when they were clear again.

use crate::drops::{Begun, Drops, Patch, Share};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A solid is clear again when drops cover less of it than this part of the most that they ever covered.
const CLEAR: f64 = 0.01;

/// What was seen at a patch.
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
    /// Area that drops cover, m2, those that are too small to be seen included.
    pub covered: f64,
    /// Drops on it that are seen.
    pub drops: u64,
    /// Mean radius of the disks that they cover, m, and how far the radii spread over it (standard deviation over mean).
    pub mean_radius: f64,
    /// See `mean_radius`.
    pub polydispersity: f64,
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
        if self.drops > 0 {
            self.first = self.first.or(Some(time));
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
    /// Of each patch.
    pub spots: Vec<Spot>,
    /// Of each solid.
    pub stories: Vec<Story>,
}

impl Fogging {
    pub fn new(patches: usize, solids: usize) -> Self {
        Self { spots: vec![Spot::default(); patches], stories: vec![Story::default(); solids] }
    }

    /// Sees which drops have begun in a time of `step` s that ends at `time`.
    pub fn see_begun(&mut self, drops: &Drops, begun: &[Begun], time: f64, step: f64) {
        let earlier = |known: &mut Option<f64>, time: f64| *known = Some(known.map_or(time, |known| known.min(time)));
        for begun in begun {
            let site = &drops.sites()[begun.site as usize];
            let began = time - (1.0 - begun.after) * step;
            let (spot, story) = (&mut self.spots[site.patch as usize], &mut self.stories[site.solid as usize]);
            earlier(&mut spot.first, began);
            earlier(&mut story.first, began);
        }
    }

    /// Sees what is there at `time`, `step` s after the look before.
    pub fn see(&mut self, drops: &Drops, shares: &[Share], time: f64, step: f64) {
        for story in &mut self.stories {
            (story.covered, story.drops, story.mean_radius, story.polydispersity) = (0.0, 0, 0.0, 0.0);
        }
        for (patch, (spot, share)) in self.spots.iter_mut().zip(shares).enumerate() {
            spot.most_water = spot.most_water.max(share.water);
            if share.covered > 0.0 {
                spot.first = spot.first.or(Some(time));
                spot.wet_for += step;
            }
            let at = &drops.patches()[patch];
            self.stories[at.solid as usize].covered += at.area() * drops.unseen_on(patch, share).covered;
        }
        // Sums of the radii and of their squares first.
        for drop in drops.drops() {
            let story = &mut self.stories[drop.solid as usize];
            let radius = drop.radius;
            story.covered += PI * radius * radius;
            story.drops += 1;
            story.mean_radius += radius;
            story.polydispersity += radius * radius;
        }
        for story in self.stories.iter_mut().filter(|story| story.drops > 0) {
            let count = story.drops as f64;
            let (mean, square) = (story.mean_radius / count, story.polydispersity / count);
            (story.mean_radius, story.polydispersity) = (mean, (square / (mean * mean) - 1.0).max(0.0).sqrt());
        }
        self.stories.iter_mut().for_each(|story| story.see(time));
    }
}

/// Area of a solid on which water can condense, m2.
pub(crate) fn open_area(patches: &[Patch], solid: usize) -> f64 {
    let of_solid = patches.iter().filter(|patch| patch.solid as usize == solid);
    of_solid.map(Patch::area).sum()
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

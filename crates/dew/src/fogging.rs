//! Where and since when the solids are wet, and when they were clear again.

use crate::drops::{Begun, Drops, Patch, Share};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A surface is fogged where drops, those that are too small to be seen included, cover this part of it.
const FOGGED: f64 = 0.1;

/// It is clear again when drops cover less of it than this part of the most that they ever covered.
const CLEAR: f64 = 0.01;

/// How much of a surface drops cover, those that are too small to be seen included, and when they did.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Cover {
    /// Part of the surface, now.
    pub part: f64,
    /// The largest part so far.
    pub most: f64,
    /// When that was, s.
    pub most_at: f64,
    /// When it was fogged first, s.
    pub fogged: Option<f64>,
    /// Since when it is clear again, s.
    pub clear: Option<f64>,
}

impl Cover {
    /// Sees that drops cover a part at `time`. A surface that was never fogged clears only where it was `wet`.
    fn see(&mut self, part: f64, time: f64, wet: bool) {
        self.part = part;
        if part > self.most {
            (self.most, self.most_at) = (part, time);
        }
        if part >= FOGGED {
            self.fogged = self.fogged.or(Some(time));
        }
        let is_clear = (wet || self.fogged.is_some()) && part < CLEAR * self.most;
        self.clear = if is_clear { self.clear.or(Some(time)) } else { None };
    }

    /// From when most was covered until it was clear, s.
    pub fn time_to_clear(&self) -> Option<f64> {
        self.clear.map(|clear| clear - self.most_at)
    }
}

/// What was seen at a patch.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Spot {
    /// The most water, kg.
    pub most_water: f64,
    /// When the first drop was on it, s.
    pub first: Option<f64>,
    /// For how long drops were on it, s.
    pub wet_for: f64,
    /// How much drops cover of it.
    pub cover: Cover,
}

/// What was seen of a solid.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Story {
    /// Area that drops cover, m2, those that are too small to be seen included.
    pub covered: f64,
    /// How much of it that is, and since when.
    pub cover: Cover,
    /// Drops on it that are seen.
    pub drops: u64,
    /// Mean radius of the disks that they cover, m, and how far the radii spread over it (standard deviation over mean).
    pub mean_radius: f64,
    /// See `mean_radius`.
    pub polydispersity: f64,
    /// When its first drop was seen, s.
    pub first: Option<f64>,
}

/// What was seen of all solids.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Fogging {
    /// Of each patch.
    pub spots: Vec<Spot>,
    /// Of each solid.
    pub stories: Vec<Story>,
    /// Of each face.
    pub faces: Vec<Cover>,
}

/// A part of a solid's surface that is measured by itself.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SurfaceFace {
    /// Number of the solid.
    pub solid: usize,
    /// Its name.
    pub name: String,
    /// The patches that it consists of.
    pub patches: Vec<u32>,
    /// Their area, m2.
    pub area: f64,
}

impl Fogging {
    pub fn new(patches: usize, solids: usize) -> Self {
        Self { spots: vec![Spot::default(); patches], stories: vec![Story::default(); solids], faces: Vec::new() }
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

    /// Updates the records at `time`, `step` s after the last update. `areas` are those of the solids on which water can condense, m2.
    pub fn see(&mut self, drops: &Drops, shares: &[Share], faces: &[SurfaceFace], areas: &[f64], time: f64, step: f64) {
        for story in &mut self.stories {
            (story.covered, story.drops, story.mean_radius, story.polydispersity) = (0.0, 0, 0.0, 0.0);
        }
        self.see_patches(drops, shares, time, step);
        self.see_drops(drops);
        for (story, area) in self.stories.iter_mut().zip(areas).filter(|(_, area)| **area > 0.0) {
            if story.drops > 0 {
                story.first = story.first.or(Some(time));
            }
            story.cover.see(story.covered / area, time, story.first.is_some());
        }
        for (cover, face) in self.faces.iter_mut().zip(faces) {
            let covered = |&patch: &u32| self.spots[patch as usize].cover.part * drops.patches()[patch as usize].area();
            cover.see(face.patches.iter().map(covered).sum::<f64>() / face.area, time, false);
        }
    }

    fn see_patches(&mut self, drops: &Drops, shares: &[Share], time: f64, step: f64) {
        for (patch, (spot, share)) in self.spots.iter_mut().zip(shares).enumerate() {
            spot.most_water = spot.most_water.max(share.water);
            if share.covered > 0.0 {
                spot.first = spot.first.or(Some(time));
                spot.wet_for += step;
            }
            let at = &drops.patches()[patch];
            let unseen = drops.unseen_on(patch, share).covered;
            self.stories[at.solid as usize].covered += at.area() * unseen;
            // Where a drop ends within a patch the patch may seem more than covered.
            spot.cover.see((share.covered / at.area() + unseen).min(1.0), time, false);
        }
    }

    /// Adds the drops that are seen to the stories of their solids.
    fn see_drops(&mut self, drops: &Drops) {
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
    }
}

/// Area of a solid on which water can condense, m2.
pub(crate) fn open_area(patches: &[Patch], solid: usize) -> f64 {
    let of_solid = patches.iter().filter(|patch| patch.solid as usize == solid);
    of_solid.map(Patch::area).sum()
}

#[cfg(test)]
mod tests {
    use super::Cover;

    #[test]
    fn a_surface_fogs_clears_and_fogs_again() {
        let mut cover = Cover::default();
        let mut see = |part: f64, time| {
            cover.see(part, time, false);
            cover
        };
        assert_eq!(see(0.0, 1.0), Cover::default());
        assert_eq!(see(0.08, 2.0).fogged, None);
        assert_eq!(see(0.4, 3.0).fogged, Some(3.0));
        assert_eq!(see(0.2, 4.0).clear, None);
        assert_eq!(see(0.003, 5.0).clear, Some(5.0));
        assert_eq!(see(0.0, 6.0).time_to_clear(), Some(2.0));
        assert_eq!(see(0.2, 7.0).clear, None);
        assert_eq!(see(0.2, 8.0).fogged, Some(3.0));
    }

    #[test]
    fn a_surface_that_was_never_fogged_clears_where_it_was_wet() {
        for (wet, clear) in [(true, Some(3.0)), (false, None)] {
            let mut cover = Cover::default();
            cover.see(0.05, 2.0, wet);
            cover.see(0.0, 3.0, wet);
            assert_eq!((cover.clear, cover.fogged), (clear, None));
        }
    }
}

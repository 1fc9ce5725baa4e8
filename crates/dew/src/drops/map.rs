//! Where the water is, patch by patch.

use super::{Drop, Drops, Unseen, contact_line, distance2, dot};
use std::f64::consts::PI;

/// What is on a patch.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Share {
    /// Water, kg.
    pub water: f64,
    /// Area covered by resolved drops, m2.
    pub covered: f64,
    /// Water in unresolved drops or in a film, kg.
    pub unseen: f64,
    /// Vapour that leaves the resolved drops, over diffusivity and difference of density, m.
    pub evaporation: f64,
}

/// What a drop has on a patch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Portion {
    /// Index of the drop in [`Drops::drops`].
    pub drop: u32,
    /// Number of the patch.
    pub patch: u32,
    /// Water, kg.
    pub water: f64,
    /// Area that the drop covers of it, m2.
    pub covered: f64,
}

impl Drops {
    /// The share of each patch: the unresolved drops of its sites, and of each resolved one a part in proportion to the areas of the patches
    /// whose middle it covers. A drop that covers the middle of none is on the nearest. All shares together are all water, but for drops on
    /// solids without patches.
    pub fn shares(&self) -> Vec<Share> {
        self.shares_of(&self.portions())
    }

    /// What each drop has on each patch, drop by drop.
    pub fn portions(&self) -> Vec<Portion> {
        let mut portions = Vec::new();
        for (number, drop) in self.state.drops.iter().enumerate() {
            let under = self.patches_under(drop);
            let all: f64 = under.iter().map(|&patch| self.patches[patch].area()).sum();
            let covered = PI * drop.radius.powi(2);
            for patch in under {
                let part = self.patches[patch].area() / all;
                let (drop, patch, water) = (number as u32, patch as u32, part * drop.mass);
                portions.push(Portion { drop, patch, water, covered: part * covered });
            }
        }
        portions
    }

    /// The share of each patch, with these portions of the drops.
    pub fn shares_of(&self, portions: &[Portion]) -> Vec<Share> {
        let mut shares = vec![Share::default(); self.patches.len()];
        for piece in &self.sites.pieces {
            shares[piece.patch as usize].unseen += piece.of_site * self.state.unseen[piece.site as usize];
        }
        shares.iter_mut().for_each(|share| share.water = share.unseen);
        for portion in portions {
            let share = &mut shares[portion.patch as usize];
            share.water += portion.water;
            share.covered += portion.covered;
            let drop = &self.state.drops[portion.drop as usize];
            share.evaporation += contact_line::evaporation(self.angle(drop)) * portion.covered / (PI * drop.radius);
        }
        shares
    }

    /// The unresolved drops of a patch, where it has this share: on the area that resolved drops leave.
    pub fn unseen_on(&self, patch: usize, share: &Share) -> Unseen {
        let Some(at) = self.patches.get(patch).filter(|at| !self.has_film(at.solid)) else { return Unseen::default() };
        let bare = (1.0 - share.covered / at.area()).max(MIN_BARE_PART);
        let thickness = share.unseen / (self.laws.density * at.area() * bare);
        let Unseen { radius, covered } =
            Unseen::new(thickness, self.water[at.solid as usize].sites_per_area(), self.cap);
        Unseen { radius, covered: bare * covered }
    }

    /// Vapour that leaves the drops of a patch where it has this share, over diffusivity, difference of density and area, 1/m: through the air within a few radii of each
    /// drop, so that many small drops evaporate as fast as a wet surface does, and a single one by its radius. Where they cover more, what leaves them spreads
    /// less: (1 - sqrt(covered))^1.5, as heat at contacts (Cooper, Mikic & Yovanovich, International Journal of Heat and Mass Transfer 12, 1969, 279). Infinite from a
    /// film: nothing but the air holds its vapour back.
    pub fn evaporation_on(&self, patch: usize, share: &Share) -> f64 {
        let Some(at) = self.patches.get(patch) else { return 0.0 };
        if self.has_film(at.solid) {
            return if share.unseen > 0.0 { f64::INFINITY } else { 0.0 };
        }
        let unseen = self.unseen_on(patch, share);
        let covered = (share.covered / at.area() + unseen.covered).min(1.0);
        let of_unseen = contact_line::evaporation(self.laws.contact_angle) * unseen.covered
            / (PI * unseen.radius.max(f64::MIN_POSITIVE));
        (share.evaporation / at.area() + of_unseen) / (1.0 - covered.sqrt()).powf(1.5)
    }

    /// Water evaporates where `gained` (kg, one for each patch) is below 0: from all drops there, in proportion to what each has of the patch.
    /// `portions` and `shares` give that; nothing must have happened to the drops since.
    pub fn evaporate(&mut self, portions: &[Portion], shares: &[Share], gained: &[f64]) {
        if gained.iter().all(|&gained| gained >= 0.0) {
            return;
        }
        // The part of the water that leaves.
        let lost = |patch: u32| {
            let gained = gained[patch as usize];
            if gained < 0.0 { -gained / shares[patch as usize].water } else { 0.0 }
        };
        for portion in portions {
            let mass = &mut self.state.drops[portion.drop as usize].mass;
            *mass = a_molecule_or_more(*mass - lost(portion.patch) * portion.water);
        }
        self.gains.fill(0.0);
        for piece in &self.sites.pieces {
            self.gains[piece.site as usize] += piece.of_site * lost(piece.patch);
        }
        for (unseen, lost) in self.state.unseen.iter_mut().zip(&self.gains) {
            *unseen = a_molecule_or_more(*unseen * (1.0 - lost));
        }
    }

    /// The patches whose middle a drop covers, or the nearest.
    pub(super) fn patches_under(&self, drop: &Drop) -> Vec<usize> {
        let covered = drop.radius;
        let is_below = |patch: usize| {
            let patch = &self.patches[patch];
            patch.solid == drop.solid && dot(patch.normal, drop.normal) > 0.0
        };
        let away = |patch: usize| distance2(self.patches[patch].position, drop.position);
        let mut near = Vec::new();
        self.patch_grid.near(drop.position, covered, 0.0, |patch| near.push(patch));
        // Cells that share a bucket give patches that are far, and patches twice.
        let reach = |patch: usize| covered + self.patches[patch].reach();
        near.retain(|&patch| is_below(patch) && away(patch) < reach(patch).powi(2));
        near.sort_unstable();
        near.dedup();
        let under: Vec<usize> = near.iter().copied().filter(|&patch| away(patch) < covered * covered).collect();
        if !under.is_empty() {
            return under;
        }
        let nearest = |patches: &mut dyn Iterator<Item = usize>| patches.min_by(|&a, &b| away(a).total_cmp(&away(b)));
        let found = nearest(&mut near.into_iter());
        let of_all = || nearest(&mut (0..self.patches.len()).filter(|&patch| self.patches[patch].solid == drop.solid));
        found.or_else(of_all).into_iter().collect()
    }
}

/// Mass of a molecule of water, kg.
const MOLECULE: f64 = 2.99e-26;

/// Less than a molecule is what rounding leaves of water that has evaporated.
fn a_molecule_or_more(mass: f64) -> f64 {
    if mass < MOLECULE { 0.0 } else { mass }
}

/// Least part of a patch that unresolved drops are taken to cover.
const MIN_BARE_PART: f64 = 0.02;

//! Where the water is, patch by patch.

use super::{Drop, Drops, distance2, dot};
use std::f64::consts::PI;

/// What a site has of the drops and its film.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Share {
    /// Water, kg.
    pub water: f64,
    /// Area covered by drops, m2.
    pub covered: f64,
}

/// What a drop has on a site.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Portion {
    /// Place of the drop in [`Drops::drops`].
    pub drop: u32,
    /// Number of the site.
    pub site: u32,
    /// Water, kg.
    pub water: f64,
    /// Area that the drop covers of it, m2.
    pub covered: f64,
}

impl Drops {
    /// The share of each site: its film, and of each drop a part in proportion to the areas of the sites whose middle it covers.
    /// A drop that covers the middle of none is that of the nearest. All shares together are all drops and films, but for drops on
    /// solids without sites.
    pub fn shares(&self) -> Vec<Share> {
        self.shares_of(&self.portions())
    }

    /// What each drop has on each site, drop by drop.
    pub fn portions(&self) -> Vec<Portion> {
        let mut portions = Vec::new();
        for (number, drop) in self.state.drops.iter().enumerate() {
            let under = self.sites_under(drop);
            let area = |site: usize| self.sites[site].half_width.powi(2);
            let all: f64 = under.iter().map(|&site| area(site)).sum();
            let covered = PI * self.covered_radius(drop).powi(2);
            for site in under {
                let part = area(site) / all;
                let (drop, site, water) = (number as u32, site as u32, part * drop.mass);
                portions.push(Portion { drop, site, water, covered: part * covered });
            }
        }
        portions
    }

    /// The share of each site, with these portions of the drops.
    pub fn shares_of(&self, portions: &[Portion]) -> Vec<Share> {
        let mut shares: Vec<Share> = self.state.film.iter().map(|&water| Share { water, covered: 0.0 }).collect();
        for portion in portions {
            let share = &mut shares[portion.site as usize];
            share.water += portion.water;
            share.covered += portion.covered;
        }
        shares
    }

    /// Water evaporates where `gained` (kg, one for each site) is below 0: from the film and the drops there, in proportion to what
    /// each has of the site. `portions` and `shares` tell that; nothing must have happened to the drops since.
    pub fn evaporate_from(&mut self, portions: &[Portion], shares: &[Share], gained: &[f64]) {
        // What is left over what there was.
        let kept = |site: usize| if gained[site] < 0.0 { 1.0 + gained[site] / shares[site].water } else { 1.0 };
        for portion in portions {
            let mass = &mut self.state.drops[portion.drop as usize].mass;
            *mass = (*mass - (1.0 - kept(portion.site as usize)) * portion.water).max(0.0);
        }
        for (site, film) in self.state.film.iter_mut().enumerate() {
            *film = (*film * kept(site)).max(0.0);
        }
    }

    /// The sites whose middle a drop covers, or the nearest.
    fn sites_under(&self, drop: &Drop) -> Vec<usize> {
        let covered = self.covered_radius(drop);
        let is_below = |site: usize| {
            let site = &self.sites[site];
            site.solid == drop.solid && dot(site.normal, drop.normal) > 0.0
        };
        let away = |site: usize| distance2(self.sites[site].position, drop.position);
        let mut near = Vec::new();
        self.site_grid.near(drop.position, covered, 0.0, |site| near.push(site));
        // Cells that share a bucket give sites that are far, and sites twice.
        let reach = |site: usize| covered + self.sites[site].reach();
        near.retain(|&site| is_below(site) && away(site) < reach(site).powi(2));
        near.sort_unstable();
        near.dedup();
        let under: Vec<usize> = near.iter().copied().filter(|&site| away(site) < covered * covered).collect();
        if !under.is_empty() {
            return under;
        }
        let nearest = |sites: &mut dyn Iterator<Item = usize>| sites.min_by(|&a, &b| away(a).total_cmp(&away(b)));
        let found = nearest(&mut near.into_iter());
        let of_all = || nearest(&mut (0..self.sites.len()).filter(|&site| self.sites[site].solid == drop.solid));
        found.or_else(of_all).into_iter().collect()
    }
}

//! Where the water is, patch by patch.

use super::grid::Grid;
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

impl Drops {
    /// The share of each site: its film, and of each drop a part in proportion to the areas of the sites whose middle it covers.
    /// A drop that covers the middle of none is that of the nearest. All shares together are all drops and films, but for drops on
    /// solids without sites.
    pub fn shares(&self) -> Vec<Share> {
        let reach: Vec<f64> = self.sites.iter().map(|site| site.half_width * 2_f64.sqrt()).collect();
        let grid = Grid::new(self.sites.iter().map(|site| site.position), &reach);
        let mut shares: Vec<Share> = self.state.film.iter().map(|&water| Share { water, covered: 0.0 }).collect();
        for drop in &self.state.drops {
            let under = self.sites_under(&grid, drop);
            let area = |site: usize| self.sites[site].half_width.powi(2);
            let all: f64 = under.iter().map(|&site| area(site)).sum();
            let covered = PI * self.covered_radius(drop).powi(2);
            for site in under {
                let part = area(site) / all;
                shares[site].water += part * drop.mass;
                shares[site].covered += part * covered;
            }
        }
        shares
    }

    /// The sites whose middle a drop covers, or the nearest.
    fn sites_under(&self, grid: &Grid, drop: &Drop) -> Vec<usize> {
        let covered = self.covered_radius(drop);
        let is_below = |site: usize| {
            let site = &self.sites[site];
            site.solid == drop.solid && dot(site.normal, drop.normal) > 0.0
        };
        let away = |site: usize| distance2(self.sites[site].position, drop.position);
        let mut near = Vec::new();
        grid.near(drop.position, covered, 0.0, |site| near.push(site));
        // Cells that share a bucket give sites that are far, and sites twice.
        let reach = |site: usize| covered + self.sites[site].half_width * 2_f64.sqrt();
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

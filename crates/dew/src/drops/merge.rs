//! Drops that touch become one.

use super::{Drop, Drops, distance2, dot};

/// Sums over drops that become one.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    mass: f64,
    /// Of mass times position.
    position: [f64; 3],
    /// Of mass times velocity.
    momentum: [f64; 3],
    /// Of the squares of the covered radii.
    area: f64,
}

impl Drops {
    /// Merges drops that touch until none do. Mass and momentum of what merges are those of its parts, and its position is the point
    /// of the surface nearest to their centre of mass.
    pub(super) fn merge(&mut self) {
        loop {
            self.file();
            let heads = self.clusters();
            if heads.iter().enumerate().all(|(at, &head)| at == head) {
                return;
            }
            self.unite(&heads);
        }
    }

    /// For each drop the first of its cluster.
    fn clusters(&self) -> Vec<usize> {
        let drops = &self.state.drops;
        let mut heads: Vec<usize> = (0..drops.len()).collect();
        for (at, drop) in drops.iter().enumerate() {
            let reach = self.reach[at];
            // The smaller of two finds the larger.
            self.grid.near(drop.position, reach, reach, |other| {
                let neighbour = &drops[other];
                let touch = distance2(neighbour.position, drop.position) < (reach + self.reach[other]).powi(2)
                    && other != at
                    && neighbour.solid == drop.solid
                    && dot(neighbour.normal, drop.normal) > 0.0;
                if touch {
                    let (a, b) = (head(&mut heads, at), head(&mut heads, other));
                    heads[a.max(b)] = a.min(b);
                }
            });
        }
        (0..drops.len()).map(|at| head(&mut heads, at)).collect()
    }

    /// Makes one drop of all that have the same head.
    fn unite(&mut self, heads: &[usize]) {
        let parts = std::mem::take(&mut self.state.drops);
        let mut sums = vec![Sums::default(); parts.len()];
        let mut largest: Vec<usize> = (0..parts.len()).collect();
        for (at, (part, &head)) in parts.iter().zip(heads).enumerate() {
            let sum = &mut sums[head];
            sum.mass += part.mass;
            sum.area += part.radius * part.radius;
            for axis in 0..3 {
                sum.position[axis] += part.mass * part.position[axis];
                sum.momentum[axis] += part.mass * part.velocity[axis];
            }
            if part.mass > parts[largest[head]].mass {
                largest[head] = at;
            }
        }
        let mut members = vec![0_u32; parts.len()];
        heads.iter().for_each(|&head| members[head] += 1);
        for at in (0..parts.len()).filter(|&at| heads[at] == at) {
            let drop = if members[at] == 1 { parts[at] } else { self.united(&parts[largest[at]], sums[at]) };
            self.state.drops.push(drop);
        }
        self.state.merged += (parts.len() - self.state.drops.len()) as u64;
    }

    fn united(&self, largest: &Drop, Sums { mass, position, momentum, area }: Sums) -> Drop {
        let (position, normal) = self.foot(largest.solid, position.map(|sum| sum / mass));
        // The line stays round the area that the parts covered, as far as the angles let it.
        let radius = self.line.radius(area.sqrt(), mass / self.laws.density);
        Drop { position, normal, mass, radius, velocity: momentum.map(|sum| sum / mass), ..*largest }
    }
}

/// The head of a cluster, with path compression for the next search.
fn head(heads: &mut [usize], mut at: usize) -> usize {
    while heads[at] != at {
        heads[at] = heads[heads[at]];
        at = heads[at];
    }
    at
}

//! Boundary particles: sites at rest that fill the walls of obstacles.

use crate::obstacles::Outlines;
use corpuscle_sph::Cells;
use corpuscle_sph::kernel::{Kernel, SmoothingKernel};

/// Samples along each side of a cell that find how much of it is inside.
const CELL_SAMPLES_PER_SIDE: usize = 4;

/// A boundary particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Site {
    /// Position, m.
    pub x: f64,
    /// Position, m.
    pub y: f64,
    /// Area of the obstacle that it stands for, m2.
    pub area: f64,
    /// V_k = 1 / sum_l W_kl over the boundary particles (Akinci et al. 2012, equation 4), m2: its area as scheme sph-swe has it.
    pub volume: f64,
    /// Unit vector to the nearest wall, out of the obstacle.
    pub normal: [f64; 2],
    /// The obstacle.
    pub obstacle: usize,
    /// Height of its top, m.
    pub top: f64,
}

/// The boundary particles, in cells.
#[derive(Debug, Default)]
pub(crate) struct Sites {
    all: Vec<Site>,
    cells: Cells<2>,
}

impl Sites {
    /// Fills obstacles as deep as `depth` m below their walls with sites `pitch` m apart; `kernel` is that of V_k.
    pub fn new(outlines: &Outlines, pitch: f64, depth: f64, kernel: &Kernel<2>) -> Self {
        let mut all = Vec::new();
        for (number, outline) in outlines.all.iter().enumerate() {
            let bounds = outline.bounds();
            let count = |low: f64, high: f64| ((high - low) / pitch).ceil().max(1.0) as usize;
            for row in 0..count(bounds.y_min, bounds.y_max) {
                for column in 0..count(bounds.x_min, bounds.x_max) {
                    let corner = [bounds.x_min + column as f64 * pitch, bounds.y_min + row as f64 * pitch];
                    all.extend(site(outlines, number, corner, pitch).filter(|site| {
                        let nearest = outlines.nearest_of(number, [site.x, site.y]);
                        nearest.distance > -depth
                    }));
                }
            }
        }
        let mut sites = Self { all, cells: Cells::default() };
        sites.sort(0.5 * depth.max(pitch));
        sites.find_volumes(kernel);
        sites
    }

    fn sort(&mut self, size: f64) {
        if self.all.is_empty() {
            return;
        }
        let x: Vec<f64> = self.all.iter().map(|site| site.x).collect();
        let y: Vec<f64> = self.all.iter().map(|site| site.y).collect();
        self.all = self.cells.sort([&x, &y], [size; 2]).iter().map(|&from| self.all[from as usize]).collect();
    }

    fn find_volumes(&mut self, kernel: &Kernel<2>) {
        let volumes: Vec<f64> = self
            .all
            .iter()
            .map(|site| {
                let mut sum = 0.0;
                self.each([site.x, site.y], kernel.support(), |_, r, _| sum += kernel.value(r * r));
                1.0 / sum
            })
            .collect();
        self.all.iter_mut().zip(volumes).for_each(|(site, volume)| site.volume = volume);
    }

    /// All of them.
    #[cfg(feature = "gpu")]
    pub fn all(&self) -> &[Site] {
        &self.all
    }

    /// Gives the obstacles tops: their heights, m, above the ground below them; none where they are high enough.
    pub fn set_tops(&mut self, heights: &[Option<f64>], ground: impl Fn(f64, f64) -> f64) {
        for site in &mut self.all {
            if let Some(height) = heights[site.obstacle] {
                site.top = ground(site.x, site.y) + height;
            }
        }
    }

    /// Calls `found` with each site nearer than `reach` to a position, its distance, and the way to it, m.
    #[inline]
    pub fn each(&self, [x, y]: [f64; 2], reach: f64, mut found: impl FnMut(&Site, f64, [f64; 2])) {
        if self.all.is_empty() {
            return;
        }
        for site in self.cells.ranges_within([x, y], reach).flat_map(|range| &self.all[range]) {
            let way = [site.x - x, site.y - y];
            let squared = way[0] * way[0] + way[1] * way[1];
            if squared < reach * reach {
                found(site, squared.sqrt(), way);
            }
        }
    }
}

/// What of a cell of the lattice is inside an outline; none where nothing is.
fn site(outlines: &Outlines, number: usize, corner: [f64; 2], pitch: f64) -> Option<Site> {
    let outline = &outlines.all[number];
    let step = pitch / CELL_SAMPLES_PER_SIDE as f64;
    let position = |k: usize| {
        [
            corner[0] + ((k % CELL_SAMPLES_PER_SIDE) as f64 + 0.5) * step,
            corner[1] + ((k / CELL_SAMPLES_PER_SIDE) as f64 + 0.5) * step,
        ]
    };
    let inside: Vec<[f64; 2]> = (0..CELL_SAMPLES_PER_SIDE * CELL_SAMPLES_PER_SIDE)
        .map(position)
        .filter(|&position| outline.contains(position))
        .collect();
    let count = inside.len() as f64;
    let [x, y] = [0, 1].map(|axis| inside.iter().map(|position| position[axis]).sum::<f64>() / count);
    (!inside.is_empty()).then(|| Site {
        x,
        y,
        area: step * step * count,
        volume: 0.0,
        normal: outlines.nearest_of(number, [x, y]).normal,
        obstacle: outline.obstacle,
        top: f64::INFINITY,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::obstacles::Outline;
    use corpuscle_scene::KernelName;

    /// An oblique block.
    fn block() -> Outlines {
        let (sin, cos) = 0.4_f64.sin_cos();
        let corner = |x: f64, y: f64| [cos * x - sin * y, sin * x + cos * y];
        let ring = vec![corner(0.0, 0.0), corner(8.0, 0.0), corner(8.0, 6.0), corner(0.0, 6.0)];
        Outlines::new(vec![Outline { obstacle: 0, rings: vec![ring] }], 3.0)
    }

    #[test]
    fn sites_cover_the_area_with_normals_outwards() {
        let outlines = block();
        let sites = Sites::new(&outlines, 0.25, 100.0, &Kernel::new(KernelName::Mueller, 1.0));
        let area: f64 = sites.all.iter().map(|site| site.area).sum();
        assert!((area / 48.0 - 1.0).abs() < 1e-3, "{area} m2");
        for site in &sites.all {
            let out = [site.x + 3.1 * site.normal[0], site.y + 3.1 * site.normal[1]];
            assert!(outlines.around(out).is_none(), "{site:?}");
            // Amid others, V_k is the area of a lattice's cell.
            let nearest = outlines.nearest_of(0, [site.x, site.y]);
            assert!(nearest.distance > -1.0 || (site.volume / 0.0625 - 1.0).abs() < 0.01, "{site:?}");
        }
        let band = Sites::new(&outlines, 0.25, 1.0, &Kernel::new(KernelName::Mueller, 1.0));
        let area: f64 = band.all.iter().map(|site| site.area).sum();
        // 48 m2 less the 6 x 4 m2 that lie deeper than 1 m.
        assert!((area - 24.0).abs() < 1.0, "{area} m2");
    }
}

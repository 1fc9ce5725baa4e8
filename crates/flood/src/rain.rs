//! Rain, and the ground's surface that it falls on: a film on dry ground, and what soaks in.
//!
//! The ground is divided into cells. Rain over a cell goes to the particles in it, each by the area it stands for; where
//! there are too few to cover it, it stays on the ground as a film, which becomes a particle once it is deep enough. The ground
//! drinks from the film first, then from the particles.

use crate::infiltration::{Law, MM_PER_H, of_class};
use crate::particle::Particle;
use crate::setup::{load, setup};
use corpuscle_model::{ExactSum, Map, ModelError};
use corpuscle_scene::{Flood as Settings, Table};
use corpuscle_terrain::{Bounds, RasterField, Terrain};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Share of a cell that particles must cover for all its rain to be theirs.
const COVERED: f64 = 0.5;

/// A particle that has lost all but this share of its water to the ground is gone.
const DRAINED: f64 = 1e-6;

/// Steps and cells in which the rain that runs off is estimated.
const STEPS_OF_RUNOFF: usize = 40;
const CELLS_OF_RUNOFF: usize = 2000;

/// Where and when it rains: intensity, m/s, over x, y, and time.
pub type RainFunction = Box<dyn Fn(f64, f64, f64) -> f64 + Send + Sync>;

/// How hard it rains.
pub(crate) enum Intensity {
    None,
    /// mm/h over time.
    Table(Table),
    Function(RainFunction),
}

/// What does not change: cells, rain and soils.
pub(crate) struct Ground {
    pub intensity: Intensity,
    /// Depth at which the film of a cell becomes a particle, m.
    pub film: f64,
    bounds: Bounds,
    pub columns: usize,
    pub rows: usize,
    /// Area of a cell, m2.
    pub area: f64,
    /// By what the intensity is multiplied in each cell.
    pub factor: Vec<f64>,
    /// How water soaks into each cell, by number in `laws`.
    pub law: Vec<u16>,
    pub laws: Vec<Option<Law>>,
}

/// What changes.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct Wetness {
    /// Water on the ground of each cell that is no particle yet, m3.
    pub film: Vec<f64>,
    /// What has soaked in, m.
    pub soaked: Vec<f64>,
    /// Until when rain has fallen, s.
    pub until: f64,
    /// All the rain so far, m3.
    pub rained: ExactSum,
    /// All that has soaked in so far, m3.
    pub infiltrated: ExactSum,
    /// What that took of the momentum of the water over its density, sum of both components, since the last look, m4/s.
    pub momentum: f64,
}

/// A film that has become deep enough to be a particle.
pub(crate) struct Drop {
    /// Corner of its cell at the smallest x and y, m.
    pub corner: [f64; 2],
    /// Sides of its cell, m.
    pub size: [f64; 2],
    /// Its volume, m3.
    pub volume: f64,
}

impl Ground {
    /// The ground of a scene, where it rains or water soaks in. Particles hold `volume` m3 and stand up to `widest` m apart.
    pub fn open(
        scene: &Settings,
        terrain: &Terrain,
        folder: &Path,
        volume: f64,
        widest: f64,
    ) -> Result<Option<Self>, ModelError> {
        let by_class = scene.land_use.iter().flat_map(|land_use| &land_use.class);
        let soaks = scene.infiltration.is_some() || by_class.clone().any(|class| class.infiltration.is_some());
        if scene.rain.is_none() && !soaks {
            return Ok(None);
        }
        let film = scene.rain.as_ref().map_or(FILM, |rain| rain.film_m);
        let mut ground = Self::bare(terrain, film, volume, widest);
        let centres: Vec<[f64; 2]> = ground.centres().collect();
        if let Some(rain) = &scene.rain {
            let intensity = load(&rain.intensity_mm_per_h, folder)?;
            if let Some(row) = intensity.rows().iter().find(|row| row[1] < 0.0) {
                return Err(setup(format!(
                    "flood.rain.intensity_mm_per_h is {} mm/h at {} s: rain must not be negative",
                    row[1], row[0]
                )));
            }
            ground.intensity = Intensity::Table(intensity);
            if let Some(path) = &rain.raster {
                let raster = RasterField::open(folder.join(path), terrain).map_err(setup)?;
                let size = ground.size();
                for (factor, &centre) in ground.factor.iter_mut().zip(&centres) {
                    *factor *= mean_factor(&raster, centre, size).map_err(|[x, y]| {
                        let place = terrain.to_own([x, y]);
                        setup(format!("{}: the factor of rain at {place:?} must not be negative", path.display()))
                    })?;
                }
            }
        }
        let rest = scene.infiltration.as_ref().map(Law::of);
        ground.laws = std::iter::once(rest).chain(by_class.map(|class| of_class(class, rest))).collect();
        if let Some(land_use) = &scene.land_use {
            let raster = RasterField::open(folder.join(&land_use.raster), terrain).map_err(setup)?;
            for (law, [x, y]) in ground.law.iter_mut().zip(&centres) {
                let code = raster.nearest(*x, *y);
                let class = land_use.class.iter().position(|class| code == Some(class.code as f64));
                *law = class.map_or(0, |class| class as u16 + 1);
            }
        }
        Ok(Some(ground))
    }

    /// Ground in cells as large as a particle that the film makes, without rain. No rain falls where the terrain has no data.
    fn bare(terrain: &Terrain, film: f64, volume: f64, widest: f64) -> Self {
        let bounds = terrain.bounds();
        let size = (volume / film).sqrt().min(widest);
        let [columns, rows] = bounds.size().map(|length| (length / size).ceil().max(1.0) as usize);
        let area = bounds.size()[0] / columns as f64 * (bounds.size()[1] / rows as f64);
        let cells = columns * rows;
        let mut ground = Self {
            intensity: Intensity::None,
            film,
            bounds,
            columns,
            rows,
            area,
            factor: Vec::new(),
            law: vec![0; cells],
            laws: vec![None],
        };
        let grid = terrain.map_grid();
        let has_data = |[x, y]: [f64; 2]| {
            let [column, row] = grid.position(x, y).map(|at| at.round().max(0.0) as usize);
            terrain.is_valid_cell(column.min(grid.columns - 1), row.min(grid.rows - 1))
        };
        ground.factor = ground.centres().map(|centre| f64::from(u8::from(has_data(centre)))).collect();
        ground
    }

    /// Ground on which it rains as a function says.
    pub fn under(rain: RainFunction, terrain: &Terrain, volume: f64, widest: f64) -> Self {
        Self { intensity: Intensity::Function(rain), ..Self::bare(terrain, FILM, volume, widest) }
    }

    /// Ground without rain, into which nothing soaks.
    pub fn without_rain(terrain: &Terrain, volume: f64, widest: f64) -> Self {
        Self::bare(terrain, FILM, volume, widest)
    }

    /// Nothing on the ground and nothing in it.
    pub fn dry(&self) -> Wetness {
        let cells = self.factor.len();
        Wetness { film: vec![0.0; cells], soaked: vec![0.0; cells], ..Wetness::default() }
    }

    /// Whether a wetness is of this ground.
    pub fn fits(&self, wetness: &Wetness) -> bool {
        wetness.film.len() == self.factor.len()
    }

    pub fn size(&self) -> [f64; 2] {
        let size = self.bounds.size();
        [size[0] / self.columns as f64, size[1] / self.rows as f64]
    }

    fn corner(&self, cell: usize) -> [f64; 2] {
        let size = self.size();
        let (column, row) = (cell % self.columns, cell / self.columns);
        [self.bounds.x_min + column as f64 * size[0], self.bounds.y_min + row as f64 * size[1]]
    }

    /// The middles of the cells.
    pub fn centres(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        let size = self.size();
        (0..self.columns * self.rows).map(move |cell| {
            let corner = self.corner(cell);
            [corner[0] + 0.5 * size[0], corner[1] + 0.5 * size[1]]
        })
    }

    fn cell_at(&self, x: f64, y: f64) -> usize {
        let size = self.size();
        let column = (((x - self.bounds.x_min) / size[0]) as usize).min(self.columns - 1);
        let row = (((y - self.bounds.y_min) / size[1]) as usize).min(self.rows - 1);
        row * self.columns + column
    }

    /// About how much of the rain from `from` to `until` s does not soak in, m3.
    pub fn runoff(&self, wetness: &Wetness, from: f64, until: f64) -> f64 {
        let step = (until - from) / STEPS_OF_RUNOFF as f64;
        let of_cell = |cell: usize| {
            let law = self.laws[usize::from(self.law[cell])];
            let (mut soaked, mut left) = (wetness.soaked[cell], wetness.film[cell] / self.area);
            for k in 0..STEPS_OF_RUNOFF {
                let [from, until] = [k, k + 1].map(|k| from + k as f64 * step);
                left += self.rain(cell, self.rain_of_table(from, until), from, until);
                let drunk = law.map_or(0.0, |law| law.demand(soaked, step)).min(left);
                (soaked, left) = (soaked + drunk, left - drunk);
            }
            left
        };
        // Some cells stand for all.
        let every = (self.factor.len() / CELLS_OF_RUNOFF).max(1);
        let cells = (0..self.factor.len()).step_by(every);
        let mean = cells.clone().map(of_cell).sum::<f64>() / cells.len().max(1) as f64;
        mean * self.area * self.factor.len() as f64
    }

    /// Rain after the table from `from` to `until` s where the factor is 1, m.
    fn rain_of_table(&self, from: f64, until: f64) -> f64 {
        match &self.intensity {
            Intensity::Table(table) => MM_PER_H * table.integral(from, until),
            _ => 0.0,
        }
    }

    /// What has soaked in, on the terrain's own grid; none where nothing can.
    pub fn map(&self, wetness: &Wetness, terrain: &Terrain) -> Option<Map> {
        self.laws.iter().any(Option::is_some).then_some(())?;
        let grid = terrain.map_grid();
        let soaked = |cell: usize| {
            let (column, row) = (cell % grid.columns, cell / grid.columns);
            let [x, y] = grid.centre(column, row);
            if terrain.is_valid_cell(column, row) { wetness.soaked[self.cell_at(x, y)] as f32 } else { f32::NAN }
        };
        Some(Map {
            name: "infiltration",
            title: "Infiltration",
            unit: "m",
            columns: grid.columns,
            rows: grid.rows,
            values: (0..grid.columns * grid.rows).map(soaked).collect(),
        })
    }

    /// Rain on a cell from `from` to `to` s, m.
    fn rain(&self, cell: usize, of_table: f64, from: f64, to: f64) -> f64 {
        match &self.intensity {
            Intensity::None => 0.0,
            Intensity::Table(_) => self.factor[cell] * of_table,
            Intensity::Function(rain) => {
                let size = self.size();
                let [x, y] = self.corner(cell);
                let at = rain(x + 0.5 * size[0], y + 0.5 * size[1], 0.5 * (from + to));
                self.factor[cell] * at * (to - from)
            }
        }
    }

    /// Lets it rain and soak in until `time`; the films that become particles. Particles that have drained away are left with no
    /// volume.
    pub fn wet(&self, wetness: &mut Wetness, particles: &mut [Particle], time: f64) -> Vec<Drop> {
        let (from, step) = (wetness.until, time - wetness.until);
        wetness.until = time;
        let of_table = self.rain_of_table(from, time);
        let covered = self.covered(particles);
        // Of each cell: what each square metre of its water gains, and what the ground takes of that, m.
        let (mut gains, mut demands) = (vec![0.0; covered.len()], vec![0.0; covered.len()]);
        for (cell, &covered) in covered.iter().enumerate() {
            let rain = self.rain(cell, of_table, from, time) * self.area;
            wetness.rained.add(rain);
            let mut film = wetness.film[cell] + rain;
            if let Some(law) = self.laws[usize::from(self.law[cell])] {
                let demand = law.demand(wetness.soaked[cell], step);
                let drunk = film.min(demand * self.area);
                film -= drunk;
                wetness.soaked[cell] += drunk / self.area;
                wetness.infiltrated.add(drunk);
                demands[cell] = (demand - drunk / self.area).max(0.0);
            }
            if covered >= COVERED * self.area {
                demands[cell] *= self.area / covered;
                gains[cell] = film / covered;
                film = 0.0;
            }
            wetness.film[cell] = film;
        }
        self.share(wetness, particles, &gains, &demands);
        self.drops(wetness)
    }

    /// The area that the particles in each cell stand for, m2.
    fn covered(&self, particles: &[Particle]) -> Vec<f64> {
        let mut covered = vec![0.0; self.factor.len()];
        for particle in particles.iter().filter(|particle| is_water(particle)) {
            covered[self.cell_at(particle.x, particle.y)] += particle.area();
        }
        covered
    }

    /// Gives particles their part of what rains on their cell, and takes theirs of what soaks in. Rain falls straight down: it has
    /// no momentum, and slows what it falls on.
    fn share(&self, wetness: &mut Wetness, particles: &mut [Particle], gains: &[f64], demands: &[f64]) {
        for particle in particles.iter_mut().filter(|particle| is_water(particle)) {
            let cell = self.cell_at(particle.x, particle.y);
            let before = particle.volume;
            let gain = particle.area() * gains[cell];
            let full = before + gain;
            let demand = particle.area() * demands[cell];
            let left = if demand < (1.0 - DRAINED) * full { full - demand } else { 0.0 };
            let drunk = full - left;
            particle.u *= before / full;
            particle.v *= before / full;
            particle.volume = left;
            particle.weight *= left / before;
            if drunk > 0.0 {
                wetness.soaked[cell] += drunk / self.area;
                wetness.infiltrated.add(drunk);
                wetness.momentum += drunk * (particle.u + particle.v);
            }
        }
    }

    /// The films deep enough to be particles, taken off the ground.
    fn drops(&self, wetness: &mut Wetness) -> Vec<Drop> {
        let is_deep = |(_, film): &(usize, &mut f64)| **film >= self.film * self.area;
        let deep = wetness.film.iter_mut().enumerate().filter(is_deep);
        deep.map(|(cell, film)| Drop { corner: self.corner(cell), size: self.size(), volume: std::mem::take(film) })
            .collect()
    }
}

impl Wetness {
    /// Water that stands on the ground as a film, m3.
    pub fn on_the_ground(&self) -> f64 {
        self.film.iter().copied().collect::<ExactSum>().value()
    }
}

/// Mean of a raster of factors over a cell, from places evenly over it; 0 where there is no data.
///
/// # Errors
/// A place where it is negative.
fn mean_factor(raster: &RasterField, centre: [f64; 2], size: [f64; 2]) -> Result<f64, [f64; 2]> {
    let mut sum = 0.0;
    for look in 0..LOOKS * LOOKS {
        let part = |look: usize| (look as f64 + 0.5) / LOOKS as f64 - 0.5;
        let place = [centre[0] + part(look % LOOKS) * size[0], centre[1] + part(look / LOOKS) * size[1]];
        let factor = raster.nearest(place[0], place[1]).unwrap_or(0.0);
        if factor < 0.0 {
            return Err(place);
        }
        sum += factor;
    }
    Ok(sum / (LOOKS * LOOKS) as f64)
}

/// Places along each side at which a cell looks at the raster of rain.
const LOOKS: usize = 5;

/// Depth at which a film becomes a particle where the scene has no rain of its own to say so, m.
const FILM: f64 = 1e-3;

/// Whether a particle is water that rain falls on: inside, not taken out, and its depth found.
fn is_water(particle: &Particle) -> bool {
    particle.outside.is_none() && particle.volume > 0.0 && particle.depth > 0.0
}

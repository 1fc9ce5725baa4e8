//! Rain onto the cells, and what soaks into the ground under them.

pub(super) mod infiltration;

use self::infiltration::{Law, MM_PER_H, of_class};
use super::domain::Domain;
use super::mesh::Mesh;
use super::patch::{Change, Changed};
use super::solver::Solver;
use super::water::Column;
use crate::error::setup;
use crate::series::load;
use corpuscle_model::{ExactSum, Map, ModelError};
use corpuscle_scene::{Flood, Table};
use corpuscle_terrain::{RasterField, Terrain};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Steps between two evaluations of infiltration: its laws hold for any step of time.
pub(crate) const STEPS_A_DRAUGHT: u64 = 8;

/// Where and when it rains: intensity, m/s, over x, y, and time.
pub type RainFunction = Box<dyn Fn(f64, f64, f64) -> f64 + Send + Sync>;

/// How hard it rains.
pub(crate) enum Intensity {
    None,
    /// mm/h over time.
    Table(Table),
    Function(RainFunction),
}

/// What rain and ground did in a step.
pub(crate) struct Exchanged {
    pub change: Changed,
    /// Rain on the cells of this process, m3.
    pub rained: ExactSum,
    /// What soaked in there, m3.
    pub infiltrated: ExactSum,
}

/// Rain and soils of a scene.
pub(crate) struct Weather {
    pub(super) intensity: Intensity,
    /// The raster by which the intensity is multiplied, with its path.
    factor: Option<(PathBuf, RasterField)>,
    classes: Option<RasterField>,
    codes: Vec<f64>,
    pub(super) laws: Vec<Option<Law>>,
    /// By what the intensity is multiplied in each cell; empty where it is the same everywhere.
    pub(super) factors: Vec<f32>,
    /// Area of roofs whose rain runs into each cell, m2; empty where there are none.
    pub roofs: Vec<f64>,
    /// How water soaks into each cell, by number in `laws`.
    pub(super) law: Vec<u16>,
}

/// What rain and ground have done.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct Soaked {
    /// What has soaked into each cell, m.
    pub depth: Vec<f32>,
    /// Until when the ground has drunk, s.
    pub until: f64,
    /// All the rain so far, m3.
    pub rained: ExactSum,
    /// All that has soaked in so far, m3.
    pub infiltrated: ExactSum,
}

impl Weather {
    /// Rain and soils of a scene; none where it neither rains nor soaks in.
    pub fn open(scene: &Flood, terrain: &Terrain, folder: &Path) -> Result<Option<Self>, ModelError> {
        let by_class = scene.land_use.iter().flat_map(|land_use| &land_use.class);
        let soaks = scene.infiltration.is_some() || by_class.clone().any(|class| class.infiltration.is_some());
        if scene.rain.is_none() && !soaks {
            return Ok(None);
        }
        let open = |path: &Path| RasterField::open(folder.join(path), terrain).map_err(setup);
        let mut weather = Self::without_rain();
        if let Some(rain) = &scene.rain {
            let intensity = load(&rain.intensity_mm_per_h, folder)?;
            if let Some(row) = intensity.rows().iter().find(|row| row[1] < 0.0) {
                return Err(setup(format!(
                    "flood.rain.intensity_mm_per_h is {} mm/h at {} s: rain must not be negative",
                    row[1], row[0]
                )));
            }
            weather.intensity = Intensity::Table(intensity);
            let factor = rain.raster.as_deref().map(|path| Ok((path.to_owned(), open(path)?)));
            weather.factor = factor.transpose()?;
        }
        let rest = scene.infiltration.as_ref().map(Law::of);
        weather.laws = std::iter::once(rest).chain(by_class.clone().map(|class| of_class(class, rest))).collect();
        weather.codes = by_class.map(|class| class.code as f64).collect();
        weather.classes = scene.land_use.as_ref().map(|land_use| open(&land_use.raster)).transpose()?;
        Ok(Some(weather))
    }

    /// Ground without rain, into which nothing soaks.
    pub fn without_rain() -> Self {
        Self {
            intensity: Intensity::None,
            factor: None,
            classes: None,
            codes: Vec::new(),
            laws: vec![None],
            factors: Vec::new(),
            roofs: Vec::new(),
            law: Vec::new(),
        }
    }

    /// Ground on which it rains as a function says.
    pub fn under(rain: RainFunction) -> Self {
        Self { intensity: Intensity::Function(rain), ..Self::without_rain() }
    }

    /// Whether rain can fall anywhere, at some time.
    pub fn rains(&self) -> bool {
        match &self.intensity {
            Intensity::None => false,
            Intensity::Table(table) => table.rows().iter().any(|row| row[1] > 0.0),
            Intensity::Function(_) => true,
        }
    }

    /// The intensity over time, mm/h, to be changed; what is not a table becomes one of 0.
    pub fn table(&mut self) -> Result<&mut Table, ModelError> {
        if let Intensity::None = self.intensity {
            let none = corpuscle_scene::Series::Constant(0.0);
            self.intensity = Intensity::Table(load(&none, Path::new(""))?);
        }
        match &mut self.intensity {
            Intensity::Table(table) => Ok(table),
            Intensity::None | Intensity::Function(_) => Err(setup("rain by a function cannot be changed")),
        }
    }

    /// Sets rain and soils of cells that were added.
    ///
    /// # Errors
    /// Where the raster of factors is negative.
    pub fn extend(&mut self, mesh: &Mesh, terrain: &Terrain, soaked: &mut Soaked) -> Result<(), ModelError> {
        if let Some((path, raster)) = &self.factor {
            for [x, y] in &mesh.centroid[self.factors.len()..] {
                let factor = raster.bilinear(*x, *y).unwrap_or(0.0);
                if factor < 0.0 {
                    let position = terrain.to_own([*x, *y]);
                    let path = path.display();
                    return Err(setup(format!("{path}: the factor of rain at {position:?} must not be negative")));
                }
                self.factors.push(factor as f32);
            }
        }
        if self.soaks() {
            for [x, y] in &mesh.centroid[self.law.len()..] {
                let code = self.classes.as_ref().and_then(|classes| classes.nearest(*x, *y));
                let class = self.codes.iter().position(|class| code == Some(*class));
                self.law.push(class.map_or(0, |class| class as u16 + 1));
            }
            soaked.depth.resize(mesh.len(), 0.0);
        }
        Ok(())
    }

    /// Clears the values cached for each cell.
    pub fn forget_cells(&mut self) {
        self.factors.clear();
        self.law.clear();
        self.roofs.clear();
    }

    /// What has soaked in at each cell of the terrain's grid, 0 where no water has come near; none where nothing soaks in,
    /// and at all processes but the first.
    pub fn map(&self, mesh: &Mesh, terrain: &Terrain, soaked: &Soaked, domain: Option<&Domain>) -> Option<Map> {
        self.soaks().then_some(())?;
        let grid = terrain.map_grid();
        let (columns, rows) = (grid.columns, grid.rows);
        let pixel = |column: usize, row: usize| {
            let owns = |cell: &usize| domain.is_none_or(|domain| domain.owns(*cell));
            let cell = mesh.cell_at(grid.centre(column, row)).filter(owns)?;
            let depth = *soaked.depth.get(cell)?;
            (depth != 0.0).then_some((row * columns + column, depth))
        };
        let of_row = |row: usize| (0..columns).filter_map(|column| pixel(column, row)).collect::<Vec<_>>();
        let pixels = Domain::gathered(domain, (0..rows).into_par_iter().flat_map_iter(of_row).collect())?;
        let mut values = vec![0.0; columns * rows];
        pixels.into_iter().for_each(|(pixel, depth)| values[pixel] = depth);
        for (pixel, value) in values.iter_mut().enumerate() {
            if !terrain.is_valid_cell(pixel % columns, pixel / columns) {
                *value = f32::NAN;
            }
        }
        let (name, title) = ("infiltration", "Infiltration");
        Some(Map { name, title, unit: "m", columns, rows, values })
    }

    pub fn soaks(&self) -> bool {
        self.laws.iter().any(Option::is_some)
    }

    /// Lets it rain from `from` to `until` s, which ends step number `steps`, and the ground drink; what that changed of the water on the ground.
    pub fn pass(&self, solver: &mut Solver, soaked: &mut Soaked, from: f64, until: f64, steps: u64) -> Exchanged {
        let mut change = Change::default();
        let rained = self.rain(solver, from, until, &mut change);
        let mut infiltrated = ExactSum::default();
        if self.soaks() && steps.is_multiple_of(STEPS_A_DRAUGHT) {
            infiltrated = self.drink(solver, soaked, until - soaked.until, &mut change);
            soaked.until = until;
        }
        soaked.rained.add_sum(&rained);
        soaked.infiltrated.add_sum(&infiltrated);
        Exchanged { change: change.in_all(solver.domain.as_ref()), rained, infiltrated }
    }

    /// Lets it rain; the volume, m3.
    fn rain(&self, solver: &mut Solver, from: f64, until: f64, change: &mut Change) -> ExactSum {
        let mut fallen = ExactSum::default();
        let even = match &self.intensity {
            Intensity::None => return fallen,
            Intensity::Table(table) => MM_PER_H * table.integral(from, until),
            Intensity::Function(_) => 1.0,
        };
        if even == 0.0 {
            return fallen;
        }
        for cell in 0..solver.mesh.len() {
            if !solver.owns(cell) {
                continue;
            }
            let factor = self.factors.get(cell).map_or(1.0, |factor| f64::from(*factor));
            let depth = match &self.intensity {
                Intensity::Function(rain) => {
                    let [x, y] = solver.mesh.centroid[cell];
                    (until - from) * rain(x, y, 0.5 * (from + until))
                }
                _ => even * factor,
            };
            if depth > 0.0 {
                let volume = depth * (solver.mesh.area[cell] + self.roofs.get(cell).copied().unwrap_or(0.0));
                fallen.add(volume);
                change.apply(solver, cell, Column { volume, momentum: [0.0; 2] });
            }
        }
        fallen
    }

    /// Lets the ground drink; the volume, m3.
    fn drink(&self, solver: &mut Solver, soaked: &mut Soaked, step: f64, change: &mut Change) -> ExactSum {
        let mut gone = ExactSum::default();
        for cell in 0..solver.mesh.len() {
            let Column { volume, momentum } = solver.columns[cell];
            let takes = volume > 0.0 && solver.owns(cell);
            let Some(law) = self.laws[usize::from(self.law[cell])].filter(|_| takes) else { continue };
            let area = solver.mesh.area[cell];
            let demand = area * law.demand(f64::from(soaked.depth[cell]), step);
            let share = (demand / volume).min(1.0);
            soaked.depth[cell] += (share * volume / area) as f32;
            gone.add(share * volume);
            let taken = Column { volume: -share * volume, momentum: momentum.map(|momentum| -share * momentum) };
            change.apply(solver, cell, taken);
        }
        gone
    }
}

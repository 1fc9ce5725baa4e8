//! What comes into cells and goes out of them beside the motion of the water, as it is uploaded.

use super::shared::{NONE, Supply, TABLE};
use super::upload::{Input, pair};
use crate::infiltration::{Law, MM_PER_H};
use crate::rain::Intensity;
use crate::voronoi::rain::Weather;
use corpuscle_scene::Table;

/// Supplies of cells, and the words of tables, sources and laws.
pub(super) struct Supplies {
    pub of_cells: Vec<Supply>,
    pub tables: Vec<u32>,
    /// Number of tables.
    pub count: u32,
    /// The table of the depth of rain; [`NONE`] where there is none.
    pub rain_table: u32,
}

/// The supplies of a flood: none of any cell where nothing comes or goes.
pub(super) fn supplies(input: &Input<'_>) -> Supplies {
    let mut all = Supplies { of_cells: Vec::new(), tables: Vec::new(), count: 0, rain_table: NONE };
    if !input.exchanges() {
        return all;
    }
    let rain = input.weather.and_then(|weather| match &weather.intensity {
        Intensity::Table(table) => Some(table),
        Intensity::None | Intensity::Function(_) => None,
    });
    let inflows = input.inflows.iter().map(|inflow| (&inflow.discharge, 1.0));
    let tables: Vec<_> = inflows.chain(rain.map(|table| (table, MM_PER_H))).collect();
    all.count = tables.len() as u32;
    all.tables = vec![0; TABLE as usize * tables.len()];
    if rain.is_some() {
        all.rain_table = all.count - 1;
    }
    for (number, (table, unit)) in tables.into_iter().enumerate() {
        all.add_table(number, table, unit);
    }
    let first_law = all.tables.len() as u32;
    let laws = input.weather.iter().flat_map(|weather| &weather.laws);
    let numbers = laws.flat_map(|law| law.map_or([0.0; 4], Law::numbers));
    all.tables.extend(numbers.map(f32::to_bits));
    let sources = sources(input);
    all.of_cells = (0..input.cells()).map(|cell| all.of_cell(input, first_law, cell, &sources[cell])).collect();
    all
}

/// The sources of each cell: table, share, and velocity.
fn sources(input: &Input<'_>) -> Vec<Vec<[u32; 4]>> {
    let mut sources = vec![Vec::new(); input.cells()];
    for (number, inflow) in input.inflows.iter().enumerate() {
        let [u, v] = inflow.velocity.map(|component| (component as f32).to_bits());
        for &cell in &inflow.patch.cells {
            let share = input.solver.mesh.area[cell as usize] / inflow.patch.area;
            sources[cell as usize].push([number as u32, (share as f32).to_bits(), u, v]);
        }
    }
    sources
}

impl Supplies {
    fn add_table(&mut self, number: usize, table: &Table, unit: f64) {
        let header = TABLE as usize * number;
        self.tables[header] = self.tables.len() as u32;
        self.tables[header + 1] = table.rows().len() as u32;
        for [time, value] in table.rows() {
            let [high, low] = pair(*time);
            self.tables.extend([high, low, (unit * value) as f32].map(f32::to_bits));
        }
    }

    fn of_cell(&mut self, input: &Input<'_>, first_law: u32, cell: usize, sources: &[[u32; 4]]) -> Supply {
        let first_source = self.tables.len() as u32;
        self.tables.extend(sources.iter().flatten());
        let law = input.weather.and_then(|weather| law_of(weather, cell));
        Supply {
            soaked: input.soaked.depth.get(cell).copied().unwrap_or(0.0),
            rain_area: input.weather.map_or(0.0, |weather| rain_area(input, weather, cell)) as f32,
            law: law.map_or(NONE, |law| first_law + 4 * law),
            first_source,
            end_source: self.tables.len() as u32,
            unused: 0,
        }
    }
}

/// The number of the law by which water soaks into a cell.
fn law_of(weather: &Weather, cell: usize) -> Option<u32> {
    let law = weather.law.get(cell)?;
    weather.laws[usize::from(*law)].map(|_| u32::from(*law))
}

/// Area that rain runs into a cell from, times its factor, m2.
fn rain_area(input: &Input<'_>, weather: &Weather, cell: usize) -> f64 {
    let factor = weather.factors.get(cell).map_or(1.0, |factor| f64::from(*factor));
    factor * (input.solver.mesh.area[cell] + weather.roofs.get(cell).copied().unwrap_or(0.0))
}

//! Upload of rain, infiltration and inflows of cells.

use super::super::rain::infiltration::{Law, MM_PER_H};
use super::shared::{NONE, Supply};
use super::tables::Tables;
use super::upload::Input;
use crate::voronoi::rain::Intensity;
use crate::voronoi::rain::Weather;

/// The tables of inflows and rain, by number.
pub(super) struct SupplyTables {
    /// The table of each inflow.
    inflows: Vec<u32>,
    /// The table of the depth of rain; [`NONE`] where there is none.
    pub rain: u32,
}

/// The tables of a flood's inflows and rain.
pub(super) fn supply_tables(input: &Input<'_>, tables: &mut Tables) -> SupplyTables {
    let inflows = input.inflows.iter().map(|inflow| tables.add(inflow.discharge.rows().iter().copied())).collect();
    let rain = input.weather.map_or(NONE, |weather| match &weather.intensity {
        Intensity::Table(table) => tables.add(table.rows().iter().map(|[time, value]| [*time, MM_PER_H * value])),
        Intensity::None | Intensity::Function(_) => NONE,
    });
    SupplyTables { inflows, rain }
}

/// The supplies of a flood: empty where there is no rain, infiltration or inflow. Sources and laws are added to `words`, after the tables.
pub(super) fn supplies(input: &Input<'_>, tables: &SupplyTables, words: &mut Vec<u32>) -> Vec<Supply> {
    if !input.exchanges() {
        return Vec::new();
    }
    let first_law = words.len() as u32;
    let laws = input.weather.iter().flat_map(|weather| &weather.laws);
    let numbers = laws.flat_map(|law| law.map_or([0.0; 4], Law::numbers));
    words.extend(numbers.map(f32::to_bits));
    let sources = sources(input, tables);
    (0..input.cells()).map(|cell| of_cell(input, first_law, cell, &sources[cell], words)).collect()
}

/// The sources of each cell: table, share, and velocity.
fn sources(input: &Input<'_>, tables: &SupplyTables) -> Vec<Vec<[u32; 4]>> {
    let mut sources = vec![Vec::new(); input.cells()];
    for (inflow, table) in input.inflows.iter().zip(&tables.inflows) {
        let [u, v] = inflow.velocity.map(|component| (component as f32).to_bits());
        for &cell in &inflow.patch.cells {
            let share = input.solver.mesh.area[cell as usize] / inflow.patch.area;
            sources[cell as usize].push([*table, (share as f32).to_bits(), u, v]);
        }
    }
    sources
}

fn of_cell(input: &Input<'_>, first_law: u32, cell: usize, sources: &[[u32; 4]], words: &mut Vec<u32>) -> Supply {
    let first_source = words.len() as u32;
    words.extend(sources.iter().flatten());
    let law = input.weather.and_then(|weather| law_of(weather, cell));
    Supply {
        soaked: input.soaked.depth.get(cell).copied().unwrap_or(0.0),
        rain_area: input.weather.map_or(0.0, |weather| rain_area(input, weather, cell)) as f32,
        law: law.map_or(NONE, |law| first_law + 4 * law),
        first_source,
        end_source: words.len() as u32,
        unused: 0,
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

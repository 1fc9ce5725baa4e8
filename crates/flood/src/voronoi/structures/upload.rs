//! Structures as a GPU has them.

use super::super::gpu::{CULVERT, HOLD, InPatch, LINK, NONE, OUTFLOW, RATING, Structure, Tables, WEIR};
use super::super::mesh::Mesh;
use super::super::patch::Patch;
use super::Patches;
use super::hydraulics::Law;
use super::{Flows, Structures};
use corpuscle_scene::Table;

/// What is uploaded of structures.
#[derive(Default)]
pub(in crate::voronoi) struct Uploaded {
    /// Outflows, held levels, links, each in their order.
    pub structures: Vec<Structure>,
    pub in_patches: Vec<InPatch>,
    /// Numbers of the laws of links, and which structure has them.
    numbers: Vec<(usize, Vec<f32>)>,
}

/// The level from which the levels of a structure count: the bed at its first cell, m.
fn datum(patch: &Patch, mesh: &Mesh) -> f64 {
    patch.cells.first().map_or(0.0, |cell| mesh.bed[*cell as usize])
}

/// A table over the level, its levels counted from a datum.
fn over_level(table: &Table, datum: f64) -> impl Iterator<Item = [f64; 2]> + '_ {
    table.rows().iter().map(move |[level, value]| [level - datum, *value])
}

impl Patches {
    /// What a GPU needs of structures.
    pub fn upload(&self, structures: &Structures, mesh: &Mesh, tables: &mut Tables) -> Uploaded {
        let mut uploaded = Uploaded::default();
        for (outflow, patch) in structures.outflows.iter().zip(&self.outflows) {
            let datum = datum(patch, mesh);
            let table = tables.add(over_level(&outflow.rating, datum));
            let own = Structure { kind: OUTFLOW, table, ..uploaded.over([patch, &Patch::default()], datum, mesh) };
            uploaded.structures.push(own);
        }
        for (held, patch) in structures.held.iter().zip(&self.held) {
            let datum = datum(patch, mesh);
            let table = tables.add(held.level.rows().iter().map(|[time, level]| [*time, level - datum]));
            let own = Structure { kind: HOLD, table, ..uploaded.over([patch, &Patch::default()], datum, mesh) };
            uploaded.structures.push(own);
        }
        for (link, [first, second]) in structures.links.iter().zip(&self.links) {
            let datum = datum(first, mesh);
            let own = uploaded.over([first, second], datum, mesh);
            let (law, table, numbers) = match &link.law {
                Law::Culvert(culvert) => (CULVERT, NONE, culvert.numbers(datum).to_vec()),
                Law::Weir(weir) => (WEIR, NONE, vec![weir.crest_m - datum, weir.width_m, weir.coefficient]),
                Law::Rating(rating) => (RATING, tables.add(rating.rows().iter().copied()), Vec::new()),
            };
            let numbers = numbers.into_iter().map(|number| number as f32).collect();
            uploaded.numbers.push((uploaded.structures.len(), numbers));
            let both_ways = u32::from(link.both_ways);
            uploaded.structures.push(Structure { kind: LINK, table, law, both_ways, ..own });
        }
        uploaded
    }
}

impl Uploaded {
    /// A structure over two patches, whose cells are added.
    fn over(&mut self, patches: [&Patch; 2], datum: f64, mesh: &Mesh) -> Structure {
        let mut structure = Structure { areas: patches.map(|patch| patch.area as f32), ..Structure::default() };
        for (k, patch) in patches.into_iter().enumerate() {
            structure.firsts[k] = self.in_patches.len() as u32;
            self.in_patches.extend(patch.cells.iter().map(|&cell| InPatch {
                cell,
                above: (mesh.bed[cell as usize] - datum) as f32,
                area: mesh.area[cell as usize] as f32,
                bed: mesh.bed[cell as usize] as f32,
            }));
            structure.ends[k] = self.in_patches.len() as u32;
        }
        structure
    }

    /// Adds the numbers of laws to `words`, after the tables.
    pub fn add_numbers(&mut self, words: &mut Vec<u32>) {
        for (structure, numbers) in std::mem::take(&mut self.numbers) {
            self.structures[structure].numbers = words.len() as u32;
            words.extend(numbers.into_iter().map(f32::to_bits));
        }
    }
}

/// Sets the flows from a GPU's discharges of structures, which are in the order of [`Uploaded::structures`].
pub(in crate::voronoi) fn set_flows(discharges: &[f32], structures: &Structures, flows: &mut Flows) {
    let held = structures.outflows.len()..structures.outflows.len() + structures.held.len();
    let of_flows = discharges.iter().enumerate().filter(|(k, _)| !held.contains(k));
    for (flow, (_, discharge)) in flows.outflows.iter_mut().chain(&mut flows.links).zip(of_flows) {
        *flow = f64::from(*discharge);
    }
}

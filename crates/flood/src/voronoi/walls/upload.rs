//! Crests as a GPU has them.

use super::OverCrest;
use crate::voronoi::gpu::{BesideCrest, Crest};
use crate::voronoi::mesh::Mesh;
use std::collections::BTreeMap;

/// What is uploaded of crests.
pub(in crate::voronoi) struct Uploaded {
    pub crests: Vec<Crest>,
    pub beside: Vec<BesideCrest>,
    /// See `crest_entries` of the memory.
    pub entries: Vec<u32>,
}

/// What a GPU needs of crests.
pub(in crate::voronoi) fn upload(crests: &[OverCrest], mesh: &Mesh) -> Uploaded {
    let mut of_cells: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (number, crest) in crests.iter().enumerate() {
        for (side, cell) in crest.cells.into_iter().enumerate() {
            of_cells.entry(cell).or_default().push(2 * number as u32 + side as u32);
        }
    }
    let mut uploaded = Uploaded { crests: Vec::new(), beside: Vec::new(), entries: Vec::new() };
    for (cell, entries) in of_cells {
        let first = uploaded.entries.len() as u32;
        uploaded.entries.extend(entries);
        uploaded.beside.push(BesideCrest { cell, first, end: uploaded.entries.len() as u32 });
    }
    uploaded.crests = crests.iter().map(|crest| of(crest, mesh)).collect();
    uploaded
}

fn of(crest: &OverCrest, mesh: &Mesh) -> Crest {
    let [first, second] = crest.cells.map(|cell| mesh.bed[cell as usize]);
    Crest {
        cells: crest.cells,
        parts: crest.parts.map(|part| part as f32),
        above: (crest.level - first) as f32,
        rise: (second - first) as f32,
        length: crest.length as f32,
        ..Crest::default()
    }
}

//! Keeping what is to come, and taking it back.

use super::Engine;
use super::event::{Event, What};
use serde::{Deserialize, Serialize};

/// What is to come, and where it was found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Saved {
    time: Vec<f64>,
    what: Vec<u32>,
    partner_bends: Vec<u32>,
    bends: Vec<u32>,
    cell: Vec<u16>,
    level: Vec<u8>,
    watches: Vec<f64>,
    slid_cells: i64,
    handled: u64,
    crossings: u64,
    disturbed: u64,
}

impl<const D: usize> Engine<D> {
    /// What is to come, to the bit.
    pub fn save(&self) -> Saved {
        let events = &self.events;
        Saved {
            time: events.iter().map(|event| event.time).collect(),
            what: events.iter().map(|event| event.what.0).collect(),
            partner_bends: events.iter().map(|event| event.partner_bends).collect(),
            bends: events.iter().map(|event| event.bends).collect(),
            cell: events.iter().flat_map(|event| event.cell).collect(),
            level: events.iter().map(|event| event.level).collect(),
            watches: self.watches.clone(),
            slid_cells: self.slid_cells,
            handled: self.handled,
            crossings: self.crossings,
            disturbed: self.disturbed,
        }
    }

    /// Takes back what is to come, for a world that was taken back before; `None` where it does not fit.
    pub fn restore(&mut self, saved: &Saved) -> Option<()> {
        let count = self.world.balls.len();
        let lengths =
            [saved.time.len(), saved.what.len(), saved.partner_bends.len(), saved.bends.len(), saved.level.len()];
        if lengths.iter().any(|&len| len != count)
            || saved.cell.len() != count * D
            || saved.watches.len() != self.world.walls.len()
        {
            return None;
        }
        self.grid = self.fitting_grid()?;
        self.events.clear();
        for ball in 0..count {
            let level = saved.level[ball];
            let counts = self.grid.levels.get(level as usize)?.count;
            let cell: [u16; D] = std::array::from_fn(|axis| saved.cell[ball * D + axis]);
            let what = What(saved.what[ball]);
            let partner_fits = what.ball().is_none_or(|partner| partner < count);
            let wall_fits = what.as_wall().is_none_or(|wall| wall < self.world.walls.len());
            let cell_fits = cell.iter().zip(counts).all(|(&cell, count)| (1..=count).contains(&cell));
            if !(partner_fits && wall_fits && cell_fits) || saved.time[ball].is_nan() {
                return None;
            }
            let (partner_bends, bends) = (saved.partner_bends[ball], saved.bends[ball]);
            self.events.push(Event { time: saved.time[ball], what, partner_bends, bends, stamp: 0, cell, level });
            self.enter_cell(ball);
        }
        self.watches.clone_from(&saved.watches);
        self.next_watch = saved.watches.iter().copied().fold(f64::INFINITY, f64::min);
        if self.world.field.is_sheared() {
            self.slid_cells = saved.slid_cells;
            self.next_watch = self.next_slide();
            // What it has slid by then is done: each cell of it would be made up for.
            if self.next_watch.is_nan() || self.next_watch < self.world.now {
                return None;
            }
        }
        (self.handled, self.crossings, self.disturbed) = (saved.handled, saved.crossings, saved.disturbed);
        self.fill_queue();
        Some(())
    }
}

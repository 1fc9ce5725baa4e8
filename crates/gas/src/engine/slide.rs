//! Cells across the faces along which the images of a sheared box slide.
//!
//! Of the row across such a face four cells along x can hold balls near a ball, while the image slides from one whole number of cells to the
//! next. Then these are another four, and the balls of both rows at the face search again.

use super::Engine;
use super::near::ROOM;
use super::predict::Next;
use crate::world::{Mode, NONE};

impl<const D: usize> Engine<D> {
    /// Counts by how many cells the image above has slid at the beginning of the window.
    pub(super) fn begin_slide(&mut self) {
        let side = self.grid.levels[0].size[0];
        self.slid_cells = (self.world.field.slid_at(0.0) / side).floor() as i64;
        self.next_watch = self.next_slide();
    }

    /// When the image above will have slid by one more cell.
    pub(super) fn next_slide(&self) -> f64 {
        let slide = self.world.field.slide;
        ((self.slid_cells + 1) as f64 * self.grid.levels[0].size[0] - slide.displacement) / slide.speed
    }

    /// The image above has slid by one more cell: balls at the faces search again.
    pub(super) fn slide_on<M: Mode>(&mut self) {
        self.world.now = self.next_watch;
        self.slid_cells += 1;
        self.next_watch = self.next_slide();
        let last = self.grid.levels[0].count[1];
        for ball in 0..self.events.len() {
            let row = self.events[ball].cell[1];
            if row == 1 || row == last {
                self.predict::<M>(ball);
            }
        }
    }

    /// As [`Engine::neighbours`], for a ball at a face of a sheared box.
    #[inline(never)]
    pub(super) fn neighbours_in_shear<M: Mode>(&mut self, ball: usize, next: &mut Next) {
        let mut found = [0_u32; ROOM];
        let mut offsets = [[0.0; D]; ROOM];
        let mut count = 0;
        let event = &self.events[ball];
        let (level, period) = (&self.grid.levels[event.level as usize], &self.world.field.period);
        let cell: [i64; D] = event.cell.map(i64::from);
        let cells: [i64; D] = level.count.map(i64::from);
        let wrapped = |axis: usize, at: i64| {
            let images = (at - 1).div_euclid(cells[axis]);
            ((at - images * cells[axis]) as usize, images as f64 * period[axis])
        };
        for row in cell[1] - 1..=cell[1] + 1 {
            let (y, above) = wrapped(1, row);
            let columns = match above.partial_cmp(&0.0) {
                Some(std::cmp::Ordering::Greater) => cell[0] - 2 - self.slid_cells..=cell[0] + 1 - self.slid_cells,
                Some(std::cmp::Ordering::Less) => cell[0] - 1 + self.slid_cells..=cell[0] + 2 + self.slid_cells,
                _ => cell[0] - 1..=cell[0] + 1,
            };
            for column in columns {
                let (x, along) = wrapped(0, column);
                let across = if D == 3 { cell[D - 1] - 1..=cell[D - 1] + 1 } else { 0..=0 };
                for layer in across {
                    let (mut number, mut offset) = (level.table[0][x] + level.table[1][y], [0.0; D]);
                    (offset[0], offset[1]) = (along, above);
                    if D == 3 {
                        let (z, beside) = wrapped(D - 1, layer);
                        number += level.table[D - 1][z];
                        offset[D - 1] = beside;
                    }
                    (found[count], offsets[count]) = (self.grid.heads[number as usize], offset);
                    count += usize::from(found[count] != NONE);
                }
            }
        }
        self.chains::<M, true>(ball, &mut found, &mut offsets, count, next);
    }
}

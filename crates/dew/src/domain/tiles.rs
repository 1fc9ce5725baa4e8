//! Tiles that the room is divided into, and the process of each.

use crate::room::Room;

/// Tiles at most: their number does not grow with the room beyond this.
const MOST_TILES: usize = 1 << 20;

/// Equal boxes that the room is divided into, no side shorter than the reach of the air unless the room itself is. The outermost have all that is beyond, too.
#[derive(Debug, Clone)]
pub(crate) struct Tiles {
    low: [f64; 3],
    sides: [f64; 3],
    /// Number along each axis.
    pub counts: [usize; 3],
}

impl Tiles {
    /// The tiles of a room of air with such a reach, m.
    pub fn new(room: &Room, reach: f64) -> Self {
        let size = room.size();
        let counts_of = |side: f64| size.map(|size| ((size / side) as usize).max(1));
        let mut side = reach;
        while counts_of(side).iter().product::<usize>() > MOST_TILES {
            side *= 1.25;
        }
        let counts = counts_of(side);
        Self { low: room.low, sides: [0, 1, 2].map(|axis| size[axis] / counts[axis] as f64), counts }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.counts.iter().product()
    }

    /// Number along an axis of the tiles that hold a coordinate, m.
    fn along(&self, axis: usize, at: f64) -> usize {
        // A negative number becomes 0.
        (((at - self.low[axis]) / self.sides[axis]) as usize).min(self.counts[axis] - 1)
    }

    fn number(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }

    /// Numbers of a tile along the axes.
    fn index(&self, tile: usize) -> [usize; 3] {
        let [columns, rows, _] = self.counts;
        [tile % columns, tile / columns % rows, tile / (columns * rows)]
    }

    /// The tile that holds a position.
    pub fn of(&self, position: [f64; 3]) -> usize {
        self.number([0, 1, 2].map(|axis| self.along(axis, position[axis])))
    }

    /// The tiles within a distance of a position along each axis, m.
    pub fn near(&self, position: [f64; 3], distance: f64) -> impl Iterator<Item = usize> {
        let first = [0, 1, 2].map(|axis| self.along(axis, position[axis] - distance));
        let last = [0, 1, 2].map(|axis| self.along(axis, position[axis] + distance));
        let rows = (first[2]..=last[2]).flat_map(move |z| (first[1]..=last[1]).map(move |y| [y, z]));
        rows.flat_map(move |[y, z]| (first[0]..=last[0]).map(move |x| self.number([x, y, z])))
    }

    /// A tile and those round it, beyond the sides of the room those at the opposite side.
    pub fn round(&self, tile: usize) -> impl Iterator<Item = usize> {
        let index = self.index(tile);
        (0..27).map(move |way| {
            let away = [way % 3, way / 3 % 3, way / 9];
            self.number([0, 1, 2].map(|axis| (index[axis] + self.counts[axis] + away[axis] - 1) % self.counts[axis]))
        })
    }

    /// The corners of the box of some tiles, m, without bounds where it ends with the room.
    pub fn bounds(&self, tiles: impl Iterator<Item = usize>) -> Option<[[f64; 3]; 2]> {
        let range = tiles.map(|tile| [self.index(tile); 2]).reduce(|[low, high], [index, _]| {
            [[0, 1, 2].map(|axis| low[axis].min(index[axis])), [0, 1, 2].map(|axis| high[axis].max(index[axis]))]
        });
        let [first, last] = range?;
        let corner = |axis: usize, number: usize| self.low[axis] + number as f64 * self.sides[axis];
        let low = [0, 1, 2].map(|axis| if first[axis] == 0 { f64::NEG_INFINITY } else { corner(axis, first[axis]) });
        let is_last = |axis: usize| last[axis] + 1 == self.counts[axis];
        let high = [0, 1, 2].map(|axis| if is_last(axis) { f64::INFINITY } else { corner(axis, last[axis] + 1) });
        Some([low, high])
    }
}

/// The process of each tile, by recursive bisection (Berger & Bokhari 1987, "A partitioning strategy for nonuniform problems on multiprocessors"): a
/// box of tiles for several processes is cut across its longest side so that each part has as much of the work as of the processes.
pub(super) fn owners(counts: [usize; 3], work: &[f64], processes: usize) -> Vec<u16> {
    let mut owners = vec![0; work.len()];
    let mut boxes = vec![([[0; 3], counts], 0..processes)];
    while let Some(([from, to], range)) = boxes.pop() {
        let sides = [0, 1, 2].map(|axis| to[axis] - from[axis]);
        let axis = (0..3).max_by_key(|axis| (sides[*axis], 2 - axis)).unwrap_or(0);
        let number = |index: [usize; 3]| (index[2] * counts[1] + index[1]) * counts[0] + index[0];
        let tiles = |from: [usize; 3], to: [usize; 3]| {
            let rows = (from[2]..to[2]).flat_map(move |z| (from[1]..to[1]).map(move |y| [y, z]));
            rows.flat_map(move |[y, z]| (from[0]..to[0]).map(move |x| number([x, y, z])))
        };
        if range.len() == 1 || sides[axis] < 2 {
            tiles(from, to).for_each(|tile| owners[tile] = range.start as u16);
            continue;
        }
        let slab = |at: usize| {
            let (mut low, mut high) = (from, to);
            (low[axis], high[axis]) = (at, at + 1);
            tiles(low, high).map(|tile| work[tile]).sum::<f64>()
        };
        let slabs: Vec<f64> = (from[axis]..to[axis]).map(slab).collect();
        let half = range.len() / 2;
        let cut = from[axis] + cut(&slabs, half as f64 / range.len() as f64);
        let (mut end, mut start) = (to, from);
        (end[axis], start[axis]) = (cut, cut);
        boxes.push(([from, end], range.start..range.start + half));
        boxes.push(([start, to], range.start + half..range.end));
    }
    owners
}

/// How many of some slabs make up a part of their work, at least one and not all; of their number where there is no work.
fn cut(slabs: &[f64], part: f64) -> usize {
    let total: f64 = slabs.iter().sum();
    let (slabs, total) =
        if total > 0.0 { (slabs.to_vec(), total) } else { (vec![1.0; slabs.len()], slabs.len() as f64) };
    let mut before = 0.0;
    let mut best = (f64::INFINITY, 1);
    for (number, slab) in slabs.iter().enumerate().take(slabs.len() - 1) {
        before += slab;
        let off = (before - part * total).abs();
        if off < best.0 {
            best = (off, number + 1);
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::room::Face;

    fn tiles() -> Tiles {
        let room = Room { low: [0.0; 3], high: [1.0, 0.7, 0.25], faces: [[Face::Wall; 2]; 3] };
        Tiles::new(&room, 0.1)
    }

    #[test]
    fn tiles_are_as_long_as_the_reach() {
        let tiles = tiles();
        assert!(tiles.counts == [10, 7, 2] || tiles.counts == [10, 6, 2], "{:?}", tiles.counts);
        assert!(tiles.sides.iter().all(|side| *side >= 0.1 * (1.0 - 1e-12)));
        // What lies beyond the room belongs to the outermost.
        assert_eq!(tiles.of([-5.0, 0.01, 9.0]), tiles.of([0.01, 0.01, 0.24]));
        // What is within reach of a position lies in its tile and those round it.
        for number in 0..1000 {
            let position = [1.0, 0.7, 0.25].map(|side| side * f64::from(number) * 0.618).map(f64::fract);
            let round: Vec<usize> = tiles.round(tiles.of(position)).collect();
            assert!(tiles.near(position, 0.1).all(|tile| round.contains(&tile)), "{position:?}");
        }
    }

    #[test]
    fn processes_have_as_much_work() {
        let counts = [12, 9, 7];
        let work: Vec<f64> = (0..counts.iter().product()).map(|tile: usize| ((tile * 7919) % 13) as f64).collect();
        let total: f64 = work.iter().sum();
        for processes in [1, 2, 3, 5, 8] {
            let owners = owners(counts, &work, processes);
            for process in 0..processes {
                let own: f64 = owners
                    .iter()
                    .zip(&work)
                    .filter(|(owner, _)| usize::from(**owner) == process)
                    .map(|(_, work)| work)
                    .sum();
                let share = own * processes as f64 / total;
                assert!((0.75..1.3).contains(&share), "{process} of {processes} has {share} of its share");
            }
        }
    }

    #[test]
    fn more_processes_than_tiles_leave_some_without() {
        let owners = owners([2, 1, 1], &[0.0; 2], 5);
        assert_eq!(owners.len(), 2);
        assert_ne!(owners[0], owners[1]);
    }
}

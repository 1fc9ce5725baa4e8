//! Convex polygons cut by half-planes: the cells.

/// What lies beyond an edge of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Beyond {
    /// The cell of a neighbouring point, by what the caller numbers it with.
    Cell(u64),
    /// A side of the terrain: 0 west, 1 east, 2 south, 3 north.
    Side(u8),
}

/// A convex polygon with corners in counter-clockwise order, relative to the point of its cell, m. Edge `k` goes from corner `k` to the next.
#[derive(Debug, Clone, Default)]
pub(crate) struct Polygon {
    /// Corners.
    pub corners: Vec<[f64; 2]>,
    /// What lies beyond each edge.
    pub beyond: Vec<Option<Beyond>>,
    spare: (Vec<[f64; 2]>, Vec<Option<Beyond>>),
    distances: Vec<f64>,
}

/// Area, centroid and perimeter of a polygon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Measures {
    /// Area, m2.
    pub area: f64,
    /// Centroid relative to the point of the cell, m.
    pub centroid: [f64; 2],
    /// Perimeter, m.
    pub perimeter: f64,
}

impl Polygon {
    /// Starts again from a square of side `2 half` round the point.
    pub fn reset(&mut self, half: f64) {
        self.corners.clear();
        self.corners.extend([[-half, -half], [half, -half], [half, half], [-half, half]]);
        self.beyond.clear();
        self.beyond.resize(4, None);
    }

    /// Keeps the part in which `normal . r <= offset`; the new edge has `beyond` behind it. Nothing changes where all of it is kept.
    pub fn cut(&mut self, normal: [f64; 2], offset: f64, beyond: Beyond) {
        self.distances.clear();
        self.distances.extend(self.corners.iter().map(|r| r[0] * normal[0] + r[1] * normal[1] - offset));
        if self.distances.iter().all(|distance| *distance <= 0.0) {
            return;
        }
        let (corners, edges) = &mut self.spare;
        corners.clear();
        edges.clear();
        let count = self.corners.len();
        for k in 0..count {
            let next = if k + 1 < count { k + 1 } else { 0 };
            let (here, there) = (self.distances[k], self.distances[next]);
            if here <= 0.0 {
                corners.push(self.corners[k]);
                edges.push(self.beyond[k]);
            }
            if (here <= 0.0) != (there <= 0.0) {
                let part = here / (here - there);
                let [from, to] = [self.corners[k], self.corners[next]];
                corners.push([0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis])));
                edges.push(if here <= 0.0 { Some(beyond) } else { self.beyond[k] });
            }
        }
        std::mem::swap(&mut self.corners, corners);
        std::mem::swap(&mut self.beyond, edges);
    }

    /// Square of the distance of its farthest corner from the point, m2.
    pub fn reach_squared(&self) -> f64 {
        self.corners.iter().map(|r| r[0] * r[0] + r[1] * r[1]).fold(0.0, f64::max)
    }

    /// The two corners of edge `k`.
    pub fn edge(&self, k: usize) -> [[f64; 2]; 2] {
        [self.corners[k], self.corners[(k + 1) % self.corners.len()]]
    }

    /// Area, centroid and perimeter.
    pub fn measures(&self) -> Measures {
        let (mut twice, mut moment, mut perimeter) = (0.0, [0.0; 2], 0.0);
        for k in 0..self.corners.len() {
            let [a, b] = self.edge(k);
            let cross = a[0] * b[1] - b[0] * a[1];
            twice += cross;
            (0..2).for_each(|axis| moment[axis] += cross * (a[axis] + b[axis]));
            perimeter += (b[0] - a[0]).hypot(b[1] - a[1]);
        }
        Measures { area: 0.5 * twice, centroid: moment.map(|m| m / (3.0 * twice)), perimeter }
    }
}

/// Area of a polygon with corners in counter-clockwise order, m2.
pub(crate) fn area(corners: &[[f64; 2]]) -> f64 {
    let Some(&[x, y]) = corners.first() else { return 0.0 };
    let cross = |k: usize| {
        let [a, b] = [corners[k], corners[(k + 1) % corners.len()]].map(|r| [r[0] - x, r[1] - y]);
        a[0] * b[1] - b[0] * a[1]
    };
    0.5 * (1..corners.len()).map(cross).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_cut_by_bisectors_is_the_cell_of_its_point() {
        let mut polygon = Polygon::default();
        polygon.reset(10.0);
        for (number, [x, y]) in [[2.0, 0.0], [-2.0, 0.0], [0.0, 2.0], [0.0, -2.0], [4.0, 4.0]].iter().enumerate() {
            polygon.cut([*x, *y], 0.5 * (x * x + y * y), Beyond::Cell(number as u64));
        }
        let Measures { area, centroid, perimeter } = polygon.measures();
        assert!(
            (area - 4.0).abs() < 1e-14 && centroid[0].hypot(centroid[1]) < 1e-15 && (perimeter - 8.0).abs() < 1e-14
        );
        assert!(polygon.beyond.iter().all(|beyond| matches!(beyond, Some(Beyond::Cell(0..4)))));
        assert!((polygon.reach_squared() - 2.0).abs() < 1e-14);
    }
}

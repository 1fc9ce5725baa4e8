//! The plainest way from collision to collision: all balls are moved to every event, and all pairs, images and walls are
//! searched for the next. Nothing of the crate is used.

use corpuscle_gas::{Setup, Side};

/// Balls at one time.
pub struct Brute<const D: usize> {
    pub position: Vec<[f64; D]>,
    pub velocity: Vec<[f64; D]>,
    pub radius: Vec<f64>,
    pub mass: Vec<f64>,
    pub size: [f64; D],
    pub periodic: [bool; D],
    /// Place and speed of each side.
    pub walls: [[[f64; 2]; 2]; D],
    pub time: f64,
    pub collisions: u64,
}

enum Next {
    Nothing,
    Pair(usize, usize, Vec<f64>),
    Wall(usize, usize, usize),
}

impl<const D: usize> Brute<D> {
    pub fn new(setup: &Setup<D>) -> Self {
        let speed = |side: &Side| if let Side::Moving { velocity, .. } = side { *velocity } else { 0.0 };
        Brute {
            position: setup.balls.iter().map(|ball| ball.position).collect(),
            velocity: setup.balls.iter().map(|ball| ball.velocity).collect(),
            radius: setup.balls.iter().map(|ball| ball.radius).collect(),
            mass: setup.balls.iter().map(|ball| ball.mass).collect(),
            size: setup.size,
            periodic: std::array::from_fn(|axis| setup.sides[axis][0] == Side::Periodic),
            walls: std::array::from_fn(|axis| {
                [[0.0, speed(&setup.sides[axis][0])], [setup.size[axis], speed(&setup.sides[axis][1])]]
            }),
            time: 0.0,
            collisions: 0,
        }
    }

    /// Moves on to the next event, or, if there is none before, to `until` or a little way; true where `until` is reached.
    pub fn step(&mut self, until: f64) -> bool {
        // A quarter of the box at most, so that the next images are all that there are.
        let fastest = self.velocity.iter().flatten().fold(1e-9_f64, |fastest, v| fastest.max(v.abs()));
        let shortest = self.size.iter().copied().fold(f64::INFINITY, f64::min);
        let mut first = (until - self.time).min(0.1 * shortest / fastest);
        let ends = first == until - self.time;
        let mut next = Next::Nothing;
        for a in 0..self.position.len() {
            for b in 0..a {
                for image in 0..3_i32.pow(D as u32) {
                    let shift: [f64; D] = std::array::from_fn(|axis| f64::from(image / 3_i32.pow(axis as u32) % 3 - 1));
                    if (0..D).any(|axis| shift[axis] != 0.0 && !self.periodic[axis]) {
                        continue;
                    }
                    let (time, apart) = self.meeting(a, b, shift);
                    if time < first {
                        (first, next) = (time, Next::Pair(a, b, apart));
                    }
                }
            }
            for axis in (0..D).filter(|&axis| !self.periodic[axis]) {
                for end in 0..2 {
                    let [place, speed] = self.walls[axis][end];
                    let side = [1.0, -1.0][end];
                    let gap = side * (self.position[a][axis] - place) - self.radius[a];
                    let closing = -side * (self.velocity[a][axis] - speed);
                    if closing > 0.0 && gap.max(0.0) / closing < first {
                        (first, next) = (gap.max(0.0) / closing, Next::Wall(a, axis, end));
                    }
                }
            }
        }
        self.fly(first);
        match next {
            Next::Nothing => return ends,
            Next::Pair(a, b, _) => self.rebound(a, b),
            Next::Wall(a, axis, end) => {
                self.velocity[a][axis] = 2.0 * self.walls[axis][end][1] - self.velocity[a][axis]
            }
        }
        false
    }

    fn meeting(&self, a: usize, b: usize, shift: [f64; D]) -> (f64, Vec<f64>) {
        let apart: Vec<f64> = (0..D)
            .map(|axis| self.position[b][axis] + shift[axis] * self.size[axis] - self.position[a][axis])
            .collect();
        let relative: Vec<f64> = (0..D).map(|axis| self.velocity[b][axis] - self.velocity[a][axis]).collect();
        let dot = |u: &[f64], v: &[f64]| u.iter().zip(v).map(|(u, v)| u * v).sum::<f64>();
        let (vv, rv) = (dot(&relative, &relative), dot(&apart, &relative));
        let gap2 = dot(&apart, &apart) - (self.radius[a] + self.radius[b]).powi(2);
        let inside = rv * rv - vv * gap2;
        let time = if rv >= 0.0 || inside < 0.0 { f64::INFINITY } else { (-rv - inside.sqrt()) / vv };
        (time.max(0.0), apart)
    }

    fn fly(&mut self, time: f64) {
        for (position, velocity) in self.position.iter_mut().zip(&self.velocity) {
            for axis in 0..D {
                position[axis] += velocity[axis] * time;
                if self.periodic[axis] {
                    position[axis] = position[axis].rem_euclid(self.size[axis]);
                }
            }
        }
        for wall in self.walls.iter_mut().flatten() {
            wall[0] += wall[1] * time;
        }
        self.time += time;
    }

    /// On the line of centres as the paper has it.
    fn rebound(&mut self, a: usize, b: usize) {
        self.collisions += 1;
        let mut line: Vec<f64> = (0..D).map(|axis| self.position[b][axis] - self.position[a][axis]).collect();
        for axis in (0..D).filter(|&axis| self.periodic[axis]) {
            line[axis] -= self.size[axis] * (line[axis] / self.size[axis]).round();
        }
        let length = line.iter().map(|x| x * x).sum::<f64>().sqrt();
        line.iter_mut().for_each(|x| *x /= length);
        let (ma, mb) = (self.mass[a], self.mass[b]);
        let along = |v: &[f64; D]| v.iter().zip(&line).map(|(v, n)| v * n).sum::<f64>();
        let (va, vb) = (along(&self.velocity[a]), along(&self.velocity[b]));
        let (after_a, after_b) =
            (((ma - mb) * va + 2.0 * mb * vb) / (ma + mb), ((mb - ma) * vb + 2.0 * ma * va) / (ma + mb));
        for axis in 0..D {
            self.velocity[a][axis] += (after_a - va) * line[axis];
            self.velocity[b][axis] += (after_b - vb) * line[axis];
        }
    }
}

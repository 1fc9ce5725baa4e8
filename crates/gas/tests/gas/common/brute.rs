//! The plainest way from collision to collision: all balls are moved to every event, and all pairs, images and walls are
//! searched for the next. Nothing of the crate is used.

use corpuscle_gas::{Setup, Side};
use std::collections::HashSet;

/// Balls at one time.
pub struct Brute<const D: usize> {
    pub position: Vec<[f64; D]>,
    pub velocity: Vec<[f64; D]>,
    pub radius: Vec<f64>,
    pub mass: Vec<f64>,
    pub size: [f64; D],
    pub periodic: [bool; D],
    /// Position and speed of each side.
    pub walls: [[[f64; 2]; 2]; D],
    pub time: f64,
    pub collisions: u64,
    /// Speed and displacement of the image above, in a sheared box.
    pub slide: [f64; 2],
    /// Depth of wells and where their rims are, over the distance at contact; a depth of 0 for none.
    pub depth: f64,
    pub width: f64,
    /// Pairs that are in their wells, the larger number first.
    pub bound: HashSet<(usize, usize)>,
}

enum Next {
    Nothing,
    Pair(usize, usize),
    Rim(usize, usize),
    Wall(usize, usize, usize),
}

impl<const D: usize> Brute<D> {
    pub fn new(setup: &Setup<D>) -> Self {
        let speed = |side: &Side| if let Side::Moving { velocity, .. } = side { *velocity } else { 0.0 };
        let mut brute = Brute {
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
            slide: [setup.shear.map_or(0.0, |shear| shear.rate * setup.size[1]), 0.0],
            depth: setup.well.map_or(0.0, |well| well.depth),
            width: setup.well.map_or(1.0, |well| well.width),
            bound: HashSet::new(),
        };
        for (position, velocity) in brute.position.iter().zip(&mut brute.velocity) {
            velocity[0] += brute.slide[0] * (position[1] / brute.size[1] - 0.5);
        }
        for a in 0..brute.position.len() {
            for b in 0..a {
                let line = brute.line(a, b);
                let distance = line.iter().map(|x| x * x).sum::<f64>().sqrt();
                if brute.depth != 0.0 && distance < brute.width * (brute.radius[a] + brute.radius[b]) {
                    brute.bound.insert((a, b));
                }
            }
        }
        brute
    }

    /// Moves on to the next event, or, if there is none before, to `until` or a little way; true where `until` is reached.
    pub fn step(&mut self, until: f64) -> bool {
        // A quarter of the box at most, so that the next images are all that there are.
        let fastest = self.velocity.iter().flatten().fold(1e-9_f64, |fastest, v| fastest.max(v.abs()));
        let shortest = self.size.iter().copied().fold(f64::INFINITY, f64::min);
        let fastest = fastest + self.slide[0].abs();
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
                    let (time, pair) = self.next_of_pair(a, b, shift);
                    if time < first {
                        (first, next) = (time, pair);
                    }
                }
            }
            for axis in (0..D).filter(|&axis| !self.periodic[axis]) {
                for end in 0..2 {
                    let [position, speed] = self.walls[axis][end];
                    let side = [1.0, -1.0][end];
                    let gap = side * (self.position[a][axis] - position) - self.radius[a];
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
            Next::Pair(a, b) => self.rebound(a, b),
            Next::Rim(a, b) => self.cross_rim(a, b),
            Next::Wall(a, axis, end) => {
                self.velocity[a][axis] = 2.0 * self.walls[axis][end][1] - self.velocity[a][axis]
            }
        }
        false
    }

    /// What happens next between a ball and an image of another. A pair in its well is the one in its nearest images.
    fn next_of_pair(&self, a: usize, b: usize, shift: [f64; D]) -> (f64, Next) {
        let contact = self.radius[a] + self.radius[b];
        if self.depth == 0.0 {
            return (self.crossing(a, b, shift, contact, false), Next::Pair(a, b));
        }
        let rim = contact * self.width;
        if !self.bound.contains(&(a, b)) {
            return (self.crossing(a, b, shift, rim, false), Next::Rim(a, b));
        }
        let line = self.line(a, b);
        let nearest = (0..D).all(|axis| {
            let here = self.position[b][axis] + shift[axis] * self.size[axis] - self.position[a][axis];
            (here - line[axis]).abs() < 1e-9 * self.size[axis]
        });
        if !nearest {
            return (f64::INFINITY, Next::Nothing);
        }
        let (core, out) = (self.crossing(a, b, shift, contact, false), self.crossing(a, b, shift, rim, true));
        if core < out { (core, Next::Pair(a, b)) } else { (out, Next::Rim(a, b)) }
    }

    /// When the distance of two balls is `reach`: on the way in, or on the way out.
    fn crossing(&self, a: usize, b: usize, shift: [f64; D], reach: f64, out: bool) -> f64 {
        let apart: Vec<f64> = (0..D)
            .map(|axis| self.position[b][axis] + shift[axis] * self.size[axis] - self.position[a][axis])
            .collect();
        let mut relative: Vec<f64> = (0..D).map(|axis| self.velocity[b][axis] - self.velocity[a][axis]).collect();
        let mut apart = apart;
        apart[0] += shift[1] * self.slide[1];
        relative[0] += shift[1] * self.slide[0];
        let dot = |u: &[f64], v: &[f64]| u.iter().zip(v).map(|(u, v)| u * v).sum::<f64>();
        let (vv, rv) = (dot(&relative, &relative), dot(&apart, &relative));
        let gap2 = dot(&apart, &apart) - reach.powi(2);
        let inside = rv * rv - vv * gap2;
        if inside < 0.0 || vv == 0.0 || (!out && rv >= 0.0) {
            // A pair at its rim by rounding, on its way out.
            return if out && rv > 0.0 { 0.0 } else { f64::INFINITY };
        }
        let root = if out { inside.sqrt() } else { -inside.sqrt() };
        ((-rv + root) / vv).max(0.0)
    }

    /// In which image above the image of `b` nearest to `a` is.
    fn above(&self, a: usize, b: usize) -> f64 {
        if self.slide[0] == 0.0 { 0.0 } else { ((self.position[a][1] - self.position[b][1]) / self.size[1]).round() }
    }

    /// The line from one ball to the nearest image of another.
    fn line(&self, a: usize, b: usize) -> Vec<f64> {
        let mut line: Vec<f64> = (0..D).map(|axis| self.position[b][axis] - self.position[a][axis]).collect();
        line[0] += self.above(a, b) * self.slide[1];
        for axis in (0..D).filter(|&axis| self.periodic[axis]) {
            line[axis] -= self.size[axis] * (line[axis] / self.size[axis]).round();
        }
        line
    }

    /// By energy along the line of centres, and momentum.
    fn cross_rim(&mut self, a: usize, b: usize) {
        let mut line = self.line(a, b);
        let length = line.iter().map(|x| x * x).sum::<f64>().sqrt();
        line.iter_mut().for_each(|x| *x /= length);
        let reduced = self.mass[a] * self.mass[b] / (self.mass[a] + self.mass[b]);
        let speed: f64 = (0..D).map(|axis| line[axis] * (self.velocity[b][axis] - self.velocity[a][axis])).sum();
        let inside = self.bound.contains(&(a, b));
        let energy = 0.5 * reduced * speed * speed + if inside { -self.depth } else { self.depth };
        let after = if energy > 0.0 { (2.0 * energy / reduced).sqrt().copysign(speed) } else { -speed };
        if energy > 0.0 && inside {
            self.bound.remove(&(a, b));
        } else if energy > 0.0 {
            self.bound.insert((a, b));
        }
        for axis in 0..D {
            self.velocity[a][axis] -= reduced / self.mass[a] * (after - speed) * line[axis];
            self.velocity[b][axis] += reduced / self.mass[b] * (after - speed) * line[axis];
        }
    }

    fn fly(&mut self, time: f64) {
        let [speed, slid] = &mut self.slide;
        *slid += *speed * time;
        *slid -= self.size[0] * (*slid / self.size[0]).round();
        let (speed, slid) = (*speed, *slid);
        for (position, velocity) in self.position.iter_mut().zip(&mut self.velocity) {
            for axis in 0..D {
                position[axis] += velocity[axis] * time;
            }
            if speed != 0.0 {
                let over = (position[1] / self.size[1]).floor();
                position[0] -= over * slid;
                velocity[0] -= over * speed;
            }
            for axis in 0..D {
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
        let mut line = self.line(a, b);
        let length = line.iter().map(|x| x * x).sum::<f64>().sqrt();
        line.iter_mut().for_each(|x| *x /= length);
        let (ma, mb) = (self.mass[a], self.mass[b]);
        let along = |v: &[f64; D]| v.iter().zip(&line).map(|(v, n)| v * n).sum::<f64>();
        let above = self.above(a, b) * self.slide[0];
        let (va, vb) = (along(&self.velocity[a]), along(&self.velocity[b]) + above * line[0]);
        let (after_a, after_b) =
            (((ma - mb) * va + 2.0 * mb * vb) / (ma + mb), ((mb - ma) * vb + 2.0 * ma * va) / (ma + mb));
        for axis in 0..D {
            self.velocity[a][axis] += (after_a - va) * line[axis];
            self.velocity[b][axis] += (after_b - vb) * line[axis];
        }
    }
}

//! Balls, walls and what they do to each other. How the next event is found is not here.

mod ball;
mod collide;
mod contact;
mod hit;
mod moments;
mod path;
mod region;
mod shear;
mod wall;
mod well;

pub(crate) use ball::{Ball, Kind, NONE, Record};
pub(crate) use collide::{Rebound, speed};
pub(crate) use contact::{Falling, Field, Growing, Mode, Motion, Path, Quadratic, Sheared, Straight, Welled, in_mode};
pub(crate) use hit::WallTally;
pub(crate) use moments::Moments;
pub(crate) use region::{CountedRegion, RegionSample};
pub(crate) use shear::{ShearTally, Slide};
pub(crate) use wall::{Facing, Wall, first_contact};
pub(crate) use well::Well;

use corpuscle_model::CompensatedSum;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

/// A ball as it is put in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Start<const D: usize> {
    pub position: [f64; D],
    pub velocity: [f64; D],
    pub kind: u32,
    pub species: u32,
}

/// Balls in a box.
///
/// Times are counted from the beginning of a window, which is moved on at fixed numbers of events, so that they stay short
/// and keep their digits.
#[derive(Debug)]
pub(crate) struct World<const D: usize> {
    pub balls: Vec<Ball<D>>,
    pub records: Vec<Record<D>>,
    pub kinds: Vec<Kind>,
    pub field: Field<D>,
    pub walls: Vec<Wall>,
    pub rebound: Rebound,
    /// Square wells round the balls, where there are some.
    pub well: Option<Well>,
    /// The box at the beginning of the window.
    pub low: [f64; D],
    pub length: [f64; D],
    /// Time of the last event, in the window.
    pub now: f64,
    /// Beginning of the window.
    pub origin: CompensatedSum,
    pub tally: Tally,
    /// Sums over hits of each wall.
    pub wall_tallies: Vec<WallTally>,
    /// Collisions in a row between which nothing moved.
    pub standstill: u32,
    /// A ball to which an event would have given a velocity that is not finite; the event did not happen.
    pub refused: Option<usize>,
    /// For thermal walls.
    pub random: ChaCha8Rng,
    /// What momentum and energy have moved; none where walls, loss or gravity change them.
    pub moments: Option<Moments>,
    /// Parts of the box in which pressure is measured.
    pub regions: Vec<CountedRegion<D>>,
    /// The ball whose path is kept, and the path.
    pub followed: Option<Followed<D>>,
}

/// Sums over what happened.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct Tally {
    /// Collisions of two balls.
    pub collisions: u64,
    /// Sum over collisions of (position of one as seen from the other) . (momentum given to it), and over hits of walls of (position of
    /// the centre as seen from the wall) . (momentum given to the ball).
    pub virial: f64,
    /// Length of all paths up to the last time that each was bent.
    pub path: f64,
    /// Energy lost in collisions.
    pub dissipated: CompensatedSum,
    /// What shear did.
    pub shear: ShearTally,
}

/// A ball whose path is kept.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Followed<const D: usize> {
    pub id: u32,
    /// Its collisions with other balls.
    pub collisions: u64,
    /// Time and position wherever the path was bent; positions not a number part two pieces.
    pub bends: Vec<(f64, [f64; D])>,
}

impl<const D: usize> World<D> {
    /// Puts balls into a box.
    pub fn new(low: [f64; D], length: [f64; D], kinds: Vec<Kind>, starts: &[Start<D>], field: Field<D>) -> Self {
        let mut balls = crate::memory::reserved(starts.len());
        let mut records = crate::memory::reserved(starts.len());
        for (id, start) in starts.iter().enumerate() {
            let Start { position, velocity, kind, species } = *start;
            balls.push(Ball { position, velocity, time: 0.0, kind, next: NONE });
            records.push(Record { id: id as u32, species, image: [0; D], collided: f64::NEG_INFINITY });
        }
        World {
            balls,
            records,
            kinds,
            field,
            walls: Vec::new(),
            rebound: Rebound { restitution: 1.0, contact_time: 0.0 },
            well: None,
            low,
            length,
            now: 0.0,
            origin: CompensatedSum::default(),
            tally: Tally::default(),
            wall_tallies: Vec::new(),
            standstill: 0,
            refused: None,
            random: rand::SeedableRng::seed_from_u64(0),
            moments: None,
            regions: Vec::new(),
            followed: None,
        }
    }

    /// Time of the last event.
    pub fn time(&self) -> f64 {
        self.origin.value() + self.now
    }

    /// A time as counted in the window.
    pub fn in_window(&self, time: f64) -> f64 {
        time - self.origin.value()
    }

    /// True where paths are bent by gravity.
    pub fn falls(&self) -> bool {
        self.field.gravity != [0.0; D]
    }

    /// What bends paths, whether balls grow, and how they act on each other.
    pub fn motion(&self) -> Motion {
        match (self.falls(), self.well.is_some()) {
            _ if self.field.growth != 0.0 => Motion::Growing,
            _ if self.field.is_sheared() => Motion::Sheared,
            (false, false) => Motion::Straight,
            (true, false) => Motion::Falling,
            (false, true) => Motion::Welled,
            (true, true) => Motion::WelledFalling,
        }
    }

    /// Position and velocity of a ball at a time of the window, in the image of the box where it is.
    pub fn state(&self, ball: usize, time: f64) -> ([f64; D], [f64; D]) {
        if self.falls() {
            self.field.state::<Falling>(&self.balls[ball], time)
        } else {
            self.field.state::<Straight>(&self.balls[ball], time)
        }
    }

    /// Position of a ball at a time of the window as if the box did not repeat.
    pub fn unwrapped(&self, ball: usize, time: f64) -> [f64; D] {
        let (position, _) = self.state(ball, time);
        let image = &self.records[ball].image;
        std::array::from_fn(|axis| position[axis] + f64::from(image[axis]) * self.field.period[axis])
    }

    /// Moves a ball along its path to now.
    #[inline(always)]
    pub fn bring<M: Mode>(&mut self, ball: usize) {
        let (position, velocity) = self.field.state::<M>(&self.balls[ball], self.now);
        let ball = &mut self.balls[ball];
        (ball.position, ball.velocity, ball.time) = (position, velocity, self.now);
    }

    /// Counts a ball's flight up to now in the sums over paths.
    #[inline(always)]
    pub fn book_flight<M: Mode>(&mut self, ball: usize) {
        let Ball { mut velocity, time, kind, .. } = self.balls[ball];
        let flown = self.now - time;
        self.tally.path += self.path_flown::<M>(ball, self.now);
        if M::SHEARS {
            velocity = self.velocity_in_flight(&self.balls[ball], flown);
        }
        if let Some(moments) = &mut self.moments {
            moments.fly(self.kinds[kind as usize].mass, &velocity, flown);
        }
    }

    /// Length of a ball's path since it was moved last, up to a time of the window: in a sheared box that relative to the flow.
    #[inline(always)]
    fn path_flown<M: Mode>(&self, ball: usize, time: f64) -> f64 {
        let ball = &self.balls[ball];
        let flown = time - ball.time;
        if M::SHEARS {
            speed(&self.velocity_in_flight(ball, flown)) * flown
        } else if M::FALLS {
            path::length(&ball.velocity, &self.field.gravity, flown)
        } else {
            speed(&ball.velocity) * flown
        }
    }

    /// Length of the paths of all balls up to a time of the window, with the flights that are under way.
    pub fn path_at(&self, time: f64) -> f64 {
        let of_ball = |ball: usize| match (self.field.is_sheared(), self.falls()) {
            (true, _) => self.path_flown::<contact::Sheared>(ball, time),
            (false, true) => self.path_flown::<contact::Falling>(ball, time),
            (false, false) => self.path_flown::<contact::Straight>(ball, time),
        };
        self.tally.path + (0..self.balls.len()).map(of_ball).sum::<f64>()
    }

    /// The moments at a time of the window, with the flights that are under way.
    pub fn moments_at(&self, time: f64) -> Moments {
        let mut moments = self.moments.unwrap_or_default();
        if self.moments.is_some() {
            for ball in &self.balls {
                let flown = time - ball.time;
                let sheared = self.field.is_sheared();
                let velocity = if sheared { self.velocity_in_flight(ball, flown) } else { ball.velocity };
                moments.fly(self.kinds[ball.kind as usize].mass, &velocity, flown);
            }
        }
        moments
    }

    /// Moves all balls along their paths to now, and makes now the beginning of the window.
    pub fn begin_window<M: Mode>(&mut self) {
        for ball in 0..self.balls.len() {
            self.book_flight::<M>(ball);
            self.bring::<M>(ball);
            self.balls[ball].time = 0.0;
            self.records[ball].collided -= self.now;
        }
        for wall in &mut self.walls {
            wall.since -= self.now;
        }
        self.field.scale = self.field.scale_at::<M>(self.now);
        if M::SHEARS {
            self.field.slide.displacement = self.field.slid_at(self.now).rem_euclid(self.field.period[0]);
        }
        self.origin.add(self.now);
        self.now = 0.0;
        for axis in 0..D {
            let [low, high] = self.extent(axis, 0.0);
            (self.low[axis], self.length[axis]) = (low, high - low);
        }
    }

    /// Where the box begins and ends along an axis at a time of the window.
    pub fn extent(&self, axis: usize, time: f64) -> [f64; 2] {
        let mut extent = [self.low[axis], self.low[axis] + self.length[axis]];
        for wall in self.walls.iter().filter(|wall| wall.axis == axis) {
            match wall.facing {
                Facing::Up => extent[0] = wall.position_at(time),
                Facing::Down => extent[1] = wall.position_at(time),
                Facing::Both => {}
            }
        }
        extent
    }

    /// Area (in three dimensions volume) of the box at a time of the window.
    pub fn volume(&self, time: f64) -> f64 {
        (0..D).map(|axis| self.extent(axis, time)).map(|[low, high]| high - low).product()
    }

    /// Turns the velocities of all balls round. They must have been brought to the beginning of the window.
    pub fn reverse(&mut self) {
        for ball in 0..self.balls.len() {
            self.balls[ball].velocity = self.balls[ball].velocity.map(|v| -v);
            self.note_bend(ball);
        }
    }

    /// Puts a ball into the next image of a periodic box, above (1) or below (-1).
    #[inline(always)]
    pub fn wrap(&mut self, ball: usize, axis: usize, direction: i32) {
        self.balls[ball].position[axis] -= f64::from(direction) * self.field.period[axis];
        self.records[ball].image[axis] += direction;
        if self.followed.is_some() {
            self.note_wrap(ball, axis, direction);
        }
    }

    /// A followed path ends at one side of a periodic box and goes on at the other.
    #[cold]
    fn note_wrap(&mut self, ball: usize, axis: usize, direction: i32) {
        let (id, time, mut position) = (self.records[ball].id, self.time(), self.state(ball, self.now).0);
        let Some(followed) = self.followed.as_mut().filter(|followed| followed.id == id) else { return };
        let after = position;
        position[axis] += f64::from(direction) * self.field.period[axis];
        followed.bends.extend([(time, position), (time, [f64::NAN; D]), (time, after)]);
    }

    /// A followed path ends where the ball left a sheared box, and goes on where it came in.
    fn note_jump(&mut self, ball: usize, before: [f64; D]) {
        let (id, time, after) = (self.records[ball].id, self.time(), self.balls[ball].position);
        if let Some(followed) = self.followed.as_mut().filter(|followed| followed.id == id) {
            followed.bends.extend([(time, before), (time, [f64::NAN; D]), (time, after)]);
        }
    }

    /// Puts the balls in another order.
    pub fn reorder(&mut self, order: &[u32]) {
        let mut balls = crate::memory::reserved(order.len());
        balls.extend(order.iter().map(|&from| self.balls[from as usize]));
        let mut records = crate::memory::reserved(order.len());
        records.extend(order.iter().map(|&from| self.records[from as usize]));
        (self.balls, self.records) = (balls, records);
        if let Some(well) = &mut self.well {
            well.reorder(order);
        }
    }

    /// Notes where the followed ball's path was bent, if it is this one.
    #[inline(always)]
    pub fn note_bend(&mut self, ball: usize) {
        if self.followed.is_some() {
            self.note_followed(ball);
        }
    }

    /// Notes a collision of two balls, if the followed ball is one of them.
    #[cold]
    fn note_collision(&mut self, a: usize, b: usize) {
        let ids = [a, b].map(|ball| self.records[ball].id);
        if let Some(followed) = self.followed.as_mut().filter(|followed| ids.contains(&followed.id)) {
            followed.collisions += 1;
        }
        self.note_followed(a);
        self.note_followed(b);
    }

    #[cold]
    fn note_followed(&mut self, ball: usize) {
        let (id, time, position) = (self.records[ball].id, self.time(), self.balls[ball].position);
        if let Some(followed) = &mut self.followed
            && followed.id == id
        {
            followed.bends.push((time, position));
        }
    }

    /// Radius of a ball.
    pub fn radius(&self, ball: usize) -> f64 {
        self.kinds[self.balls[ball].kind as usize].radius
    }

    /// Mass of a ball.
    pub fn mass(&self, ball: usize) -> f64 {
        self.kinds[self.balls[ball].kind as usize].mass
    }
}

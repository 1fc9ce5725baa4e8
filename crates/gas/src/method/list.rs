//! The published method: a list with the nearest event of each ball (Deng, Hu, Li and Zhang, Physics and Engineering 22(5),
//! 2012; after Kim, Guibas and Shin, IEEE TVCG 4(3), 1998).
//!
//! The earliest event of the list is taken; it changes the balls involved, whose events go; they, and the balls that lost their
//! partners ("disturbed"), find new ones among all others. The cost of an event grows with the number of balls. The moments
//! are those of the fast engine, without periodic sides to the bit.

use crate::pause::Pause;
use crate::world::{Ball, Mode, Path, Quadratic, World, first_contact, in_mode};

/// Events between windows.
const EVENTS_PER_WINDOW: u64 = 1_000_000;

/// With what a ball meets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum With {
    /// Nothing at all.
    Nothing,
    /// Another ball, by its number.
    Ball(usize),
    /// Another ball, by its number, at the rim of their well.
    Rim(usize),
    /// A wall: those of the box by axis, the lower before the upper, periodic sides left out; then the partition.
    Wall(usize),
    /// A periodic side, upwards or downwards along an axis.
    Side(usize, i32),
    /// The image of a sheared box above it, which has slid by half the box: pairs are searched again.
    Slide,
}

/// The nearest event of a ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// When; infinite for never.
    pub time: f64,
    /// With whom.
    pub with: With,
}

const NOTHING: Nearest = Nearest { time: f64::INFINITY, with: With::Nothing };

/// Balls and the nearest event of each.
#[derive(Debug)]
pub(crate) struct List<const D: usize> {
    pub world: World<D>,
    pub nearest: Vec<Nearest>,
    handled: u64,
}

impl<const D: usize> List<D> {
    pub fn new(world: World<D>) -> Self {
        let nearest = vec![NOTHING; world.balls.len()];
        let mut list = List { world, nearest, handled: 0 };
        list.find_all_events();
        list
    }

    /// Begins a new window now.
    pub fn begin_window(&mut self) {
        in_mode!(self.world.motion(), M => self.world.begin_window::<M>());
        self.handled = 0;
        self.find_all_events();
    }

    /// Finds the nearest events of all balls.
    pub fn find_all_events(&mut self) {
        self.nearest.clear();
        self.nearest.resize(self.world.balls.len(), NOTHING);
        for ball in 0..self.nearest.len() {
            self.find_event(ball);
        }
    }

    /// Handles events up to `until` (in the window), `most` at most.
    pub fn run(&mut self, until: f64, most: u64) -> Pause {
        for _ in 0..most {
            let Some(ball) = self.earliest().filter(|&ball| self.nearest[ball].time <= until) else {
                return Pause::Reached;
            };
            if self.handled >= EVENTS_PER_WINDOW {
                return Pause::WindowFull;
            }
            self.handled += 1;
            self.happen(ball);
            if self.world.stands_still() {
                return Pause::Standstill;
            }
        }
        Pause::Worked
    }

    /// The ball with the earliest event; of equal ones the first.
    pub fn earliest(&self) -> Option<usize> {
        let times = self.nearest.iter().map(|event| event.time).enumerate();
        times.filter(|(_, time)| time.is_finite()).min_by(|a, b| a.1.total_cmp(&b.1)).map(|(ball, _)| ball)
    }

    /// Lets the event of a ball happen and finds new events for all that it touches.
    pub fn happen(&mut self, ball: usize) {
        let Nearest { time, with } = self.nearest[ball];
        self.world.now = time;
        let mut touched = vec![ball];
        match with {
            With::Nothing => {}
            With::Ball(other) => {
                in_mode!(self.world.motion(), M => self.world.collide::<M>(ball, other));
                touched.push(other);
            }
            With::Rim(other) => {
                in_mode!(self.world.motion(), M => self.world.cross_rim::<M>(ball, other));
                touched.push(other);
            }
            With::Wall(wall) => {
                let bends = self.world.walls[wall].bends;
                in_mode!(self.world.motion(), M => self.world.hit::<M>(ball, wall));
                if self.world.walls[wall].bends != bends {
                    self.find_all_events();
                    return;
                }
            }
            With::Slide => {
                self.nearest[ball] = NOTHING;
                self.find_event(ball);
                return;
            }
            With::Side(axis, direction) => {
                if axis == 1 && self.world.field.is_sheared() {
                    self.world.wrap_in_shear(ball, direction);
                } else {
                    self.world.wrap(ball, axis, direction);
                }
                self.nearest[ball] = NOTHING;
                self.find_event(ball);
                return;
            }
        }
        let lost = |event: &Nearest| matches!(event.with, With::Ball(partner) | With::Rim(partner) if touched.contains(&partner));
        let disturbed: Vec<usize> =
            (0..self.nearest.len()).filter(|&other| !touched.contains(&other) && lost(&self.nearest[other])).collect();
        touched.extend(disturbed);
        for &ball in &touched {
            self.nearest[ball] = NOTHING;
        }
        for ball in touched {
            self.find_event(ball);
        }
    }

    /// Finds the nearest event of a ball; where its partner had no earlier one, it is the partner's too.
    fn find_event(&mut self, ball: usize) {
        let found = in_mode!(self.world.motion(), M => self.find::<M>(ball));
        self.nearest[ball] = found;
        let (other, with) = match found.with {
            With::Ball(other) => (other, With::Ball(ball)),
            With::Rim(other) => (other, With::Rim(ball)),
            _ => return,
        };
        if found.time < self.nearest[other].time {
            self.nearest[other] = Nearest { time: found.time, with };
        }
    }

    fn find<M: Mode>(&self, ball: usize) -> Nearest {
        let world = &self.world;
        let mut nearest = NOTHING;
        let mut offer = |time: f64, with: With| {
            if time < nearest.time {
                nearest = Nearest { time, with };
            }
        };
        for other in (0..world.balls.len()).filter(|&other| other != ball) {
            let (time, with) = self.pair::<M>(ball, other);
            offer(time, with);
        }
        for (number, wall) in world.walls.iter().enumerate() {
            offer(wall.meeting::<D, M>(&world.balls[ball], world.radius(ball), &world.field), With::Wall(number));
        }
        for axis in (0..D).filter(|&axis| world.field.period[axis] > 0.0) {
            let (time, direction) = self.side::<M>(ball, axis);
            offer(time, With::Side(axis, direction));
        }
        if M::SHEARS {
            offer(self.next_slide(), With::Slide);
        }
        nearest.time = nearest.time.max(world.now);
        nearest
    }

    /// What happens next between two balls, and when.
    fn pair<M: Mode>(&self, a: usize, b: usize) -> (f64, With) {
        let contact = self.world.contact(a, b);
        match &self.world.well {
            None => (self.meeting::<M>(a, b, contact), With::Ball(b)),
            Some(well) if !well.are_bound(a, b) => (self.meeting::<M>(a, b, contact * well.width), With::Rim(b)),
            Some(well) => match self.world.next_in_well::<M>(well, a, b) {
                (time, false) => (time, With::Ball(b)),
                (time, true) => (time, With::Rim(b)),
            },
        }
    }

    /// When two balls come as near as `reach`, in any image of the box next to their own.
    fn meeting<M: Mode>(&self, a: usize, b: usize, reach: f64) -> f64 {
        let world = &self.world;
        let path = |ball: usize| {
            let ball = &world.balls[ball];
            Path { position: ball.position, velocity: ball.velocity, time: ball.time }
        };
        if M::SHEARS {
            return self.meeting_in_shear::<M>(a, b, reach);
        }
        let mut first = f64::INFINITY;
        for image in 0..3_usize.pow(D as u32) {
            let shift: [i32; D] = std::array::from_fn(|axis| (image / 3_usize.pow(axis as u32) % 3) as i32 - 1);
            if (0..D).any(|axis| shift[axis] != 0 && world.field.period[axis] == 0.0) {
                continue;
            }
            let offset = std::array::from_fn(|axis| f64::from(shift[axis]) * world.field.period[axis]);
            let quadratic = Quadratic::new::<D, M>(&path(a), &path(b), &offset, reach, &world.field);
            if quadratic.maybe_before::<M>(f64::INFINITY) {
                first = first.min(quadratic.root::<M>());
            }
        }
        first
    }

    /// As [`List::meeting`], in images that slide.
    fn meeting_in_shear<M: Mode>(&self, a: usize, b: usize, reach: f64) -> f64 {
        let (field, balls) = (&self.world.field, &self.world.balls);
        let path = |ball: &Ball<D>| Path { position: ball.position, velocity: ball.velocity, time: ball.time };
        let mut first = f64::INFINITY;
        for above in -1..=1 {
            let images = f64::from(above);
            let image = path(&field.image_above(&balls[b], images));
            // Images are counted from the one that is least displaced now.
            let slid = (images * field.slid_at(self.world.now) / field.period[0]).round();
            for along in -2..=2 {
                for beside in if D == 3 { -1..=1 } else { 0..=0 } {
                    let mut offset = [0.0; D];
                    offset[0] = (f64::from(along) - slid) * field.period[0];
                    offset[1] = images * field.period[1];
                    if D == 3 {
                        offset[D - 1] = f64::from(beside) * field.period[D - 1];
                    }
                    let quadratic = Quadratic::new::<D, M>(&path(&balls[a]), &image, &offset, reach, field);
                    if quadratic.maybe_before::<M>(f64::INFINITY) {
                        first = first.min(quadratic.root::<M>());
                    }
                }
            }
        }
        first
    }

    /// When the image above will have slid by another half of the box.
    fn next_slide(&self) -> f64 {
        let (field, now) = (&self.world.field, self.world.now);
        let half = 0.5 * field.period[0];
        let mut halves = (field.slid_at(now) / half).floor();
        loop {
            halves += 1.0;
            let time = (halves * half - field.slide.displacement) / field.slide.speed;
            // By rounding it may be now, again.
            if time > now {
                return time;
            }
        }
    }

    /// When and which way a ball leaves through a periodic side.
    fn side<M: Mode>(&self, ball: usize, axis: usize) -> (f64, i32) {
        let world = &self.world;
        let (position, velocity) = world.field.state::<M>(&world.balls[ball], world.now);
        let gravity = if M::FALLS { world.field.gravity[axis] } else { 0.0 };
        let above = position[axis] - world.low[axis];
        let up = world.now + first_contact(world.length[axis] - above, -velocity[axis], -gravity);
        let down = world.now + first_contact(above, velocity[axis], gravity);
        if up < down { (up, 1) } else { (down, -1) }
    }

    /// Bytes held for the balls and their events.
    pub fn bytes(&self) -> usize {
        let each = size_of::<crate::world::Ball<D>>() + size_of::<crate::world::Record<D>>() + size_of::<Nearest>();
        self.world.balls.len() * each
    }

    /// Events handled in this window.
    pub fn handled(&self) -> u64 {
        self.handled
    }

    /// Sets the value of [`List::handled`] again.
    pub fn set_handled(&mut self, handled: u64) {
        self.handled = handled;
    }
}

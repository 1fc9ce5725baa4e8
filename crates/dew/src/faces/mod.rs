//! Air that enters by inlets, leaves by outlets and both by open sides, and its initial positions.

mod inlet;
mod open;

pub use open::OpenSide;
#[cfg(feature = "gpu")]
pub(crate) use open::deepest as deepest_outside;

use crate::air::{Particle, Properties, Role, Scale};
use crate::constants::{BEYOND, OUTLET_LAYER};
use crate::inventory::Inventory;
use crate::room::{Face, Mirrors, Room};
use crate::solids::{Body, Searched, Solids, Surface};
use corpuscle_model::ExactSum;

/// How far before an inlet a new layer of particles stands, m; they are `apart` m apart, and `h` is the smoothing length.
pub(crate) fn before_inlet(h: f64, apart: f64) -> f64 {
    ((BEYOND * h / apart).ceil() - 0.5) * apart
}

/// Air starts no nearer to a solid's surface than this, in spacings.
const CLEARANCE: f64 = 0.25;

/// Where air can start: outside of solids and not too near to their surfaces.
pub(crate) struct Free {
    solids: Searched,
    /// Surfaces of the bodies, and where each goes on as its mirror image.
    surfaces: Vec<(Surface, Mirrors)>,
    room: Room,
    /// Least distance from the particles of solids, m.
    nearest: f64,
    /// Least distance from surfaces, m.
    clearance: f64,
}

impl Free {
    /// Outside of solids with these surfaces, as far as they are known.
    pub(crate) fn new(
        solids: &Solids,
        room: &Room,
        scale: &Scale,
        surfaces: impl ExactSizeIterator<Item = Option<Surface>>,
    ) -> Self {
        let sites = solids.sites(room, scale.h(), |_| true);
        let bodies = surfaces.len();
        let with_mirrors = surfaces.zip(&solids.mirrors);
        let surfaces: Vec<_> = with_mirrors.filter_map(|(surface, mirrors)| Some((surface?, *mirrors))).collect();
        let nearest = if surfaces.len() == bodies { 0.5 } else { 0.75 } * scale.spacing;
        let solids = Searched::new(&sites, scale.h());
        Self { solids, surfaces, room: *room, nearest, clearance: CLEARANCE * scale.spacing }
    }

    /// Whether air can start at a position.
    pub(crate) fn holds(&self, position: [f64; 3]) -> bool {
        let away = |(surface, mirrors): &(Surface, Mirrors)| surface(self.room.mirrored_back(position, mirrors));
        self.solids.near(position, self.nearest).next().is_none()
            && self.surfaces.iter().all(|surface| away(surface) > self.clearance)
    }
}

impl Inventory<'_> {
    /// Fills the room, and what lies before inlets and beyond outlets, with air on a lattice. Returns the columns outside open sides.
    pub(crate) fn fill(&mut self, bodies: &[Body], start: impl Fn([f64; 3]) -> [f64; 2]) -> Vec<OpenSide> {
        let spacing = self.scale.spacing;
        let counts = self.room.counts(spacing).map(|count| count as i64);
        let apart = self.room.apart(spacing);
        let beyond = [0, 1, 2].map(|axis| (BEYOND * self.scale.h() / apart[axis]).ceil() as i64);
        let range = [0, 1, 2].map(|axis| {
            let more = [0, 1].map(|side| if self.room.faces[axis][side].is_passed() { beyond[axis] } else { 0 });
            -more[0]..counts[axis] + more[1]
        });
        let free = Free::new(self.solids, self.room, self.scale, bodies.iter().map(|body| body.surface.clone()));
        let is_free = |position: [f64; 3]| free.holds(position);
        let mut next_id = self.state.next_id;
        for z in range[2].clone() {
            for y in range[1].clone() {
                for x in range[0].clone() {
                    let index = [x, y, z];
                    let position = [0, 1, 2].map(|axis| self.room.low[axis] + (index[axis] as f64 + 0.5) * apart[axis]);
                    // By the position on the lattice, so that no process has to know what another leaves out.
                    let id = next_id;
                    next_id += 1;
                    if !self.owns(position) || !self.room.is_filled(position) || !is_free(position) {
                        continue;
                    }
                    let [temperature, vapour] = start(position);
                    let particle = Particle::new(id, position, temperature, vapour);
                    self.state.air.push(placed(particle, self.room, slowest(self.air)));
                }
            }
        }
        self.state.next_id = next_id;
        OpenSide::all(self.room, self.scale, is_free)
    }

    /// Air crosses faces that let it pass, is let in, and is let go.
    pub(crate) fn cross_faces(&mut self, step: f64, open_sides: &mut [OpenSide]) {
        if !self.room.faces.iter().flatten().any(Face::is_passed) {
            return;
        }
        let far = BEYOND * self.scale.h();
        let before = self.before_outlets();
        self.update_outlet_pressure(step, &before);
        let mut air = std::mem::take(&mut self.state.air);
        air.retain_mut(|particle| {
            self.cross(particle, step, &before);
            match particle.role {
                Role::Leaving(axis, side) | Role::Outside(axis, side) => {
                    self.room.depth_beyond(particle.position, usize::from(axis), usize::from(side)) < far
                }
                Role::Gone => false,
                _ => true,
            }
        });
        self.state.air = air;
        self.let_in(step);
        self.move_outside(open_sides);
    }

    /// Sets a particle's role by its position, and books inflow and outflow; beyond outlets it goes on, as much faster as the air before them.
    fn cross(&mut self, particle: &mut Particle, step: f64, before: &[[BeforeOutlet; 2]; 3]) {
        if particle.role == Role::Inside {
            self.room.hold_at_inlets(&mut particle.position, &mut particle.velocity);
        }
        match (particle.role, self.room.beyond(particle.position)) {
            (Role::Inside | Role::Idle, Some((axis, side))) => {
                // Air of low utility is booked as outflow already.
                if particle.role == Role::Inside {
                    self.book(particle, -1.0);
                }
                if self.room.is_beyond_edge(particle.position) {
                    particle.role = Role::Gone;
                } else if self.room.faces[axis][side] == Face::Open {
                    particle.role = Role::Outside(axis as u8, side as u8);
                } else {
                    particle.leave(axis, side, particle.velocity[axis], slowest(self.air));
                    // Kept by each particle for itself, what evened it out last would go on for ever, and stir the air beyond.
                    particle.spreading = [0.0; 3];
                    particle.spreading[axis] = before[axis][side].spreading;
                }
            }
            (Role::Leaving(axis, side), _) => {
                let (axis, side) = (usize::from(axis), usize::from(side));
                let along = particle.velocity[axis] + step * before[axis][side].acceleration;
                particle.leave(axis, side, along, slowest(self.air));
            }
            (Role::Coming(..) | Role::Outside(..), None) => {
                particle.role = Role::Inside;
                self.book(particle, 1.0);
            }
            _ => {}
        }
    }

    /// What the air before each outlet does.
    pub(crate) fn before_outlets(&self) -> [[BeforeOutlet; 2]; 3] {
        [0, 1, 2].map(|axis| [0, 1].map(|side| self.before_outlet(axis, side)))
    }

    /// The air before an outlet, with which the air beyond goes on: each particle keeps what it is faster or slower by, and a flow that swells or ebbs
    /// meets no plug.
    fn before_outlet(&self, axis: usize, side: usize) -> BeforeOutlet {
        if self.room.faces[axis][side] != Face::Outlet {
            return BeforeOutlet::default();
        }
        let face = [self.room.low, self.room.high][side][axis];
        let (mut counts, mut sums) = ([0; 2], [ExactSum::default(); 3]);
        for particle in self.state.inside() {
            let distance = (particle.position[axis] - face).abs();
            if distance < self.scale.h() {
                sums[0].add(particle.acceleration[axis]);
                sums[1].add(particle.velocity[axis]);
                counts[0] += 1;
            }
            if distance < OUTLET_LAYER * self.scale.h() {
                sums[2].add(particle.spreading[axis]);
                counts[1] += 1;
            }
        }
        self.processes.total(&mut counts, &mut sums.each_mut());
        let mean = |sum: usize, count: usize| sums[sum].value() / counts[count].max(1) as f64;
        BeforeOutlet { acceleration: mean(0, 0), velocity: mean(1, 0), spreading: mean(2, 1) }
    }

    /// The pressure p beyond outlets lets sound out: dp/dt = rho c du/dt - (c / L) p, with u the speed outwards and L the length of the room (Rudy &
    /// Strikwerda, Journal of Computational Physics 36, 1980, 55). Then p = rho c (u - v), with dv/dt = (c / L) (u - v).
    fn update_outlet_pressure(&mut self, step: f64, before: &[[BeforeOutlet; 2]; 3]) {
        let sound = self.air.sound_speed;
        for axis in 0..3 {
            let crossed = step * sound / (self.room.high[axis] - self.room.low[axis]);
            for side in 0..2 {
                let (outward, speed) = ([-1.0, 1.0][side], before[axis][side].velocity);
                let running_mean = &mut self.state.running_mean_before[axis][side];
                *running_mean += crossed / (1.0 + crossed) * (speed - *running_mean);
                self.state.density_excess_beyond[axis][side] = outward * (speed - *running_mean) / sound;
            }
        }
    }
}

/// What air before an outlet does along the outlet's axis, in the mean.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct BeforeOutlet {
    /// Within a smoothing length, m/s2.
    acceleration: f64,
    /// Within a smoothing length, m/s.
    pub velocity: f64,
    /// [`Particle::spreading`] within [`OUTLET_LAYER`], m/s2.
    spreading: f64,
}

/// Least speed of air beyond an outlet, over the speed of sound.
const SLOWEST: f64 = 0.01;

/// Least speed of air beyond an outlet, m/s: it must not block the outflow.
pub(crate) fn slowest(air: &Properties) -> f64 {
    SLOWEST * air.sound_speed
}

/// Gives a new particle the role and velocity of where it stands.
fn placed(mut particle: Particle, room: &Room, slowest: f64) -> Particle {
    let Some((axis, side)) = room.beyond(particle.position) else { return particle };
    if room.is_beyond_edge(particle.position) {
        particle.role = Role::Still;
        return particle;
    }
    match room.faces[axis][side] {
        Face::Inlet(inflow) => {
            particle.role = Role::Coming(axis as u8, side as u8);
            (particle.temperature, particle.vapour) = (inflow.temperature, inflow.vapour);
            particle.velocity = inflow.velocity;
        }
        Face::Open => particle.role = Role::Outside(axis as u8, side as u8),
        _ => {
            particle.leave(axis, side, 0.0, slowest);
        }
    }
    particle
}

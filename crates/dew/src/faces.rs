//! Air that comes in by inlets and goes out by outlets, and where it stands at the start.

use crate::air::{Particle, Role};
use crate::dew::Dew;
use crate::room::{Face, Inflow, Room};
use crate::solids::{Body, Searched};

/// How far air goes on beyond an open face, in smoothing lengths: what is inside feels the first, which feels the second.
const BEYOND: f64 = 2.0;

/// Air starts no nearer to a solid's surface than this, in spacings.
const CLEARANCE: f64 = 0.25;

impl Dew {
    /// Fills the room, and what lies before inlets and beyond outlets, with air on a lattice.
    pub(crate) fn fill(&mut self, bodies: &[Body], start: impl Fn([f64; 3]) -> [f64; 2]) {
        let spacing = self.scale.spacing;
        let size = self.room.size();
        let counts = size.map(|side| (side / spacing).round().max(1.0) as i64);
        let apart = [0, 1, 2].map(|axis| size[axis] / counts[axis] as f64);
        let beyond = [0, 1, 2].map(|axis| (BEYOND * self.scale.h() / apart[axis]).ceil() as i64);
        let open = |axis: usize, side: usize| matches!(self.room.faces[axis][side], Face::Inlet(_) | Face::Outlet);
        let range = [0, 1, 2].map(|axis| {
            let more = [0, 1].map(|side| if open(axis, side) { beyond[axis] } else { 0 });
            -more[0]..counts[axis] + more[1]
        });
        let sites = self.solids.sites(&self.room, self.scale.h(), |_| true);
        let solids = Searched::new(&sites, self.scale.h());
        let known: Vec<_> = bodies.iter().filter_map(|body| body.surface.clone()).collect();
        let is_free = |place: [f64; 3]| {
            let near = if known.len() == bodies.len() { 0.5 } else { 0.75 };
            solids.near(place, near * spacing).next().is_none()
                && known.iter().all(|surface| surface(place) > CLEARANCE * spacing)
        };
        for z in range[2].clone() {
            for y in range[1].clone() {
                for x in range[0].clone() {
                    let index = [x, y, z];
                    let place = [0, 1, 2].map(|axis| self.room.low[axis] + (index[axis] as f64 + 0.5) * apart[axis]);
                    let outside = (0..3).filter(|&axis| index[axis] < 0 || index[axis] >= counts[axis]).count();
                    // Nothing stands where two open faces meet.
                    if outside > 1 || !is_free(place) {
                        continue;
                    }
                    let [temperature, vapour] = start(place);
                    let particle = Particle::new(self.state.next_id, place, temperature, vapour);
                    self.state.next_id += 1;
                    self.state.air.push(placed(particle, &self.room, self.slowest()));
                }
            }
        }
    }

    /// Air crosses open faces, is let in, and is let go.
    pub(crate) fn cross_faces(&mut self, step: f64) {
        let is_open = |face: &Face| matches!(face, Face::Inlet(_) | Face::Outlet);
        if !self.room.faces.iter().flatten().any(is_open) {
            return;
        }
        let far = BEYOND * self.scale.h();
        let slowest = self.slowest();
        let before = [0, 1, 2].map(|axis| [0, 1].map(|side| step * self.acceleration_before(axis, side)));
        let mut air = std::mem::take(&mut self.state.air);
        air.retain_mut(|particle| {
            let beyond = self.room.beyond(particle.position);
            match (particle.role, beyond) {
                (Role::Inside | Role::Idle, Some((axis, side))) => {
                    // What no longer mattered is booked as gone.
                    if particle.role == Role::Inside {
                        self.book(particle, -1.0);
                    }
                    particle.leave(axis, side, particle.velocity[axis], slowest);
                }
                (Role::Leaving(axis, side), _) => {
                    let (axis, side) = (usize::from(axis), usize::from(side));
                    particle.leave(axis, side, particle.velocity[axis] + before[axis][side], slowest);
                }
                (Role::Coming(..), None) => {
                    particle.role = Role::Inside;
                    self.book(particle, 1.0);
                }
                _ => {}
            }
            match particle.role {
                Role::Leaving(axis, side) => {
                    let (axis, side) = (usize::from(axis), usize::from(side));
                    let [low, high] = [self.room.low[axis], self.room.high[axis]];
                    [low - particle.position[axis], particle.position[axis] - high][side] < far
                }
                _ => true,
            }
        });
        self.state.air = air;
        for axis in 0..3 {
            for side in 0..2 {
                if let Face::Inlet(inflow) = self.room.faces[axis][side] {
                    self.let_in(axis, side, inflow, step);
                }
            }
        }
    }

    /// Least speed of air beyond an outlet, m/s: it does not stand in the way.
    pub(crate) fn slowest(&self) -> f64 {
        SLOWEST * self.air.sound_speed
    }

    /// Mean acceleration along its axis of the air within a smoothing length of an outlet, m/s2, with which air beyond goes
    /// on: each parcel keeps what it is faster or slower by, and a flow that swells or ebbs meets no plug.
    fn acceleration_before(&self, axis: usize, side: usize) -> f64 {
        if self.room.faces[axis][side] != Face::Outlet {
            return 0.0;
        }
        let face = [self.room.low, self.room.high][side][axis];
        let near = self.inside().filter(|particle| (particle.position[axis] - face).abs() < self.scale.h());
        let (sum, count) =
            near.fold((0.0, 0_u32), |(sum, count), particle| (sum + particle.acceleration[axis], count + 1));
        sum / f64::from(count.max(1))
    }

    pub(crate) fn book(&mut self, particle: &Particle, sign: f64) {
        let water = self.particle_mass() * (particle.vapour + particle.fog);
        let energy = self.energy_of(particle);
        self.state.water.book(sign * water);
        self.state.energy.book(sign * energy);
    }

    /// Adds a layer before an inlet as soon as there is room for it.
    fn let_in(&mut self, axis: usize, side: usize, inflow: Inflow, step: f64) {
        let size = self.room.size();
        let counts = size.map(|length| (length / self.scale.spacing).round().max(1.0));
        let apart = [0, 1, 2].map(|along| size[along] / counts[along]);
        self.state.inlet_phase[axis][side] += inflow.speed * step;
        while self.state.inlet_phase[axis][side] >= apart[axis] {
            self.state.inlet_phase[axis][side] -= apart[axis];
            let depth = ((BEYOND * self.scale.h() / apart[axis]).ceil() - 0.5) * apart[axis];
            let behind = depth - self.state.inlet_phase[axis][side];
            let others = [(axis + 1) % 3, (axis + 2) % 3];
            for b in 0..counts[others[1]] as u64 {
                for a in 0..counts[others[0]] as u64 {
                    let mut place = [0.0; 3];
                    place[axis] = [self.room.low[axis] - behind, self.room.high[axis] + behind][side];
                    for (other, index) in others.into_iter().zip([a, b]) {
                        place[other] = self.room.low[other] + (index as f64 + 0.5) * apart[other];
                    }
                    let particle = Particle::new(self.state.next_id, place, inflow.temperature, inflow.vapour);
                    self.state.next_id += 1;
                    self.state.air.push(placed(particle, &self.room, self.slowest()));
                }
            }
        }
    }
}

/// Least speed of air beyond an outlet, over the speed of sound.
const SLOWEST: f64 = 0.01;

/// Gives a new particle the role and velocity of where it stands.
fn placed(mut particle: Particle, room: &Room, slowest: f64) -> Particle {
    let Some((axis, side)) = room.beyond(particle.position) else { return particle };
    let inward = [1.0, -1.0][side];
    match room.faces[axis][side] {
        Face::Inlet(inflow) => {
            particle.role = Role::Coming(axis as u8, side as u8);
            (particle.temperature, particle.vapour) = (inflow.temperature, inflow.vapour);
            particle.velocity[axis] = inward * inflow.speed;
        }
        _ => {
            particle.leave(axis, side, 0.0, slowest);
        }
    }
    particle
}

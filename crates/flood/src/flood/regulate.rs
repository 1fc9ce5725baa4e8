//! Outflows by rating, held levels and links in a step.

use super::{DENSITY, Flood};
use crate::inflow::Nursery;
use crate::sampling::Sampler;
use crate::structures::{Flow, Flows};
use crate::zone::Zone;
use std::collections::HashSet;

/// A held level is kept to within this share of a particle's volume.
const HELD_TO: f64 = 0.75;

/// Which particles go out, and which go where.
#[derive(Default)]
struct Orders {
    out: Vec<usize>,
    moved: Vec<(usize, [f64; 2])>,
    /// Both kinds.
    taken: HashSet<usize>,
}

impl Flood {
    /// Lets structures work for `step` s; whether particles are left without volume, to be taken out.
    pub(super) fn regulate(&mut self, step: f64) -> bool {
        if self.structures.is_empty() {
            return false;
        }
        let mut flows = std::mem::take(&mut self.state.flows);
        let mut orders = Orders::default();
        let mut nursery = self.nursery();
        self.let_out(&mut flows, &mut orders, step);
        self.hold(&mut orders, &mut nursery);
        self.lead(&mut flows, &mut orders, &mut nursery, step);
        let (next_id, mut born) = (nursery.next_id, nursery.born);
        self.state.flows = flows;
        self.state.next_id = next_id;
        for particle in &born {
            self.state.water.inflow.add(particle.volume);
            self.state.momentum.book(DENSITY * particle.volume * (particle.u + particle.v));
        }
        self.carry_out(&orders);
        self.state.particles.append(&mut born);
        !orders.out.is_empty()
    }

    fn let_out(&self, flows: &mut Flows, orders: &mut Orders, step: f64) {
        let water = self.sampler(0.0);
        for (outflow, flow) in self.structures.outflows.iter().zip(&mut flows.outflows) {
            flow.discharge = outflow.zone.level(&water).map_or(0.0, |level| outflow.rating.at(level));
            flow.owed += flow.discharge * step;
            let taken = orders.take(flow, &outflow.zone, &water, self.volume);
            orders.out.extend(taken);
        }
    }

    /// Adds and takes water where it is to stand at a level.
    fn hold(&self, orders: &mut Orders, nursery: &mut Nursery) {
        let water = self.sampler(0.0);
        for held in &self.structures.held {
            let missing = held.zone.missing(held.level.at(self.state.time), &water);
            for _ in 0..((missing / self.volume + 1.0 - HELD_TO).floor().max(0.0) as usize) {
                nursery.bear_in_flow(&held.zone);
            }
            let excess = -missing - HELD_TO * self.volume;
            if excess > 0.0 {
                let mut flow = Flow { owed: excess + self.volume, discharge: 0.0 };
                let taken = orders.take(&mut flow, &held.zone, &water, 0.0);
                orders.out.extend(taken);
            }
        }
    }

    fn lead(&self, flows: &mut Flows, orders: &mut Orders, nursery: &mut Nursery, step: f64) {
        let water = self.sampler(0.0);
        let gravity = self.settings.gravity_m_per_s2;
        for (link, flow) in self.structures.links.iter().zip(&mut flows.links) {
            flow.discharge = link.discharge(&water, gravity);
            flow.owed += flow.discharge * step;
            let [from, to] = if flow.owed >= 0.0 { [0, 1] } else { [1, 0] };
            let mut forward = Flow { owed: flow.owed.abs(), ..*flow };
            for number in orders.take(&mut forward, &link.ends[from], &water, self.volume) {
                // Each particle has another place in each step, whatever the order of the particles.
                let stream = water.particles[number].id | self.state.steps << 32;
                let place = nursery.place(&link.ends[to], stream);
                orders.moved.push((number, place));
            }
            flow.owed = forward.owed.copysign(flow.owed);
        }
    }

    /// What is led elsewhere comes out at rest.
    fn carry_out(&mut self, orders: &Orders) {
        let particles = &mut self.state.particles;
        let momentum = &mut self.state.momentum;
        for &number in &orders.out {
            let particle = &mut particles[number];
            self.state.water.outflow.add(particle.volume);
            momentum.book(-DENSITY * particle.volume * (particle.u + particle.v));
            particle.volume = 0.0;
        }
        for &(number, [x, y]) in &orders.moved {
            let particle = &mut particles[number];
            momentum.book(-DENSITY * particle.volume * (particle.u + particle.v));
            [particle.x, particle.y] = [x, y];
            [particle.u, particle.v, particle.ax, particle.ay] = [0.0; 4];
        }
    }

    /// For new particles, with places by the water as it was arranged.
    pub(super) fn nursery(&self) -> Nursery<'_> {
        Nursery {
            // Particles have drifted since they were arranged, which matters little to where there is a gap.
            water: self.sampler(0.0),
            edges: &self.surroundings.edges,
            volume: self.volume,
            spacing: self.spacing,
            h: self.h,
            seed: self.seed,
            next_id: self.state.next_id,
            born: Vec::new(),
        }
    }
}

impl Orders {
    /// Takes particles out of `zone` for what `flow` owes, the highest first. Where there are none, it goes on owing `most` m3 at
    /// most.
    fn take(&mut self, flow: &mut Flow, zone: &Zone, water: &Sampler, most: f64) -> Vec<usize> {
        let mut here = zone.particles(water);
        here.retain(|number| !self.taken.contains(number));
        let surface = |number: usize| water.particles[number].surface();
        here.sort_by(|&a, &b| {
            surface(b).total_cmp(&surface(a)).then(water.particles[a].id.cmp(&water.particles[b].id))
        });
        let mut taken = Vec::new();
        for number in here {
            let volume = water.particles[number].volume;
            if flow.owed < volume {
                return taken;
            }
            flow.owed -= volume;
            self.taken.insert(number);
            taken.push(number);
        }
        flow.owed = flow.owed.min(most);
        taken
    }
}

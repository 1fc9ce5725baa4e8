//! Air that comes in by inlets, layer by layer.

use super::{before_inlet, placed, slowest};
use crate::air::Particle;
use crate::inventory::Inventory;
use crate::room::{Face, Inflow};

impl Inventory<'_> {
    /// Lets air come in by all inlets.
    pub(super) fn let_in(&mut self, step: f64) {
        for axis in 0..3 {
            for side in 0..2 {
                if let Face::Inlet(inflow) = self.room.faces[axis][side] {
                    self.add_layers(axis, side, inflow, step);
                }
            }
        }
    }

    /// Adds a layer before an inlet as soon as there is room for it: of the air that comes in when the layer reaches the face.
    fn add_layers(&mut self, axis: usize, side: usize, inflow: Inflow, step: f64) {
        let counts = self.room.counts(self.scale.spacing);
        let apart = self.room.apart(self.scale.spacing);
        self.state.inlet_phase[axis][side] += inflow.velocity[axis].abs() * step;
        while self.state.inlet_phase[axis][side] >= apart[axis] {
            self.state.inlet_phase[axis][side] -= apart[axis];
            let behind = before_inlet(self.scale.h(), apart[axis]) - self.state.inlet_phase[axis][side];
            let reached = self.state.time + step + behind / inflow.velocity[axis].abs();
            let over_time = self.inflows[axis][side].as_ref();
            let [temperature, vapour] = over_time.map_or([inflow.temperature, inflow.vapour], |own| own.at(reached));
            let others = [(axis + 1) % 3, (axis + 2) % 3];
            for b in 0..counts[others[1]] {
                for a in 0..counts[others[0]] {
                    let mut position = [0.0; 3];
                    position[axis] = [self.room.low[axis] - behind, self.room.high[axis] + behind][side];
                    for (other, index) in others.into_iter().zip([a, b]) {
                        position[other] = self.room.low[other] + (index as f64 + 0.5) * apart[other];
                    }
                    let particle = Particle::new(self.state.next_id, position, temperature, vapour);
                    self.state.next_id += 1;
                    if self.owns(position) {
                        let particle = placed(particle, self.room, slowest(self.air));
                        self.state.air.push(Particle { temperature, vapour, ..particle });
                    }
                }
            }
        }
    }
}

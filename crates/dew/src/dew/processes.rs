//! The model on several processes: each has a part of the air.

use super::Dew;
use corpuscle_model::{Account, ExactSum};
use corpuscle_processes::STEPS_BETWEEN_BALANCING;

impl Dew {
    /// From here on the other processes wait for commands of the first, whose model is called: see
    /// [`Processes::follow`](corpuscle_processes::Processes::follow).
    pub fn lead(&mut self) {
        if let Some(domain) = &mut self.domain {
            domain.lead(&self.processes);
        }
    }

    /// Whether what is at a position is computed by this process.
    pub(crate) fn owns(&self, position: [f64; 3]) -> bool {
        self.domain.as_ref().is_none_or(|domain| domain.owns(position))
    }

    /// Distributes the air over the processes as it stands, and fills the halo, whose velocities are taken `ahead` s on.
    pub(super) fn share_air(&mut self, ahead: f64) {
        if let Some(domain) = &mut self.domain {
            domain.share(&self.processes, &mut self.state.air, &self.room, self.scale.h(), ahead);
        }
    }

    /// Particles of air of all processes.
    pub(super) fn air_count(&self) -> usize {
        self.domain.as_ref().map_or(self.state.air.len(), |domain| domain.air[0])
    }

    /// Particles of air in the room, of all processes.
    pub(crate) fn inside_count(&self) -> usize {
        self.domain.as_ref().map_or_else(|| self.inside().count(), |domain| domain.air[1])
    }

    /// Moves tiles to other processes where the work is distributed too unevenly; looks at it every so many steps.
    pub(super) fn balance_if_due(&mut self) {
        if self.state.steps.is_multiple_of(STEPS_BETWEEN_BALANCING) {
            self.balance();
        }
    }

    /// Moves tiles to other processes where the work is distributed too unevenly.
    pub(super) fn balance(&mut self) {
        if let Some(domain) = &mut self.domain {
            domain.balance(&self.processes, &self.state.air, &self.room, self.scale.h());
        }
    }

    /// Keeps of the whole air, which all processes have, the part of this one.
    pub(crate) fn keep_part(&mut self) {
        let Some(domain) = &mut self.domain else { return };
        domain.keep_part(&mut self.state.air, &self.room, self.scale.h());
        // What was booked stands at the first process.
        if !self.processes.is_first() {
            for account in [&mut self.state.water, &mut self.state.energy] {
                *account = Account { initial: account.initial, ..Account::default() };
            }
            self.state.fogged = ExactSum::default();
        }
    }

    /// The accounts of water and energy, and the fog that has formed, of all processes.
    pub(crate) fn booked(&self) -> ([Account; 2], ExactSum) {
        let (mut accounts, mut fogged) = ([self.state.water, self.state.energy], self.state.fogged);
        let of_accounts = accounts.iter_mut().flat_map(|account| [&mut account.inflow, &mut account.outflow]);
        self.processes.total(&mut [], &mut of_accounts.chain([&mut fogged]).collect::<Vec<_>>());
        (accounts, fogged)
    }
}

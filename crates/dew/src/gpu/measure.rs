//! Values of gauges, without download of the air.

use super::GpuSolver;
use crate::measures::Totals;
use crate::origin::Origin;
use crate::shared::{self, MEASURING_GROUPS};
use crate::state::State;
use corpuscle_gpu::{GpuError, read, submit};

impl GpuSolver {
    /// Values of gauges of the air as a whole. Those of solids are set in `state`.
    pub async fn measure(&self, state: &mut State) -> Result<Totals, GpuError> {
        submit(self.batches.gpu(), "gauges", None, |pass| self.tasks.measure.run(pass, MEASURING_GROUPS));
        let groups: Vec<shared::Measured> =
            read(self.batches.gpu(), &self.tasks.memory.measured, MEASURING_GROUPS as usize).await?;
        self.download_solids(state).await?;
        Ok(totals(&groups, self.origin))
    }
}

fn totals(groups: &[shared::Measured], ambient: Origin) -> Totals {
    let count = groups.iter().map(|group| f64::from(group.count)).sum();
    let sum = |of: fn(&shared::Measured) -> f32| groups.iter().map(|group| f64::from(of(group))).sum::<f64>();
    Totals {
        count,
        temperature: count * ambient.temperature + sum(|group| group.temperature),
        vapour: count * ambient.vapour + sum(|group| group.vapour),
        fog: sum(|group| group.fog),
        fastest: f64::from(groups.iter().map(|group| group.fastest).fold(0.0, f32::max)).sqrt(),
    }
}

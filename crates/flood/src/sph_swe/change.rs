//! Live changes of a flood of scheme sph-swe: what is changed while it runs.
//!
//! A change holds from the end of the last step on, at most one step before the time shown. What comes by it is booked as all other water is.

use super::SphSweFlood;
use crate::LiveChange;
use crate::error::setup;
use crate::series::load;
use corpuscle_model::ModelError;
use corpuscle_scene::{Manning, Series, SphSwe, Table};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// What was changed live so far.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Overrides {
    /// Discharges of inflows as they are now: the inflow, and rows of time, s, and m3/s.
    discharges: Vec<(usize, Vec<[f64; 2]>)>,
    manning: Option<f64>,
    control: Option<bool>,
    /// Gauges that were placed: names, and positions in model coordinates.
    pub gauges: Vec<(String, [f64; 2])>,
}

impl SphSweFlood {
    pub(crate) fn change_live(&mut self, change: LiveChange) -> Result<(), ModelError> {
        change.check()?;
        match change {
            LiveChange::Discharge { inflow, discharge } => self.put(inflow, |now, _| vec![[now, discharge]])?,
            LiveChange::DischargeTimes { inflow, times } => self.put(inflow, |now, written| {
                let later = written.rows().iter().filter(|[time, _]| *time > now);
                let rows = std::iter::once([now, written.at(now)]).chain(later.copied());
                rows.map(|[time, value]| [time, times * value]).collect()
            })?,
            LiveChange::Manning(n) => {
                let rest = self.roughness.rest().ok_or_else(|| {
                    setup("the roughness comes from a raster, or friction from another law than Manning's: it changes on restart")
                })?;
                *rest = n;
                self.state.overrides.manning = Some(n);
            }
            LiveChange::ControlForce(on) => {
                self.solver.control(on);
                self.state.overrides.control = Some(on);
            }
            LiveChange::Rain(_)
            | LiveChange::RainTimes(_)
            | LiveChange::Level { .. }
            | LiveChange::EdgeLevel { .. } => {
                return Err(setup("rain and held levels are for scheme voronoi"));
            }
        }
        self.update_gpu()
    }

    /// Gives an inflow another discharge from now on, by the time and what the scene says.
    fn put(&mut self, inflow: usize, rows: impl FnOnce(f64, &Table) -> Vec<[f64; 2]>) -> Result<(), ModelError> {
        let now = self.state.time;
        let source = self.sources.get(inflow).ok_or_else(|| setup(format!("there is no inflow {inflow}")))?;
        let written = self.written.iter().find(|(of, _)| *of == inflow).map_or(&source.discharge, |(_, table)| table);
        let mut whole = vec![[now, before(&source.discharge, now)]];
        whole.extend(rows(now, written));
        let changed = load(&Series::Table(whole.clone()), Path::new(""))?;
        self.replace(inflow, changed);
        self.state.overrides.discharges.retain(|(of, _)| *of != inflow);
        self.state.overrides.discharges.push((inflow, whole));
        Ok(())
    }

    /// Puts another table in the place of a discharge, and remembers what the scene says.
    fn replace(&mut self, inflow: usize, table: Table) {
        let Some(source) = self.sources.get_mut(inflow) else { return };
        let written = std::mem::replace(&mut source.discharge, table);
        if self.written.iter().all(|(of, _)| *of != inflow) {
            self.written.push((inflow, written));
        }
    }

    /// All is as the scene says again.
    pub(super) fn clear_overrides(&mut self) {
        for (inflow, written) in std::mem::take(&mut self.written) {
            self.sources[inflow].discharge = written;
        }
        if let (Some(rest), Manning::Number(n)) = (self.roughness.rest(), &self.settings.manning) {
            *rest = *n;
        }
        self.solver.control(self.settings.sph_swe.control_force);
        self.state.overrides = Overrides::default();
    }

    /// All is as the state's overrides say.
    pub(super) fn apply_overrides(&mut self) -> Result<(), ModelError> {
        let overrides = self.state.overrides.clone();
        for (inflow, rows) in overrides.discharges {
            let table = load(&Series::Table(rows), Path::new(""))?;
            self.replace(inflow, table);
        }
        if let (Some(n), Some(rest)) = (overrides.manning, self.roughness.rest()) {
            *rest = n;
        }
        if let Some(on) = overrides.control {
            self.solver.control(on);
        }
        Ok(())
    }

    /// The parameters of the scheme as they are now.
    #[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "only the GPU needs them"))]
    pub(super) fn parameters(&self) -> SphSwe {
        let written = &self.settings.sph_swe;
        SphSwe { control_force: self.state.overrides.control.unwrap_or(written.control_force), ..written.clone() }
    }

    /// Uploads the changed state and parameters to a GPU that takes the steps.
    pub(super) fn update_gpu(&mut self) -> Result<(), ModelError> {
        #[cfg(feature = "gpu")]
        if let Some(on_gpu) = &self.on_gpu {
            let gpu = on_gpu.gpu().clone();
            self.open_gpu(gpu).map_err(|error| super::gpu::failed(&error))?;
        }
        Ok(())
    }
}

/// The value just before a time: at a jump the one before it.
fn before(table: &Table, time: f64) -> f64 {
    let at_jump = table.rows().iter().find(|row| row[0] == time);
    at_jump.map_or_else(|| table.at(time), |row| row[1])
}

//! Live changes of a flood of scheme voronoi.
//!
//! A change holds from the end of the last step on. The water that it adds or removes is booked as all other water.

use super::VoronoiFlood;
use super::boundaries::Boundary;
use super::friction::Slowing;
use super::rain::Weather;
use crate::LiveChange;
use crate::error::setup;
use crate::extent::span;
use crate::series::load;
use corpuscle_model::ModelError;
use corpuscle_scene::{Manning, Series, Table};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// A value over time that can be changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Over {
    Discharge(usize),
    Level(usize),
    Edge(usize),
    Rain,
}

/// What was changed so far.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Overrides {
    /// Values over time as they are now: rows of time, s, and value.
    series: Vec<(Over, Vec<[f64; 2]>)>,
    manning: Option<f64>,
    /// Whether it rains only because of a change.
    weather: bool,
    /// Gauges that were placed: names, and positions in model coordinates.
    pub gauges: Vec<(String, [f64; 2])>,
}

impl VoronoiFlood {
    /// Changes the flood from the end of the last step on.
    ///
    /// # Errors
    /// [`ModelError::Setup`] where it has nothing of the kind, or the number is out of range: nothing has changed then.
    pub fn change(&mut self, change: LiveChange) -> Result<(), ModelError> {
        change.check()?;
        self.refuse_on_several()?;
        let done = self.apply(change);
        #[cfg(feature = "gpu")]
        self.mark_stale_on_gpu();
        done
    }

    fn apply(&mut self, change: LiveChange) -> Result<(), ModelError> {
        match change {
            LiveChange::Discharge { inflow, discharge } => self.set(Over::Discharge(inflow), discharge),
            LiveChange::DischargeTimes { inflow, times } => self.multiply(Over::Discharge(inflow), times),
            LiveChange::Level { stage, level } => self.set(Over::Level(stage), level),
            LiveChange::EdgeLevel { side, level } => self.set(Over::Edge(side), level),
            LiveChange::Rain(rain) => {
                self.let_it_rain()?;
                self.set(Over::Rain, rain)
            }
            LiveChange::RainTimes(times) => {
                self.let_it_rain()?;
                self.multiply(Over::Rain, times)
            }
            LiveChange::Manning(n) => self.set_manning(n),
            LiveChange::ControlForce(_) => Err(setup("only scheme sph-swe has a control force")),
        }
    }

    /// Places a gauge at a point in model coordinates: depth, level and velocity are measured there from now on, in columns after all
    /// others.
    ///
    /// # Errors
    /// [`ModelError::Setup`] where another gauge has the name, or the position lies outside the terrain.
    pub fn place_gauge(&mut self, name: &str, at: [f64; 2]) -> Result<(), ModelError> {
        self.refuse_on_several()?;
        if !self.terrain.bounds().contains(at[0], at[1]) {
            let spans = span(&self.terrain);
            return Err(setup(format!("the gauge '{name}' lies outside the terrain, which spans {spans}")));
        }
        let placed = &mut self.state.overrides.gauges;
        let known = self.points.iter().map(|point| &point.name).chain(placed.iter().map(|(name, _)| name));
        if known.into_iter().any(|known| known == name) {
            return Err(setup(format!("there is a gauge '{name}' already: give the new one another name")));
        }
        placed.push((name.into(), at));
        Ok(())
    }

    /// Refuses changes where several processes compute the flood.
    fn refuse_on_several(&self) -> Result<(), ModelError> {
        if self.solver.domain.is_some() {
            return Err(setup("a flood that several processes compute cannot be changed while it runs"));
        }
        Ok(())
    }

    fn set_manning(&mut self, n: f64) -> Result<(), ModelError> {
        let rest = self.roughness.rest().ok_or_else(|| {
            setup(
                "the roughness comes from a raster, or friction from another law than Manning's: it changes on restart",
            )
        })?;
        *rest = n;
        let gravity = self.solver.gravity;
        let mut slowing = Slowing::of(&self.roughness, gravity);
        slowing.extend(&self.roughness, gravity, &self.solver.mesh.centroid);
        self.solver.slowing = slowing;
        self.state.overrides.manning = Some(n);
        Ok(())
    }

    /// A value is this from now on.
    fn set(&mut self, over: Over, value: f64) -> Result<(), ModelError> {
        self.put(over, |now, _| vec![[now, value]])
    }

    /// Multiplies a value of the scene by a factor from now on.
    fn multiply(&mut self, over: Over, times: f64) -> Result<(), ModelError> {
        self.put(over, |now, written| {
            let later = written.rows().iter().filter(|[time, _]| *time > now);
            let rows = std::iter::once([now, written.at(now)]).chain(later.copied());
            rows.map(|[time, value]| [time, times * value]).collect()
        })
    }

    /// Gives a value over time other rows from now on, by the time and what the scene says.
    fn put(&mut self, over: Over, rows: impl FnOnce(f64, &Table) -> Vec<[f64; 2]>) -> Result<(), ModelError> {
        let now = self.state.time;
        let table = self.series(over).cloned().ok_or_else(|| setup(missing(over)))?;
        let written = self.written.iter().find(|(of, _)| *of == over).map_or(&table, |(_, table)| table);
        let jump = table.rows().iter().find(|row| row[0] == now);
        let mut whole = vec![[now, jump.map_or_else(|| table.at(now), |row| row[1])]];
        whole.extend(rows(now, written));
        let changed = load(&Series::Table(whole.clone()), Path::new(""))?;
        self.replace(over, changed);
        self.state.overrides.series.retain(|(of, _)| *of != over);
        self.state.overrides.series.push((over, whole));
        Ok(())
    }

    fn series(&mut self, over: Over) -> Option<&mut Table> {
        match over {
            Over::Discharge(number) => self.inflows.get_mut(number).map(|inflow| &mut inflow.discharge),
            Over::Level(number) => self.structures.held.get_mut(number).map(|held| &mut held.level),
            Over::Edge(side) => match self.boundaries.rules.get_mut(side)? {
                Boundary::Level(level) => Some(level),
                _ => None,
            },
            Over::Rain => self.weather.as_mut()?.table().ok(),
        }
    }

    /// Puts another table in the place of a value over time, and remembers what the scene says.
    fn replace(&mut self, over: Over, table: Table) {
        let Some(slot) = self.series(over) else { return };
        let written = std::mem::replace(slot, table);
        if self.written.iter().all(|(of, _)| *of != over) {
            self.written.push((over, written));
        }
    }

    /// Sees to it that there is ground on which it can rain.
    fn let_it_rain(&mut self) -> Result<(), ModelError> {
        if self.weather.is_none() {
            self.weather = Some(Weather::without_rain());
            self.state.overrides.weather = true;
        }
        if let Some(weather) = &mut self.weather {
            weather.table()?;
        }
        self.make_all_tiles()
    }

    /// All is as the scene says again.
    pub(super) fn clear_overrides(&mut self) {
        for (over, written) in std::mem::take(&mut self.written) {
            if let Some(slot) = self.series(over) {
                *slot = written;
            }
        }
        if self.state.overrides.weather {
            self.weather = None;
        }
        if let (Some(_), Manning::Number(n)) = (self.state.overrides.manning, &self.settings.manning) {
            let _ = self.set_manning(*n);
        }
        self.state.overrides = Overrides::default();
    }

    /// All is as the state's overrides say.
    pub(super) fn apply_overrides(&mut self) -> Result<(), ModelError> {
        let overrides = self.state.overrides.clone();
        if overrides.weather || overrides.series.iter().any(|(over, _)| *over == Over::Rain) {
            let only = overrides.weather;
            self.let_it_rain()?;
            self.state.overrides.weather = only;
        }
        for (over, rows) in overrides.series {
            let table = load(&Series::Table(rows), Path::new(""))?;
            self.replace(over, table);
        }
        overrides.manning.map_or(Ok(()), |n| self.set_manning(n))
    }
}

fn missing(over: Over) -> String {
    match over {
        Over::Discharge(number) => format!("there is no inflow {number}"),
        Over::Level(number) => format!("there is no stage {number}"),
        Over::Edge(side) => {
            let sides = ["west", "east", "south", "north"];
            format!("the side {} is held at no level", sides.get(side).unwrap_or(&"that is meant"))
        }
        Over::Rain => "it cannot rain here".into(),
    }
}

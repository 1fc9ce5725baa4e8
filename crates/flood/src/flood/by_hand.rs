//! What a hand changes of a flood while it runs.
//!
//! A change holds from the end of the last step on, at most one step before the time shown. What comes and goes by it is booked as all
//! other water is.

use super::weather::widest;
use super::{Flood, State};
use crate::as_flood_mut;
use crate::edges::EdgeRule;
use crate::rain::{Ground, Intensity, Wetness};
use crate::setup::{load, setup};
use corpuscle_model::ModelError;
use corpuscle_scene::{Series, SphSwe, Table};
use serde::{Deserialize, Serialize};
use std::any::Any;
use std::path::Path;

/// A change of a flood that runs. Inflows and stages are counted as in the scene, from 0; sides are 0 west, 1 east, 2 south, 3 north.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ByHand {
    /// An inflow brings so much from now on.
    Discharge {
        /// The inflow.
        inflow: usize,
        /// Discharge, m3/s, 0 or more.
        discharge: f64,
    },
    /// An inflow brings so many times what the scene says, now and later.
    DischargeTimes {
        /// The inflow.
        inflow: usize,
        /// The factor, 0 or more.
        times: f64,
    },
    /// It rains so hard from now on, mm/h, 0 or more; also where the scene has no rain.
    Rain(f64),
    /// It rains so many times as hard as the scene says, now and later; 0 or more.
    RainTimes(f64),
    /// A stage is held at another level from now on.
    Level {
        /// The stage.
        stage: usize,
        /// Level, m.
        level: f64,
    },
    /// An edge that is held at a level is held at another from now on.
    EdgeLevel {
        /// The side.
        side: usize,
        /// Level, m.
        level: f64,
    },
    /// Manning's n, s/m^(1/3), 0 or more, where no kind of ground has its own.
    Manning(f64),
    /// The control force of scheme sph-swe is on or off.
    ControlForce(bool),
}

/// A value over time that can be changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Over {
    Discharge(usize),
    Level(usize),
    Edge(usize),
    Rain,
}

/// What a hand has changed so far.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Hand {
    /// Values over time as they are now: rows of time, s, and value.
    series: Vec<(Over, Vec<[f64; 2]>)>,
    manning: Option<f64>,
    control: Option<bool>,
    /// Whether it rains by hand alone.
    ground: bool,
    /// Gauges that were placed: names, and places in model coordinates.
    pub gauges: Vec<(String, [f64; 2])>,
}

impl ByHand {
    /// Changes a model that is a flood.
    ///
    /// # Errors
    /// [`ModelError::Setup`] where it is none, has nothing of the kind, or the number is out of range: nothing has changed then.
    /// [`ModelError::Device`] where a graphics card takes the steps and cannot go on with the change.
    pub fn change(self, model: &mut dyn Any) -> Result<(), ModelError> {
        match as_flood_mut(model) {
            Some(flood) => flood.change(self),
            None => Err(setup("this model is no flood")),
        }
    }

    /// Refuses numbers that cannot be.
    pub(crate) fn check(self) -> Result<(), ModelError> {
        let (value, what, least) = match self {
            Self::Discharge { discharge, .. } => (discharge, "a discharge", 0.0),
            Self::DischargeTimes { times, .. } => (times, "the factor of a discharge", 0.0),
            Self::Rain(rain) => (rain, "rain", 0.0),
            Self::RainTimes(times) => (times, "the factor of rain", 0.0),
            Self::Manning(n) => (n, "Manning's n", 0.0),
            Self::Level { level, .. } | Self::EdgeLevel { level, .. } => (level, "a level", f64::MIN),
            Self::ControlForce(_) => return Ok(()),
        };
        if value.is_finite() && value >= least {
            return Ok(());
        }
        let range = if least == 0.0 { "0 or more" } else { "a finite number" };
        Err(setup(format!("{what} must be {range}, not {value}")))
    }
}

impl Flood {
    pub(crate) fn change_by_hand(&mut self, change: ByHand) -> Result<(), ModelError> {
        change.check()?;
        match change {
            ByHand::Discharge { inflow, discharge } => self.stay(Over::Discharge(inflow), discharge)?,
            ByHand::DischargeTimes { inflow, times } => self.multiply(Over::Discharge(inflow), times)?,
            ByHand::Rain(rain) => {
                self.have_ground()?;
                self.stay(Over::Rain, rain)?;
            }
            ByHand::RainTimes(times) => {
                self.have_ground()?;
                self.multiply(Over::Rain, times)?;
            }
            ByHand::Level { stage, level } => self.stay(Over::Level(stage), level)?,
            ByHand::EdgeLevel { side, level } => self.stay(Over::Edge(side), level)?,
            ByHand::Manning(n) => {
                let rest = self.roughness.rest().ok_or_else(|| {
                    setup("the roughness comes from a raster, or friction from another law than Manning's: it changes on restart")
                })?;
                *rest = n;
                self.state.hand.manning = Some(n);
            }
            ByHand::ControlForce(on) => {
                if !self.scheme.control(on) {
                    return Err(setup("only scheme sph-swe has a control force"));
                }
                self.state.hand.control = Some(on);
            }
        }
        self.renew_card()
    }

    /// A value stays at this from now on.
    fn stay(&mut self, over: Over, value: f64) -> Result<(), ModelError> {
        self.put(over, |now, _| vec![[now, value]])
    }

    /// A value is from now on so many times what the scene says.
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
        // Rain comes once in some steps: what is still to be booked fell as it was before.
        let since = if over == Over::Rain { self.state.wetness.until } else { now };
        let table = self.series(over).cloned().ok_or_else(|| setup(missing(over)))?;
        let written = self.before_hand.iter().find(|(of, _)| *of == over).map_or(&table, |(_, table)| table);
        let mut whole = vec![[since, table.at(since)]];
        whole.extend(table.rows().iter().filter(|[time, _]| since < *time && *time < now));
        whole.push([now, before(&table, now)]);
        whole.extend(rows(now, written));
        let changed = load(&Series::Table(whole.clone()), Path::new(""))?;
        self.replace(over, changed);
        self.state.hand.series.retain(|(of, _)| *of != over);
        self.state.hand.series.push((over, whole));
        Ok(())
    }

    fn series(&mut self, over: Over) -> Option<&mut Table> {
        match over {
            Over::Discharge(number) => self.sources.get_mut(number).map(|source| &mut source.discharge),
            Over::Level(number) => self.structures.held.get_mut(number).map(|held| &mut held.level),
            Over::Edge(side) => match self.surroundings.edges.rules.get_mut(side)? {
                EdgeRule::Stage(level) => Some(level),
                _ => None,
            },
            Over::Rain => match &mut self.ground.as_mut()?.intensity {
                Intensity::Table(intensity) => Some(intensity),
                Intensity::None | Intensity::Function(_) => None,
            },
        }
    }

    /// Puts another table in the place of a value over time, and remembers what the scene says.
    fn replace(&mut self, over: Over, table: Table) {
        let Some(place) = self.series(over) else { return };
        let written = std::mem::replace(place, table);
        if self.before_hand.iter().all(|(of, _)| *of != over) {
            self.before_hand.push((over, written));
        }
    }

    /// Sees to it that there is ground on which it can rain.
    fn have_ground(&mut self) -> Result<(), ModelError> {
        if self.ground.is_none() {
            self.state.hand.ground = true;
            let ground = self.new_ground();
            self.state.wetness = Wetness { until: self.state.time, ..ground.dry() };
            self.ground = Some(ground);
        }
        self.let_rain_change()
    }

    fn new_ground(&self) -> Ground {
        let widest = widest(&self.settings, self.spacing, self.refinement.as_ref());
        Ground::without_rain(&self.surroundings.terrain, self.volume, widest)
    }

    /// Ground without rain has rain of 0 mm/h.
    fn let_rain_change(&mut self) -> Result<(), ModelError> {
        let Some(ground) = &mut self.ground else { return Ok(()) };
        match ground.intensity {
            Intensity::None => ground.intensity = Intensity::Table(load(&Series::Constant(0.0), Path::new(""))?),
            Intensity::Table(_) => {}
            Intensity::Function(_) => return Err(setup("rain by a function cannot be changed")),
        }
        Ok(())
    }

    /// Whether a state's ground is this flood's, or one on which it rains by hand alone.
    pub(super) fn grounds_fit(&self, state: &State) -> bool {
        let own = self.ground.as_ref().filter(|_| !self.state.hand.ground);
        match own {
            Some(ground) => ground.fits(&state.wetness),
            None => !state.hand.ground || self.new_ground().fits(&state.wetness),
        }
    }

    /// All is as the scene says again.
    pub(super) fn take_back_hand(&mut self) {
        for (over, written) in std::mem::take(&mut self.before_hand) {
            if let Some(place) = self.series(over) {
                *place = written;
            }
        }
        if self.state.hand.ground {
            self.ground = None;
        }
        if let (Some(rest), corpuscle_scene::Manning::Number(n)) = (self.roughness.rest(), &self.settings.manning) {
            *rest = *n;
        }
        self.scheme.control(self.settings.sph_swe.control_force);
        self.state.hand = Hand::default();
    }

    /// All is as the state's hand changed it.
    pub(super) fn take_hand(&mut self) -> Result<(), ModelError> {
        let hand = self.state.hand.clone();
        if hand.ground {
            self.ground = Some(self.new_ground());
        }
        if hand.series.iter().any(|(over, _)| *over == Over::Rain) {
            self.let_rain_change()?;
        }
        for (over, rows) in hand.series {
            let table = load(&Series::Table(rows), Path::new(""))?;
            self.replace(over, table);
        }
        if let (Some(n), Some(rest)) = (hand.manning, self.roughness.rest()) {
            *rest = n;
        }
        if let Some(on) = hand.control {
            self.scheme.control(on);
        }
        Ok(())
    }

    /// The parameters of scheme sph-swe as they are now.
    #[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "the card asks for them"))]
    pub(super) fn sph_swe(&self) -> SphSwe {
        let written = &self.settings.sph_swe;
        SphSwe { control_force: self.state.hand.control.unwrap_or(written.control_force), ..written.clone() }
    }

    /// A card that takes the steps gets to know what has changed.
    pub(super) fn renew_card(&mut self) -> Result<(), ModelError> {
        #[cfg(feature = "gpu")]
        if let Some(card) = &self.card {
            let gpu = card.gpu();
            self.open_card(gpu).map_err(|error| super::on_card::failed(&error))?;
        }
        Ok(())
    }
}

/// The value just before a time: at a jump the one before it.
fn before(table: &Table, time: f64) -> f64 {
    let at_jump = table.rows().iter().find(|row| row[0] == time);
    at_jump.map_or_else(|| table.at(time), |row| row[1])
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

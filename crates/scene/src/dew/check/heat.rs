//! Checks of what heats and cools solids: `heater`, `outside` and `radiation` of `[[dew.solid]]`.

use super::solids::HOTTEST;
use crate::check::{Check, Checked};
use crate::dew::{Dew, Face, Heater, Outside, Solid, WallLayer};
use crate::{Axis, Series};

impl Check {
    pub(super) fn heat_sources(&self, key: &str, dew: &Dew, solid: &Solid) -> Checked {
        let given = [
            ("heater", solid.heater.is_some()),
            ("outside", solid.outside.is_some()),
            ("radiation", solid.radiation.is_some()),
        ];
        for (name, _) in given.into_iter().filter(|(_, is_given)| *is_given) {
            self.require(&format!("{key}.{name}"), !solid.held, || {
                "has no effect: the temperature of this solid is prescribed; leave out held = true, or this".into()
            })?;
        }
        if let Some(heater) = &solid.heater {
            self.heater(&format!("{key}.heater"), heater)?;
        }
        if let Some(outside) = &solid.outside {
            self.outside(&format!("{key}.outside"), dew, outside)?;
        }
        if let Some(radiation) = &solid.radiation {
            let key = format!("{key}.radiation");
            self.emissivity(&key, radiation.emissivity)?;
            self.temperature_of_surroundings(&format!("{key}.surroundings_c"), &radiation.surroundings_c)?;
        }
        Ok(())
    }

    fn heater(&self, key: &str, heater: &Heater) -> Checked {
        let powers = [("power_w", &heater.power_w), ("power_w_per_m2", &heater.power_w_per_m2)];
        self.exactly_one(key, &powers.map(|(name, power)| (name, power.is_some())))?;
        for (name, power) in powers {
            if let Some(power) = power {
                let key = format!("{key}.{name}");
                self.series(&key, power)?;
                self.each_value(&key, power, |key, watts| self.at_least(key, watts, 0.0))?;
            }
        }
        Ok(())
    }

    fn outside(&self, key: &str, dew: &Dew, outside: &Outside) -> Checked {
        let [axis, end] = outside.side.axis_and_end();
        let is_wall = *dew.faces.along(Axis::ALL[axis])[end] == Face::Wall;
        self.require(&format!("{key}.side"), is_wall, || {
            format!(
                "is no wall: what is beyond it is air of the scene; give faces.{} = \"wall\", or another side",
                outside.side.key()
            )
        })?;
        self.temperature_of_surroundings(&format!("{key}.temperature_c"), &outside.temperature_c)?;
        self.at_least(&format!("{key}.h_w_per_m2_k"), outside.h_w_per_m2_k, 0.0)?;
        self.emissivity(key, outside.emissivity)?;
        for (row, layer) in outside.layers.iter().enumerate() {
            self.wall_layer(&format!("{key}.layers.{row}"), layer)?;
        }
        outside
            .surroundings_c
            .as_ref()
            .map_or(Ok(()), |series| self.temperature_of_surroundings(&format!("{key}.surroundings_c"), series))
    }

    fn wall_layer(&self, key: &str, layer: &WallLayer) -> Checked {
        let WallLayer { material, thickness_m, resistance_m2_k_per_w } = layer;
        let is_whole = match resistance_m2_k_per_w {
            None => material.is_some() && thickness_m.is_some(),
            Some(_) => material.is_none() && thickness_m.is_none(),
        };
        self.require(key, is_whole, || {
            "must have either material and thickness_m, or resistance_m2_k_per_w alone (a gap with air)".into()
        })?;
        if let Some(material) = material {
            self.material(&format!("{key}.material"), material)?;
        }
        for (name, value) in [("thickness_m", thickness_m), ("resistance_m2_k_per_w", resistance_m2_k_per_w)] {
            if let Some(value) = *value {
                self.above(&format!("{key}.{name}"), value, 0.0)?;
            }
        }
        Ok(())
    }

    fn emissivity(&self, key: &str, emissivity: f64) -> Checked {
        self.require(&format!("{key}.emissivity"), (0.0..=1.0).contains(&emissivity), || "must be from 0 to 1".into())
    }

    fn temperature_of_surroundings(&self, key: &str, series: &Series) -> Checked {
        self.series(key, series)?;
        self.each_value(key, series, |key, celsius| {
            self.not_below_absolute_zero(key, celsius)?;
            self.require(key, celsius <= HOTTEST, || format!("must be at most {HOTTEST}"))
        })
    }

    /// Checks the values that stand in the scene itself.
    pub(super) fn each_value(&self, key: &str, series: &Series, check: impl Fn(&str, f64) -> Checked) -> Checked {
        match series {
            Series::Constant(value) => check(key, *value),
            Series::Table(rows) => {
                rows.iter().enumerate().try_for_each(|(row, at)| check(&format!("{key}.{row}"), at[1]))
            }
            Series::File { .. } => Ok(()),
        }
    }
}

//! Checks of `[dew]`.

mod heat;
mod solids;

use crate::check::{Check, Checked, SIDES};
use crate::dew::{Air, AirInflow, Dew, Drops, Face, Fan, LowUtility, Transport, ZERO_CELSIUS};
use crate::{Axis, Series};

/// 0 K in °C.
const ABSOLUTE_ZERO: f64 = -ZERO_CELSIUS;

/// The formula for saturated vapour is meant for liquid water: Bolton (1980) fitted it from -30 to 35 °C.
const COLDEST_AIR: f64 = -100.0;
const WARMEST_AIR: f64 = 100.0;

/// Pressures at which air conducts heat the same whatever its pressure, and vapour diffuses as 1/p, Pa.
const LEAST_PRESSURE: f64 = 1e4;
const LARGEST_PRESSURE: f64 = 1e6;

/// More particles than this do not fit in the memory of usual machines.
const MOST_PARTICLES: f64 = 1e8;

impl Check {
    pub(crate) fn dew(&self, dew: &Dew) -> Checked {
        for (axis, &length) in dew.size_m.iter().enumerate() {
            self.above(&format!("dew.size_m.{axis}"), length, 0.0)?;
        }
        self.above("dew.spacing_m", dew.spacing_m, 0.0)?;
        let shortest = dew.size_m.iter().copied().fold(f64::INFINITY, f64::min);
        self.require("dew.spacing_m", dew.spacing_m <= shortest, || {
            format!("is wider than the box: give at most {shortest}, or a larger size_m")
        })?;
        let count = dew.size_m.iter().product::<f64>() / dew.spacing_m.powi(3);
        self.require("dew.spacing_m", count <= MOST_PARTICLES, || {
            format!("would make {count:.1e} particles of air; at most {MOST_PARTICLES:.0e} are possible")
        })?;
        self.at_least("dew.time_factor", dew.time_factor, 1.0)?;
        self.air(&dew.air)?;
        self.faces(dew)?;
        dew.fan.iter().enumerate().try_for_each(|(row, fan)| self.fan(&format!("dew.fan.{row}"), fan, dew))?;
        self.above("dew.boundary.colour_threshold", dew.boundary.colour_threshold, 0.0)?;
        self.above("dew.boundary.kappa", dew.boundary.kappa, 0.0)?;
        self.transport(&dew.transport)?;
        self.drops(&dew.drops)?;
        if let Some(low_utility) = &dew.low_utility {
            self.low_utility(low_utility)?;
        }
        self.solids(dew)
    }

    fn air(&self, air: &Air) -> Checked {
        self.air_temperature("dew.air.temperature_c", air.temperature_c)?;
        let given = [
            ("relative_humidity", air.relative_humidity.is_some()),
            ("dew_point_c", air.dew_point_c.is_some()),
            ("mixing_ratio", air.mixing_ratio.is_some()),
        ];
        self.exactly_one("dew.air", &given)?;
        self.humidity("dew.air", air.temperature_c, [air.relative_humidity, air.dew_point_c, air.mixing_ratio])?;
        self.require("dew.air.pressure_pa", (LEAST_PRESSURE..=LARGEST_PRESSURE).contains(&air.pressure_pa), || {
            format!(
                "must be from {LEAST_PRESSURE} to {LARGEST_PRESSURE}: it is in Pa, not in hPa; beyond, the laws of how air conducts do not hold"
            )
        })
    }

    /// A temperature is one that can be.
    fn not_below_absolute_zero(&self, key: &str, celsius: f64) -> Checked {
        self.require(key, celsius >= ABSOLUTE_ZERO, || {
            format!("is below absolute zero, {ABSOLUTE_ZERO} °C: temperatures are in °C, not in K")
        })
    }

    fn air_temperature(&self, key: &str, celsius: f64) -> Checked {
        self.not_below_absolute_zero(key, celsius)?;
        self.require(key, (COLDEST_AIR..=WARMEST_AIR).contains(&celsius), || {
            format!(
                "must be from {COLDEST_AIR} to {WARMEST_AIR}: what saturated vapour is like beyond is not known here"
            )
        })
    }

    /// Relative humidity, dew point and mixing ratio, where given, of air at a temperature.
    fn humidity(&self, key: &str, celsius: f64, [relative, dew_point, mixing]: [Option<f64>; 3]) -> Checked {
        if let Some(relative) = relative {
            let percent = if relative > 1.0 && relative <= 100.0 { "; it is not in percent" } else { "" };
            self.require(&format!("{key}.relative_humidity"), (0.0..=1.0).contains(&relative), || {
                format!("must be from 0 to 1{percent}")
            })?;
        }
        if let Some(dew_point) = dew_point {
            let key = format!("{key}.dew_point_c");
            self.air_temperature(&key, dew_point)?;
            self.require(&key, dew_point <= celsius, || {
                format!("is above the temperature of the air, {celsius} °C: such air would be fog already")
            })?;
        }
        if let Some(mixing) = mixing {
            self.require(&format!("{key}.mixing_ratio"), (0.0..1.0).contains(&mixing), || {
                "must be at least 0 and below 1: it is in kg of vapour for a kg of dry air, as in 0.01".into()
            })?;
        }
        Ok(())
    }

    fn faces(&self, dew: &Dew) -> Checked {
        for axis in Axis::ALL {
            let (names, faces) = (SIDES[axis.index()], dew.faces.along(axis));
            for side in [0, 1] {
                let key = format!("dew.faces.{}", names[side]);
                let alone = *faces[side] == Face::Periodic && *faces[1 - side] != Face::Periodic;
                self.require(&key, !alone, || {
                    format!("the opposite side must be periodic too: give {} = \"periodic\"", names[1 - side])
                })?;
                if let Face::Inflow(inflow) = faces[side] {
                    let inward = if side == 0 { 1.0 } else { -1.0 };
                    let speed = inward * inflow.velocity_m_per_s[axis.index()];
                    self.air_inflow(&format!("{key}.inflow"), &dew.air, inflow, speed)?;
                }
            }
        }
        Ok(())
    }

    /// Air that comes in, with this speed into the box.
    fn air_inflow(&self, key: &str, air: &Air, inflow: &AirInflow, speed: f64) -> Checked {
        self.require(&format!("{key}.velocity_m_per_s"), speed > 0.0, || {
            "must lead into the box through this side".into()
        })?;
        let humidity = [&inflow.relative_humidity, &inflow.dew_point_c, &inflow.mixing_ratio];
        let given = humidity.iter().filter(|measure| measure.is_some()).count();
        self.require(key, given <= 1, || "give at most one of relative_humidity, dew_point_c and mixing_ratio".into())?;
        let named = ["temperature_c", "relative_humidity", "dew_point_c", "mixing_ratio"];
        for (name, series) in named.into_iter().zip([&inflow.temperature_c].into_iter().chain(humidity)) {
            series.as_ref().map_or(Ok(()), |series| self.series(&format!("{key}.{name}"), series))?;
        }
        if let Some(temperature) = &inflow.temperature_c {
            self.each_value(&format!("{key}.temperature_c"), temperature, |key, celsius| {
                self.air_temperature(key, celsius)
            })?;
        }
        // What changes with the temperature is compared with it when the scene is opened.
        let celsius = match &inflow.temperature_c {
            None => air.temperature_c,
            Some(Series::Constant(celsius)) => *celsius,
            Some(_) => WARMEST_AIR,
        };
        for (measure, series) in humidity.into_iter().enumerate() {
            let Some(series) = series else { continue };
            self.each_value(key, series, |_, value| {
                let mut one = [None; 3];
                one[measure] = Some(value);
                self.humidity(key, celsius, one)
            })?;
        }
        Ok(())
    }

    /// A fan stands in the box, is no thinner than the spacing resolves, and blows.
    fn fan(&self, key: &str, fan: &Fan, dew: &Dew) -> Checked {
        for axis in 0..3 {
            let size = fan.size_m[axis];
            self.require(&format!("{key}.size_m.{axis}"), size >= dew.spacing_m, || {
                format!("must be at least spacing_m, {}: a thinner fan would miss the air", dew.spacing_m)
            })?;
            let middle = fan.position_m[axis];
            self.require(&format!("{key}.position_m.{axis}"), (0.0..=dew.size_m[axis]).contains(&middle), || {
                format!("is outside the box, which reaches from 0 to {}", dew.size_m[axis])
            })?;
        }
        self.require(&format!("{key}.velocity_m_per_s"), fan.velocity_m_per_s != [0.0; 3], || {
            "must not be 0: a fan blows some way".into()
        })
    }

    fn transport(&self, transport: &Transport) -> Checked {
        let above_zero = [
            ("vapour_diffusivity_m2_per_s", transport.vapour_diffusivity_m2_per_s),
            ("air_conductivity_w_per_m_k", transport.air_conductivity_w_per_m_k),
            ("air_heat_capacity_j_per_kg_k", transport.air_heat_capacity_j_per_kg_k),
        ];
        for (name, value) in above_zero {
            if let Some(value) = value {
                self.above(&format!("dew.transport.{name}"), value, 0.0)?;
            }
        }
        transport
            .air_viscosity_pa_s
            .map_or(Ok(()), |value| self.at_least("dew.transport.air_viscosity_pa_s", value, 0.0))
    }

    fn drops(&self, drops: &Drops) -> Checked {
        let angle = drops.contact_angle_deg;
        self.require("dew.drops.contact_angle_deg", angle > 0.0 && angle < 180.0, || {
            "must be between 0 and 180, both excluded".into()
        })?;
        let [receding, advancing] = drops.angles_deg();
        self.require("dew.drops.receding_angle_deg", receding > 0.0 && receding <= angle, || {
            format!("must be above 0 and at most contact_angle_deg, {angle}: a drop recedes at a smaller angle than it rests at")
        })?;
        self.require("dew.drops.advancing_angle_deg", advancing < 180.0 && advancing >= angle, || {
            format!("must be at least contact_angle_deg, {angle}, and below 180: a drop advances at a larger angle than it rests at")
        })?;
        let are_given = drops.receding_angle_deg.is_some() || drops.advancing_angle_deg.is_some();
        self.require("dew.drops.friction", drops.friction.is_none() || !are_given, || {
            "stands beside receding_angle_deg or advancing_angle_deg: a drop is held by friction or by its angles; leave one out".into()
        })?;
        drops.friction.map_or(Ok(()), |friction| self.at_least("dew.drops.friction", friction, 0.0))?;
        self.at_least("dew.drops.viscosity_pa_s", drops.viscosity_pa_s, 0.0)?;
        self.above("dew.drops.surface_tension_n_per_m", drops.surface_tension_n_per_m, 0.0)?;
        self.above("dew.drops.sites_per_m2", drops.sites_per_m2, 0.0)?;
        drops.smallest_radius_m.map_or(Ok(()), |radius| self.above("dew.drops.smallest_radius_m", radius, 0.0))
    }

    fn low_utility(&self, low_utility: &LowUtility) -> Checked {
        self.at_least("dew.low_utility.distance", low_utility.distance, 1.0)?;
        self.at_least("dew.low_utility.after_s", low_utility.after_s, 0.0)
    }
}

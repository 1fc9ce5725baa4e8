//! Air that comes in by the sides of the box, and how it changes with time.

use super::{air_of, key_of_side};
use crate::humid_air::{HumidAir, ZERO_CELSIUS};
use crate::room::{InflowOverTime, InflowsOverTime};
use corpuscle_scene::dew as written;
use corpuscle_scene::{Axis, Series, Table};
use std::path::Path;

/// What comes in by the sides of the box where air does.
pub(super) struct Inflows(InflowsOverTime);

impl Inflows {
    pub fn open(scene: &written::Dew, start: &HumidAir, folder: &Path) -> Result<Self, String> {
        let mut inflows = InflowsOverTime::default();
        for axis in Axis::ALL {
            for side in [0, 1] {
                if let written::Face::Inflow(inflow) = scene.faces.along(axis)[side] {
                    let key = format!("dew.faces.{}.inflow", key_of_side(axis.index(), side));
                    inflows[axis.index()][side] = Some(inflow_over_time(&key, inflow, scene, start, folder)?);
                }
            }
        }
        Ok(Self(inflows))
    }

    /// Temperature, K, and vapour, part of the mass, of what comes in by a side at the start; nothing where no air does.
    pub fn at_start(&self, axis: Axis, side: usize) -> [f64; 2] {
        self.0[axis.index()][side].as_ref().map_or([0.0; 2], |inflow| inflow.at(0.0))
    }

    /// Those that change.
    pub fn over_time(&self) -> InflowsOverTime {
        let changes = |inflow: &InflowOverTime| inflow.temperature.rows().len() > 1 || inflow.vapour.rows().len() > 1;
        self.0.clone().map(|sides| sides.map(|inflow| inflow.filter(changes)))
    }

    /// All their temperatures, K.
    pub fn temperatures(&self) -> impl Iterator<Item = f64> + '_ {
        self.0.iter().flatten().flatten().flat_map(|inflow| inflow.temperature.rows().iter().map(|row| row[1]))
    }
}

/// Parts of the time between two rows in which vapour by its relative humidity or dew point is taken as linear: over 30 K its largest error is then
/// 0.015 %.
const PARTS: usize = 64;

/// Temperature and vapour of the air that comes in over time, by the measure of humidity that is given; without one it holds as much vapour as the air
/// at the start.
fn inflow_over_time(
    key: &str,
    inflow: &written::AirInflow,
    scene: &written::Dew,
    start: &HumidAir,
    folder: &Path,
) -> Result<InflowOverTime, String> {
    let load = |name: &str, series: &Option<Series>| {
        let table = series.as_ref().map(|series| series.load(folder)).transpose();
        table.map_err(|error| format!("{key}.{name}: {error}"))
    };
    let celsius = load("temperature_c", &inflow.temperature_c)?;
    let celsius = celsius.unwrap_or_else(|| Table::constant(scene.air.temperature_c));
    let names = ["relative_humidity", "dew_point_c", "mixing_ratio"];
    let measures = [&inflow.relative_humidity, &inflow.dew_point_c, &inflow.mixing_ratio];
    let mut humidity = [None, None, None];
    for ((own, name), series) in humidity.iter_mut().zip(names).zip(measures) {
        *own = load(name, series)?;
    }
    let mut times: Vec<f64> =
        humidity.iter().flatten().chain([&celsius]).flat_map(|table| table.rows().iter().map(|row| row[0])).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let air_at = |celsius: f64, humidity: [Option<f64>; 3]| {
        let as_at_start =
            || HumidAir::with_mass_fraction(celsius + ZERO_CELSIUS, start.pressure, start.mass_fraction());
        air_of(celsius, start.pressure, humidity).unwrap_or_else(as_at_start)
    };
    let row = |at: f64, value: fn(&Table, f64) -> f64| {
        let own = humidity.each_ref().map(|table| table.as_ref().map(|table| value(table, at)));
        let air = air_at(value(&celsius, at), own);
        if let Some(measure) = own.iter().position(Option::is_some) {
            check_air(&format!("{key}.{}", names[measure]), at, &air)?;
        }
        Ok::<_, String>([at, air.mass_fraction()])
    };
    let mut vapour = Vec::new();
    for ends in times.windows(2) {
        for part in 0..PARTS {
            vapour.push(row(ends[0] + (ends[1] - ends[0]) * part as f64 / PARTS as f64, Table::at)?);
        }
        vapour.push(row(ends[1], before)?);
    }
    vapour.push(row(times[times.len() - 1], Table::at)?);
    vapour.dedup();
    if humidity.iter().all(Option::is_none) || times.len() == 1 {
        vapour.truncate(1);
    }
    let temperature = celsius.rows().iter().map(|row| [row[0], row[1] + ZERO_CELSIUS]).collect::<Vec<_>>();
    Ok(InflowOverTime { temperature: Table::try_from(temperature)?, vapour: Table::try_from(vapour)? })
}

/// The value of a table at a time; at a jump the one before it.
fn before(table: &Table, time: f64) -> f64 {
    table.rows().iter().find(|row| row[0] == time).map_or_else(|| table.at(time), |row| row[1])
}

/// Refuses air that is outside the range of the laws of vapour, or holds more of it than saturated air.
fn check_air(key: &str, time: f64, air: &HumidAir) -> Result<(), String> {
    let (celsius, humidity) = (air.temperature - ZERO_CELSIUS, air.relative_humidity());
    if (0.0..=1.0 + 1e-9).contains(&humidity) {
        return Ok(());
    }
    let most = HumidAir::with_relative_humidity(air.temperature, air.pressure, 1.0).mixing_ratio();
    let mixing = air.mixing_ratio();
    Err(format!(
        "{key}: at {time} s the air holds {mixing:.6} kg of vapour for a kg of dry air, a relative humidity of {humidity:.3} at {celsius:.1} °C; \
         it must be from 0 to 1: saturated air holds {most:.6}, and with more it would be fog already"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Air that warms by 30 K at one relative humidity: between the rows of the table its vapour is that of the law.
    #[test]
    fn vapour_between_rows_is_that_of_the_air() {
        let text = "run.until_s = 1\n[dew]\nsize_m = [1, 1, 1]\nspacing_m = 0.1\nair = { temperature_c = 0, relative_humidity = 0.5 }\n\
                    faces.x_max = { inflow = { velocity_m_per_s = [-1, 0, 0], temperature_c = [[0, 0], [3, 30], [3, 10]], relative_humidity = 0.9 } }\n\
                    [[dew.solid]]\nname = \"s\"\nshape = { sphere = { radius_m = 0.2 } }\nposition_m = [0.4, 0.5, 0.5]\ntemperature_c = 5\n";
        let scene = corpuscle_scene::Scene::parse(text, "test", &[]).unwrap();
        let scene = scene.dew().unwrap();
        let start = HumidAir::with_relative_humidity(ZERO_CELSIUS, 101_325.0, 0.5);
        let inflows = Inflows::open(scene, &start, Path::new(".")).unwrap();
        let inflow = inflows.0[0][1].as_ref().unwrap();
        let mut largest = 0.0_f64;
        for time in (0..3000).map(|k| 0.001 * f64::from(k) + 0.0005) {
            let law = HumidAir::with_relative_humidity(10.0 * time + ZERO_CELSIUS, 101_325.0, 0.9).mass_fraction();
            largest = largest.max((inflow.at(time)[1] / law - 1.0).abs());
        }
        assert!(largest > 1e-6 && largest < 1.5e-4, "{largest}");
        let after = HumidAir::with_relative_humidity(10.0 + ZERO_CELSIUS, 101_325.0, 0.9).mass_fraction();
        assert!((inflow.at(3.5)[1] / after - 1.0).abs() < 1e-12);
    }
}

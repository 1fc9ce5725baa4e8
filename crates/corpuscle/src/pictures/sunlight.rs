//! Where the sun stands over a flood: beside the camera, in a direction, or as it does at a place, a day and an hour.

use crate::Error;
use corpuscle_render::{Backdrop, Light};
use corpuscle_terrain::Terrain;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::str::FromStr;

/// Where the sun stands over a flood.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Sun {
    /// Beside the camera: shapes show best.
    #[default]
    Beside,
    /// In a direction: bearing from north and height above the horizon, degrees.
    Towards([f64; 2]),
    /// As over the terrain at a time, days since noon of 1 January 2000, UTC. The terrain must have a reference system.
    At(f64),
}

/// Optical depth of the air overhead for red, green and blue light, a clear sky (Rayleigh scattering and some aerosol).
const DEPTH_OF_AIR: [f64; 3] = [0.10, 0.15, 0.28];
/// How much of what light there is less a camera makes up for, as eyes do: 1 for all.
const EXPOSED: f32 = 0.6;
/// Lowest height of the sun that is drawn, degrees: shadows would be without end.
const LOWEST: f64 = 2.0;

impl Sun {
    /// The light with the sun there. `azimuth` is where it stands beside the camera, radians from east over north.
    ///
    /// # Errors
    /// [`Error::Sun`] where the terrain has no position on Earth, or the sun is not above the horizon.
    pub(super) fn light(self, day: Light, azimuth: f64, terrain: &Terrain) -> Result<Light, Error> {
        let [bearing, height] = match self {
            Self::Beside => return Ok(day.from_azimuth(azimuth)),
            Self::Towards(direction) => direction,
            Self::At(days) => {
                let bounds = terrain.bounds();
                let middle = [0.5 * (bounds.x_min + bounds.x_max), 0.5 * (bounds.y_min + bounds.y_max)];
                let unknown =
                    |error| Error::Sun(format!("{error}; give the sun's direction instead, as in --sun 135,40"));
                over(terrain.to_lon_lat(middle).map_err(unknown)?, days)
            }
        };
        if height < LOWEST {
            return Err(Error::Sun(format!(
                "the sun stands {height:.1} degrees above the horizon, at a bearing of {bearing:.0} degrees; it must be {LOWEST} or more"
            )));
        }
        let sun = [FRAC_PI_2 - bearing.to_radians(), height.to_radians()].map(|angle| angle as f32);
        let more = air_mass(height) - air_mass(f64::from(day.sun[1]).to_degrees());
        let left = DEPTH_OF_AIR.map(|depth| (-depth * more).exp() as f32);
        let exposure = left[1].powf(-EXPOSED);
        let left = left.map(|part| exposure * part);
        let sunlight = std::array::from_fn(|k| day.sunlight[k] * left[k]);
        Ok(Light { sun, sunlight, backdrop: sky(day.backdrop, left), ..day })
    }
}

/// The sky where these parts of red, green and blue sunlight are left. Light from the sky is a fixed part of the sun's (clear-sky model of ASHRAE,
/// Handbook of Fundamentals, 1985, chapter 27); towards the horizon it takes on some of its colour.
fn sky(day: Backdrop, left: [f32; 3]) -> Backdrop {
    let Backdrop::Sky { above, horizon, below } = day else { return day };
    let dimmed = |colour: [f32; 3]| colour.map(|part| part * left[1]);
    Backdrop::Sky {
        above: dimmed(above),
        horizon: std::array::from_fn(|k| horizon[k] * left[k].sqrt() * left[1].sqrt()),
        below: dimmed(below),
    }
}

impl FromStr for Sun {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |part: &str| part.trim().parse().ok().filter(|number: &f64| number.is_finite());
        let direction = text.split_once(',').and_then(|(bearing, height)| Some([number(bearing)?, number(height)?]));
        match direction {
            Some([bearing, height]) if (LOWEST..=90.0).contains(&height) => {
                return Ok(Self::Towards([bearing, height]));
            }
            Some(_) => return Err(format!("the sun's height must be {LOWEST} to 90 degrees, as in 135,40")),
            None => (),
        }
        let time = days_since_2000(text).map(Self::At);
        time.ok_or_else(|| {
            "must be a bearing from north and a height, degrees, as in 135,40, or a time in UTC, as in 2026-06-21T15:00Z".into()
        })
    }
}

/// Days since noon of 1 January 2000 of a time such as 2026-06-21T15:00Z.
fn days_since_2000(text: &str) -> Option<f64> {
    let (date, time) = text.strip_suffix('Z')?.split_once('T')?;
    let (hour, minute) = time.split_once(':')?;
    let mut date = date.splitn(3, '-').map(|part| part.parse::<i64>().ok());
    let (year, month, day) = (date.next()??, date.next()??, date.next()??);
    let (hour, minute) = (hour.parse::<u8>().ok()?, minute.parse::<u8>().ok()?);
    let is_leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let length = match month {
        4 | 6 | 9 | 11 => 30,
        2 => 28 + i64::from(is_leap),
        1..=12 => 31,
        _ => return None,
    };
    if !(1900..=2100).contains(&year) || !(1..=length).contains(&day) || hour > 23 || minute > 59 {
        return None;
    }
    // Julian day number (Fliegel and Van Flandern, Communications of the ACM 11, 1968, 657), whose days begin at noon.
    let shifted = (month - 14) / 12;
    let julian = day - 32_075 + 1461 * (year + 4800 + shifted) / 4 + 367 * (month - 2 - 12 * shifted) / 12
        - 3 * ((year + 4900 + shifted) / 100) / 4;
    Some((julian - 2_451_545) as f64 + (f64::from(hour) - 12.0) / 24.0 + f64::from(minute) / 1440.0)
}

/// Bearing from north and height above the horizon of the sun, degrees, over a longitude and latitude, degrees, some days after noon of 1 January 2000, UTC: to a
/// hundredth of a degree from 1950 to 2050 (Michalsky, Solar Energy 40, 1988, 227). Refraction is left out.
fn over([longitude, latitude]: [f64; 2], days: f64) -> [f64; 2] {
    let turned = |degrees: f64| degrees.rem_euclid(360.0).to_radians();
    let (mean, anomaly) = (turned(280.460 + 0.985_647_4 * days), turned(357.528 + 0.985_600_3 * days));
    let ecliptic = mean + (1.915 * anomaly.sin() + 0.020 * (2.0 * anomaly).sin()).to_radians();
    let tilt = (23.439 - 0.000_000_4 * days).to_radians();
    let ascension = (tilt.cos() * ecliptic.sin()).atan2(ecliptic.cos());
    let declination = (tilt.sin() * ecliptic.sin()).asin();
    // Greenwich mean sidereal time, hours; of days that begin at noon.
    let sidereal = 18.697_374_6 + 24.065_709_824_4 * days;
    let hour_angle = (sidereal.rem_euclid(24.0) / 24.0 * TAU + longitude.to_radians()) - ascension;
    let latitude = latitude.to_radians();
    let height = (latitude.sin() * declination.sin() + latitude.cos() * declination.cos() * hour_angle.cos()).asin();
    let (east, north) = (
        -declination.cos() * hour_angle.sin(),
        latitude.cos() * declination.sin() - latitude.sin() * declination.cos() * hour_angle.cos(),
    );
    [east.atan2(north).to_degrees().rem_euclid(360.0), height.to_degrees()]
}

/// How many times as much air the light of a sun so many degrees high comes through as one overhead (Kasten and Young, Applied Optics 28, 1989, 4735).
fn air_mass(height: f64) -> f64 {
    1.0 / (height.to_radians().sin() + 0.505_72 * (height + 6.079_95).powf(-1.6364))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_days_since_2000() {
        let days = |text: &str| days_since_2000(text);
        assert_eq!(days("2000-01-01T12:00Z"), Some(0.0));
        assert_eq!(days("2000-03-01T00:00Z"), Some(59.5));
        assert_eq!(days("1999-12-31T12:00Z"), Some(-1.0));
        assert!((days("2026-06-21T15:00Z").unwrap() - (9668.0 + 0.125)).abs() < 1e-9);
        for wrong in
            ["2026-02-29T12:00Z", "2026-06-21", "2026-13-01T00:00Z", "2026-06-21T24:00Z", "2026-06-21T15:00", "x"]
        {
            assert_eq!(days(wrong), None, "{wrong}");
        }
    }

    /// NOAA's solar calculator: Boulder (40 N, 105 W) and Sydney.
    #[test]
    fn the_sun_stands_where_it_does() {
        let of = |place, text| over(place, days_since_2000(text).unwrap());
        // The solstice at true noon over the tropic, and an equinox at sunrise due east of the equator.
        let [_, height] = of([0.0, 23.437], "2024-06-21T12:02Z");
        assert!((height - 90.0).abs() < 0.3, "{height}");
        let [bearing, height] = of([0.0, 0.0], "2024-03-20T06:07Z");
        assert!((bearing - 90.0).abs() < 0.3 && height.abs() < 0.4, "{bearing} {height}");
        // In the south it stands in the north at noon, in the north in the south.
        let [bearing, height] = of([151.2, -33.9], "2024-12-21T01:53Z");
        assert!(bearing.min(360.0 - bearing) < 4.0 && (height - 79.5).abs() < 0.5, "{bearing} {height}");
        let [bearing, height] = of([-105.0, 40.0], "2024-06-21T19:02Z");
        assert!((bearing - 180.0).abs() < 2.0 && (height - 73.44).abs() < 0.1, "{bearing} {height}");
        // East in the morning, west in the evening.
        assert!(of([7.0, 50.0], "2026-06-21T05:00Z")[0] < 90.0 && of([7.0, 50.0], "2026-06-21T18:00Z")[0] > 270.0);
    }

    #[test]
    fn a_low_sun_is_weaker_and_redder() {
        assert!((air_mass(90.0) - 1.0).abs() < 1e-3 && (air_mass(5.0) - 10.3).abs() < 0.2);
        let terrain = Terrain::gridded(
            corpuscle_terrain::Bounds { x_min: 0.0, x_max: 10.0, y_min: 0.0, y_max: 10.0 },
            1.0,
            |_, _| 0.0,
        );
        let light = |text: &str| Sun::from_str(text).unwrap().light(Light::day(), 0.3, &terrain);
        let (high, low) = (light("135,60").unwrap(), light("135,5").unwrap());
        assert!(
            low.sunlight[0] < high.sunlight[0]
                && low.sunlight[2] / low.sunlight[0] < 0.5 * high.sunlight[2] / high.sunlight[0]
        );
        let horizon = |light: &Light| {
            let Backdrop::Sky { horizon, .. } = light.backdrop else { panic!("{:?}", light.backdrop) };
            horizon
        };
        assert!(horizon(&low)[1] < 0.8 * horizon(&high)[1]);
        assert!(horizon(&low)[2] / horizon(&low)[0] < 0.7 * horizon(&high)[2] / horizon(&high)[0]);
        // A bearing of 135 degrees is south-east.
        let towards = high.towards_sun();
        assert!(towards.x > 0.0 && (towards.x + towards.y).abs() < 1e-6);
        assert_eq!(Sun::Beside.light(Light::day(), 0.3, &terrain).unwrap(), Light::day().from_azimuth(0.3));
        // This terrain has no position on Earth.
        assert!(light("2026-06-21T12:00Z").unwrap_err().to_string().contains("--sun 135,40"));
        assert!(["135", "135,1", "135,91", "noon"].iter().all(|wrong| Sun::from_str(wrong).is_err()));
    }
}

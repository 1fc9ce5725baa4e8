//! Checks of `[gas.walls]`.

use crate::check::{Check, Checked, SIDES};
use crate::{Axis, Gas, Motion, Series, Wall};

impl Check {
    pub(super) fn walls(&self, gas: &Gas) -> Checked {
        for (name, given) in [("z_min", &gas.walls.z_min), ("z_max", &gas.walls.z_max)] {
            self.require(&format!("gas.walls.{name}"), gas.dimensions() == 3 || given.is_none(), || {
                "there is no z in two dimensions; take it out, or give size three numbers".into()
            })?;
        }
        for axis in Axis::ALL.into_iter().take(gas.dimensions()) {
            let names = SIDES[axis.index()];
            let sides = gas.walls.along(axis);
            for (name, wall) in names.into_iter().zip(sides) {
                self.wall(&format!("gas.walls.{name}"), wall)?;
            }
            self.opposite(gas, axis, names, sides)?;
        }
        Ok(())
    }

    fn wall(&self, key: &str, wall: &Wall) -> Checked {
        match wall {
            Wall::Fixed | Wall::Periodic => Ok(()),
            Wall::Thermal { temperature } => self.above(&format!("{key}.thermal.temperature"), *temperature, 0.0),
            Wall::Moving { until_s, .. } => {
                self.at_least(&format!("{key}.moving.until_s"), until_s.unwrap_or(0.0), 0.0)
            }
            Wall::Motion(motion) => self.motion(&format!("{key}.motion"), motion),
            Wall::Piston { mass, pressure, .. } => {
                self.above(&format!("{key}.piston.mass"), *mass, 0.0)?;
                self.require(&format!("{key}.piston.pressure"), *pressure > 0.0, || {
                    "must be larger than 0: without a pressure from outside the gas drives the piston away for ever"
                        .into()
                })
            }
        }
    }

    fn motion(&self, key: &str, motion: &Motion) -> Checked {
        match motion {
            Motion::Sinusoid { period_s, .. } => self.above(&format!("{key}.sinusoid.period_s"), *period_s, 0.0),
            Motion::Displacement(series) => {
                let key = format!("{key}.displacement");
                self.series(&key, series)?;
                let first = match series {
                    Series::Constant(value) => *value,
                    Series::Table(rows) => rows[0][1],
                    Series::File { .. } => 0.0,
                };
                self.require(&key, first == 0.0, || {
                    format!("must begin with 0, not {first}: at the start the wall is where size has it")
                })?;
                let Series::Table(rows) = series else { return Ok(()) };
                let jump = rows.windows(2).position(|pair| pair[0][0] == pair[1][0] && pair[0][1] != pair[1][1]);
                self.require(&format!("{key}.{}", jump.unwrap_or(0) + 1), jump.is_none(), || {
                    "a wall cannot jump: give the rows different times".into()
                })
            }
        }
    }

    /// What two opposite sides must be together.
    fn opposite(&self, gas: &Gas, axis: Axis, names: [&str; 2], sides: [&Wall; 2]) -> Checked {
        for ((name, wall), (opposite, other)) in
            [(0, 1), (1, 0)].map(|(a, b)| ((names[a], sides[a]), (names[b], sides[b])))
        {
            let key = format!("gas.walls.{name}");
            let alone = *wall == Wall::Periodic && *other != Wall::Periodic;
            self.require(&key, !alone, || {
                format!("the opposite side must be periodic too: give {opposite} = \"periodic\"")
            })?;
            let falls = *wall == Wall::Periodic && gas.gravity()[axis.index()] != 0.0;
            self.require(&key, !falls, || "with gravity along it the gas would fall through for ever".into())?;
        }
        Ok(())
    }
}

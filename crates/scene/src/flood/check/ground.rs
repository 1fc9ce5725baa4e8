//! Checks of rain, of the ground, and of what lets water out or leads it elsewhere.

use crate::check::{Check, Checked};
use crate::{Culvert, Flood, Friction, Infiltration, Link, LinkLaw, Outflow, Rain, Series, Stage, Weir};

impl Check {
    /// What is on the ground and in it.
    pub(super) fn ground(&self, flood: &Flood) -> Checked {
        match flood.friction {
            Some(Friction::Chezy(c)) => self.above("flood.friction.chezy", c, 0.0)?,
            Some(Friction::Linear(slope)) => self.at_least("flood.friction.linear", slope, 0.0)?,
            None => {}
        }
        if let Some(rain) = &flood.rain {
            self.rain(rain)?;
        }
        if let Some(infiltration) = &flood.infiltration {
            self.infiltration("flood.infiltration", infiltration)?;
        }
        let Some(land_use) = &flood.land_use else { return Ok(()) };
        for (index, class) in land_use.class.iter().enumerate() {
            let key = format!("flood.land_use.class.{index}");
            let taken = land_use.class[..index].iter().position(|other| other.code == class.code);
            self.require(&format!("{key}.code"), taken.is_none(), || {
                format!("this number is taken by flood.land_use.class.{}", taken.unwrap_or(0))
            })?;
            if let Some(n) = class.manning {
                self.roughness(&format!("{key}.manning"), n)?;
            }
            if let Some(infiltration) = &class.infiltration {
                self.infiltration(&format!("{key}.infiltration"), infiltration)?;
            }
        }
        Ok(())
    }

    fn rain(&self, rain: &Rain) -> Checked {
        let key = "flood.rain.intensity_mm_per_h";
        self.series(key, &rain.intensity_mm_per_h)?;
        let smallest = match &rain.intensity_mm_per_h {
            Series::Constant(value) => *value,
            Series::Table(rows) => rows.iter().map(|row| row[1]).fold(f64::INFINITY, f64::min),
            Series::File { .. } => 0.0,
        };
        self.require(key, smallest >= 0.0, || format!("rain must not be negative ({smallest} here)"))
    }

    fn infiltration(&self, key: &str, infiltration: &Infiltration) -> Checked {
        match infiltration {
            Infiltration::Constant(constant) => {
                self.at_least(&format!("{key}.constant.rate_mm_per_h"), constant.rate_mm_per_h, 0.0)
            }
            Infiltration::Horton(horton) => {
                let at = |name: &str| format!("{key}.horton.{name}");
                self.at_least(&at("last_mm_per_h"), horton.last_mm_per_h, 0.0)?;
                self.require(&at("first_mm_per_h"), horton.first_mm_per_h >= horton.last_mm_per_h, || {
                    format!(
                        "must be at least last_mm_per_h = {}: the rate falls as the ground fills",
                        horton.last_mm_per_h
                    )
                })?;
                self.above(&at("decay_per_h"), horton.decay_per_h, 0.0)
            }
            Infiltration::GreenAmpt(ground) => {
                let at = |name: &str| format!("{key}.green-ampt.{name}");
                self.at_least(&at("conductivity_mm_per_h"), ground.conductivity_mm_per_h, 0.0)?;
                self.at_least(&at("suction_m"), ground.suction_m, 0.0)?;
                self.require(&at("deficit"), (0.0..=1.0).contains(&ground.deficit), || {
                    "must be a share of the ground's volume, from 0 to 1".into()
                })
            }
        }
    }

    pub(super) fn outflow(&self, key: &str, outflow: &Outflow) -> Checked {
        let Outflow { at, line, polygon, rating, .. } = outflow;
        self.exactly_one(key, &[("at", at.is_some()), ("line", line.is_some()), ("polygon", polygon.is_some())])?;
        self.zone(key, line.as_deref(), polygon.as_deref())?;
        self.rating(&format!("{key}.rating"), "level, discharge", rating)
    }

    pub(super) fn stage(&self, key: &str, stage: &Stage) -> Checked {
        self.exactly_one(key, &[("line", stage.line.is_some()), ("polygon", stage.polygon.is_some())])?;
        self.zone(key, stage.line.as_deref(), stage.polygon.as_deref())?;
        self.series(&format!("{key}.level_m"), &stage.level_m)
    }

    fn zone(&self, key: &str, line: Option<&[[f64; 2]]>, polygon: Option<&[[f64; 2]]>) -> Checked {
        if let Some(line) = line {
            self.line(&format!("{key}.line"), line)?;
        }
        polygon.map_or(Ok(()), |polygon| self.polygon(&format!("{key}.polygon"), polygon))
    }

    /// Rows of two numbers, the first rising, the second never negative.
    pub(super) fn rating(&self, key: &str, columns: &str, rows: &[[f64; 2]]) -> Checked {
        self.require(key, !rows.is_empty(), || format!("there are no rows; give at least one of [{columns}]"))?;
        let falling = rows.windows(2).position(|pair| pair[0][0] >= pair[1][0]);
        if let Some(row) = falling {
            return Err(self.problem(&format!("{key}.{}", row + 1), "the first numbers of the rows must rise"));
        }
        match rows.iter().position(|row| row[1] < 0.0) {
            Some(row) => Err(self.problem(&format!("{key}.{row}"), "a discharge must not be negative")),
            None => Ok(()),
        }
    }

    pub(super) fn link(&self, key: &str, link: &Link) -> Checked {
        self.require(&format!("{key}.to"), link.from != link.to, || "must be another position than from".into())?;
        match &link.law {
            LinkLaw::Culvert(culvert) => self.culvert(&format!("{key}.law.culvert"), culvert),
            LinkLaw::Weir(Weir { width_m, coefficient, .. }) => {
                self.above(&format!("{key}.law.weir.width_m"), *width_m, 0.0)?;
                self.above(&format!("{key}.law.weir.coefficient"), *coefficient, 0.0)
            }
            LinkLaw::Rating(rows) => self.rating(&format!("{key}.law.rating"), "difference, discharge", rows),
        }
    }

    fn culvert(&self, key: &str, culvert: &Culvert) -> Checked {
        let is_box = culvert.width_m.is_some() || culvert.height_m.is_some();
        self.exactly_one(key, &[("diameter_m", culvert.diameter_m.is_some()), ("width_m and height_m", is_box)])?;
        self.require(key, !is_box || culvert.width_m.is_some() && culvert.height_m.is_some(), || {
            "a box needs both width_m and height_m".into()
        })?;
        let sizes = [
            ("diameter_m", culvert.diameter_m),
            ("width_m", culvert.width_m),
            ("height_m", culvert.height_m),
            ("length_m", culvert.length_m),
        ];
        for (name, size) in sizes {
            size.map_or(Ok(()), |size| self.above(&format!("{key}.{name}"), size, 0.0))?;
        }
        self.roughness(&format!("{key}.manning"), culvert.manning)?;
        self.at_least(&format!("{key}.entrance_loss"), culvert.entrance_loss, 0.0)?;
        self.at_least(&format!("{key}.barrels"), culvert.barrels as f64, 1.0)
    }
}

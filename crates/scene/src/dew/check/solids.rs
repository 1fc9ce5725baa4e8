//! Checks of `[[dew.solid]]`.

use crate::check::{Check, Checked, is_same_file};
use crate::dew::{Dew, Material, Scheme, Shape, Solid, Wetting, WineGlass};
use crate::{Problem, Series};

/// A solid hotter than this glows: most of its heat is light, °C.
pub(super) const HOTTEST: f64 = 1000.0;

/// Names of gauges that are of no solid.
const GAUGES: [&str; 4] = ["water", "air", "solids", "drops"];

impl Check {
    pub(super) fn solids(&self, dew: &Dew) -> Checked {
        for (row, solid) in dew.solid.iter().enumerate() {
            let key = format!("dew.solid.{row}");
            self.name(&format!("{key}.name"), &solid.name)?;
            let before = dew.solid[..row].iter().position(|other| is_same_file(&other.name, &solid.name));
            self.require(&format!("{key}.name"), before.is_none(), || {
                "is the name of another solid too; names must be unique, with spaces as `_`: files have them".into()
            })?;
            self.require(&format!("{key}.name"), !GAUGES.contains(&solid.name.as_str()), || {
                format!("is the name of other gauges; {} are taken", GAUGES.join(", "))
            })?;
            self.shape(&format!("{key}.shape"), &solid.shape)?;
            self.material(&format!("{key}.material"), &solid.material)?;
            self.solid_temperature(&format!("{key}.temperature_c"), solid)?;
            self.require(&format!("{key}.layers"), solid.layers != Some(0), || {
                "must be at least 1; leave it out to fill the solid".into()
            })?;
            self.heat_sources(&key, dew, solid)?;
            self.solid_faces(&key, solid)?;
            solid.sites_per_m2.map_or(Ok(()), |sites| self.above(&format!("{key}.sites_per_m2"), sites, 0.0))?;
            self.wetting(&key, dew, solid)?;
        }
        Ok(())
    }

    fn wetting(&self, key: &str, dew: &Dew, solid: &Solid) -> Checked {
        if solid.wetting == Wetting::Drops {
            return Ok(());
        }
        self.require(&format!("{key}.sites_per_m2"), solid.sites_per_m2.is_none(), || {
            "is of drops, and with wetting = \"film\" there are none; leave it out".into()
        })?;
        self.require(&format!("{key}.wetting"), dew.scheme == Scheme::Physical, || {
            "= \"film\" goes with scheme = \"physical\" only, where water has a viscosity".into()
        })?;
        self.require("dew.drops.viscosity_pa_s", dew.drops.viscosity_pa_s > 0.0, || {
            format!("must be above 0 where a solid has a film ({key}.wetting), which its viscosity brakes")
        })
    }

    fn solid_faces(&self, key: &str, solid: &Solid) -> Checked {
        for (row, face) in solid.face.iter().enumerate() {
            let key = format!("{key}.face.{row}");
            self.name(&format!("{key}.name"), &face.name)?;
            let before = &solid.face[..row];
            self.require(&format!("{key}.name"), before.iter().all(|other| other.name != face.name), || {
                "is the name of another face of this solid too; names must be unique".into()
            })?;
            self.require(&format!("{key}.side"), before.iter().all(|other| other.side != face.side), || {
                "is the side of another face of this solid too; give each side once".into()
            })?;
        }
        Ok(())
    }

    fn shape(&self, key: &str, shape: &Shape) -> Checked {
        match shape {
            Shape::Box { size_m } => {
                (0..3).try_for_each(|axis| self.above(&format!("{key}.box.size_m.{axis}"), size_m[axis], 0.0))
            }
            Shape::Sphere { radius_m } => self.above(&format!("{key}.sphere.radius_m"), *radius_m, 0.0),
            Shape::Cylinder { radius_m, height_m } => {
                self.above(&format!("{key}.cylinder.radius_m"), *radius_m, 0.0)?;
                self.above(&format!("{key}.cylinder.height_m"), *height_m, 0.0)
            }
            Shape::Revolution { profile_m } => self.profile(&format!("{key}.revolution.profile_m"), profile_m),
            Shape::WineGlass(glass) => self.wine_glass(&format!("{key}.wine-glass"), glass),
            Shape::Mesh(mesh) => match (mesh.unit, mesh.is_in_metres()) {
                (None, false) => Err(Problem::new(
                    format!("{key}.mesh.unit"),
                    " is missing: this format does not say what its numbers are measured in; give \"m\", \"cm\", \"mm\", \
                     \"in\" or \"ft\"",
                )),
                (Some(_), true) => {
                    Err(self.problem(&format!("{key}.mesh.unit"), "glTF is in metres always; take the unit out"))
                }
                _ => Ok(()),
            },
        }
    }

    fn profile(&self, key: &str, profile: &[[f64; 2]]) -> Checked {
        self.require(key, profile.len() >= 3, || "must have three corners or more".into())?;
        let beyond = profile.iter().position(|corner| corner[0] < 0.0);
        self.require(&format!("{key}.{}", beyond.unwrap_or(0)), beyond.is_none(), || {
            "lies beyond the axis: the first number is the distance from it, 0 or more".into()
        })
    }

    fn wine_glass(&self, key: &str, glass: &WineGlass) -> Checked {
        let lengths = [
            ("height_m", glass.height_m),
            ("bowl_radius_m", glass.bowl_radius_m),
            ("foot_radius_m", glass.foot_radius_m),
            ("stem_radius_m", glass.stem_radius_m),
            ("wall_m", glass.wall_m),
        ];
        lengths.into_iter().try_for_each(|(name, value)| self.above(&format!("{key}.{name}"), value, 0.0))
    }

    pub(super) fn material(&self, key: &str, material: &Material) -> Checked {
        let Material::Own { conductivity_w_per_m_k, heat_capacity_j_per_kg_k, density_kg_per_m3 } = material else {
            return Ok(());
        };
        self.above(&format!("{key}.conductivity_w_per_m_k"), *conductivity_w_per_m_k, 0.0)?;
        self.above(&format!("{key}.heat_capacity_j_per_kg_k"), *heat_capacity_j_per_kg_k, 0.0)?;
        self.above(&format!("{key}.density_kg_per_m3"), *density_kg_per_m3, 0.0)
    }

    fn solid_temperature(&self, key: &str, solid: &Solid) -> Checked {
        self.series(key, &solid.temperature_c)?;
        self.each_value(key, &solid.temperature_c, |key, celsius| {
            self.not_below_absolute_zero(key, celsius)?;
            self.require(key, celsius <= HOTTEST, || {
                format!("must be at most {HOTTEST}: a hotter solid radiates more than it conducts")
            })
        })?;
        if matches!(solid.temperature_c, Series::Constant(_)) {
            return Ok(());
        }
        self.require(key, solid.held, || {
            "a temperature over time must be held: give held = true, or the temperature at the start alone".into()
        })
    }
}

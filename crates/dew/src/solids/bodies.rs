//! The solids of a scene, made ready: where they are, what they are made of, and the particles that stand for them.

use super::sources::{BodySources, Outside, Surroundings};
use super::wall::WallLayer;
use crate::humid_air::ZERO_CELSIUS;
use corpuscle_model::{ModelError, SolidShape};
use corpuscle_scene::dew::{self, Dew, Shape};
use corpuscle_scene::{SceneError, Series, Table};
use corpuscle_solids::{
    self as solids, Depth, MATERIALS, Material, Mesh, Pose, Profile, Samples, Solid, SolidError, WineGlass,
};
use std::path::Path;
use std::sync::Arc;

/// A solid of a scene.
#[derive(Debug, Clone)]
pub struct Body {
    /// Its name in the scene.
    pub name: String,
    /// Where it is.
    pub solid: Solid,
    /// What it is made of.
    pub material: Material,
    /// Its temperature in °C: at the start, or over time where it is held.
    pub temperature: Table,
    /// Whether its temperature is held.
    pub held: bool,
    /// How it keeps air out, where not as all do.
    pub treatment: Option<dew::Treatment>,
    /// Its heater, the outside, radiation.
    pub(crate) sources: BodySources,
    /// The particles that stand for it.
    pub samples: Samples,
    /// What was put right in its mesh, and where it is too thin for its particles, in sentences.
    pub notes: Vec<String>,
}

/// Why the solids of a scene cannot be used. The text says which, what is wrong and what to do.
#[derive(Debug, thiserror::Error)]
pub enum BodyError {
    /// A solid that cannot be made.
    #[error("the solid \"{name}\" (dew.solid.{row}): {source}")]
    Solid {
        /// Its name.
        name: String,
        /// Its row in the scene, counted from 0.
        row: usize,
        /// Why.
        source: SolidError,
    },
    /// A temperature over time that cannot be read.
    #[error(transparent)]
    Temperature(#[from] SceneError),
    /// A temperature over time that cannot be.
    #[error(
        "the solid \"{name}\" (dew.solid.{row}): its temperature over time goes down to {celsius} °C, below absolute zero, -273.15 °C: it \
         is told in °C, not in K"
    )]
    TooCold {
        /// Its name.
        name: String,
        /// Its row in the scene, counted from 0.
        row: usize,
        /// The lowest temperature, °C.
        celsius: f64,
    },
    /// Power or temperature over time, from a file, that cannot be.
    #[error("the solid \"{name}\" (dew.solid.{row}.{key}): {what}")]
    Source {
        /// Its name.
        name: String,
        /// Its row in the scene, counted from 0.
        row: usize,
        /// The key.
        key: &'static str,
        /// What is wrong.
        what: String,
    },
    /// A solid that has something outside and does not reach there.
    #[error(
        "the solid \"{name}\" (dew.solid.{row}.outside): it does not reach the side {side} of the box: move it there by position_m, or leave \
         outside out"
    )]
    NotAtSide {
        /// Its name.
        name: String,
        /// Its row in the scene, counted from 0.
        row: usize,
        /// Name of the side.
        side: &'static str,
    },
    /// A name of no material.
    #[error(
        "the solid \"{name}\" (dew.solid.{key}): there is no material \"{material}\"; there are {known}, or give its numbers"
    )]
    Material {
        /// Name of the solid.
        name: String,
        /// Where in `dew.solid` of the scene: its row, counted from 0, and the key of a layer behind it.
        key: String,
        /// Name of the material.
        material: String,
        /// All that there are.
        known: String,
    },
    /// A solid that the box has nothing of.
    #[error(
        "the solid \"{name}\" (dew.solid.{row}) is from {from:.4?} to {to:.4?} m, outside the box of {size:?} m: move it by position_m, \
         or look whether its unit of length is right"
    )]
    Outside {
        /// Its name.
        name: String,
        /// Its row in the scene, counted from 0.
        row: usize,
        /// Its smallest coordinates, m.
        from: [f64; 3],
        /// Its largest coordinates, m.
        to: [f64; 3],
        /// The box, m.
        size: [f64; 3],
    },
    /// Solids that leave no room for air.
    #[error(
        "the solids fill the box of {size:?} m: there is no place for a particle of air in it; give smaller solids, a larger size_m, \
         or look whether their units of length are right"
    )]
    NoRoom {
        /// The box, m.
        size: [f64; 3],
    },
    /// Solids that are in one another.
    #[error("the solids \"{one}\" and \"{other}\" overlap, at {at:.4?} m by {depth:.2e} m: move one of them")]
    Overlap {
        /// One of them.
        one: String,
        /// The other.
        other: String,
        /// Where.
        at: [f64; 3],
        /// How deep.
        depth: f64,
    },
}

impl From<BodyError> for ModelError {
    fn from(error: BodyError) -> Self {
        ModelError::Setup(error.to_string())
    }
}

/// Makes the solids of a scene ready. Relative paths are taken from `folder`.
///
/// # Errors
/// [`BodyError`], where one cannot be made, is outside the box or in another, or where they leave no room for air.
pub fn open(dew: &Dew, folder: &Path) -> Result<Vec<Body>, BodyError> {
    let made = dew.solid.iter().enumerate().map(|(row, written)| body(dew, row, written, folder));
    let bodies = made.collect::<Result<Vec<_>, _>>()?;
    refuse_overlap(&bodies, dew.spacing_m)?;
    refuse_a_full_box(&bodies, dew)?;
    Ok(bodies)
}

/// The solids of a scene as shapes, in the order of the scene; relative paths are taken from `folder`.
///
/// # Errors
/// [`BodyError::Solid`] where one cannot be made.
pub fn shapes(dew: &Dew, folder: &Path) -> Result<Vec<SolidShape>, BodyError> {
    let one = |(row, written): (usize, &dew::Solid)| match solid(written, folder) {
        Ok((solid, _)) => Ok(shape(solid)),
        Err(source) => Err(BodyError::Solid { name: written.name.clone(), row, source }),
    };
    dew.solid.iter().enumerate().map(one).collect()
}

/// The shape of a solid.
pub(crate) fn shape(solid: Solid) -> SolidShape {
    SolidShape { bounds: solid.bounds(), distance: Arc::new(move |position| solid.signed_distance(position)) }
}

fn body(dew: &Dew, row: usize, written: &dew::Solid, folder: &Path) -> Result<Body, BodyError> {
    let name = written.name.clone();
    let wrong = |source| BodyError::Solid { name: name.clone(), row, source };
    let (solid, mut notes) = solid(written, folder).map_err(wrong)?;
    let [from, to] = solid.bounds();
    if (0..3).any(|axis| to[axis] <= 0.0 || from[axis] >= dew.size_m[axis]) {
        return Err(BodyError::Outside { name, row, from, to, size: dew.size_m });
    }
    let depth = written.layers.map_or(Depth::Full, Depth::Layers);
    let samples = solid.sample(dew.spacing_m, depth).map_err(wrong)?;
    notes.extend(thin(&name, &samples, dew.spacing_m));
    let temperature = written.temperature_c.load(folder)?;
    let celsius = temperature.rows().iter().map(|at| at[1]).fold(f64::INFINITY, f64::min);
    if celsius < -ZERO_CELSIUS {
        return Err(BodyError::TooCold { name, row, celsius });
    }
    let material = material(&row.to_string(), &name, &written.material)?;
    let (held, treatment) = (written.held, written.treatment);
    let sources = sources(row, written, folder)?;
    refuse_away_from_side(dew, row, written, &solid)?;
    Ok(Body { material, temperature, held, treatment, name, solid, sources, samples, notes })
}

/// Heat sources of a solid, with their files read.
fn sources(row: usize, written: &dew::Solid, folder: &Path) -> Result<BodySources, BodyError> {
    let load = |key: &'static str, series: &Series, least: f64, what: &str| {
        let table = series.load(folder)?;
        let smallest = table.rows().iter().map(|row| row[1]).fold(f64::INFINITY, f64::min);
        if smallest < least {
            let what = format!("{what} goes down to {smallest} over time; it must be at least {least}");
            return Err(BodyError::Source { name: written.name.clone(), row, key, what });
        }
        Ok(table)
    };
    let temperature = |key, series| load(key, series, -ZERO_CELSIUS, "the temperature in °C");
    let power =
        |series: &Option<Series>| series.as_ref().map(|series| load("heater", series, 0.0, "the power")).transpose();
    let heater = match &written.heater {
        Some(heater) => {
            let [whole, per_area] = [power(&heater.power_w)?, power(&heater.power_w_per_m2)?];
            whole.map(|table| (table, false)).or(per_area.map(|table| (table, true)))
        }
        None => None,
    };
    let outside = match &written.outside {
        Some(outside) => {
            let air = temperature("outside.temperature_c", &outside.temperature_c)?;
            let radiant = outside.surroundings_c.as_ref().map(|series| temperature("outside.surroundings_c", series));
            let surroundings = Surroundings {
                transfer_coefficient: outside.h_w_per_m2_k,
                emissivity: outside.emissivity,
                radiant_temperature: radiant.transpose()?,
                air_temperature: air,
            };
            let layers = wall_layers(row, &written.name, &outside.layers)?;
            Some(Outside { side: outside.side.axis_and_end(), layers, surroundings })
        }
        None => None,
    };
    let radiation = match &written.radiation {
        Some(radiation) => {
            let radiant = temperature("radiation.surroundings_c", &radiation.surroundings_c)?;
            Some(Surroundings {
                transfer_coefficient: 0.0,
                air_temperature: radiant,
                emissivity: radiation.emissivity,
                radiant_temperature: None,
            })
        }
        None => None,
    };
    Ok(BodySources { heater, outside, radiation })
}

fn wall_layers(row: usize, solid: &str, layers: &[dew::WallLayer]) -> Result<Vec<WallLayer>, BodyError> {
    let layer = |(at, layer): (usize, &dew::WallLayer)| match (&layer.material, layer.thickness_m) {
        (Some(written), Some(thickness)) => {
            let place = format!("{row}.outside.layers.{at}");
            Ok(WallLayer::Solid(material(&place, solid, written)?.into(), thickness))
        }
        _ => Ok(WallLayer::Gap(layer.resistance_m2_k_per_w.unwrap_or(0.0))),
    };
    layers.iter().enumerate().map(layer).collect()
}

/// A solid with something outside reaches the side, or is within this of it, over the spacing: rounding. The area in the side is measured on the solid's form, and one that ends farther
/// away would have too little of it.
const AT_SIDE: f64 = 1e-3;

fn refuse_away_from_side(dew: &Dew, row: usize, written: &dew::Solid, solid: &Solid) -> Result<(), BodyError> {
    let Some(outside) = &written.outside else { return Ok(()) };
    let [axis, end] = outside.side.axis_and_end();
    let [low, high] = solid.bounds();
    let away = [low[axis], dew.size_m[axis] - high[axis]][end];
    if away > AT_SIDE * dew.spacing_m {
        return Err(BodyError::NotAtSide { name: written.name.clone(), row, side: outside.side.key() });
    }
    Ok(())
}

/// The warning about a solid many of whose particles fill less than half a cell.
fn thin(name: &str, samples: &Samples, spacing: f64) -> Option<String> {
    let small = samples.volumes.iter().filter(|&&volume| volume < 0.5 * spacing.powi(3)).count();
    let is_thin = 10 * small > samples.volumes.len();
    is_thin.then(|| {
        format!(
            "the solid \"{name}\" is thinner than the distance between particles, {spacing} m, in many places: air on its two sides may \
             feel each other through it; give a smaller dew.spacing_m"
        )
    })
}

fn solid(written: &dew::Solid, folder: &Path) -> Result<(Solid, Vec<String>), SolidError> {
    let pose = Pose::new(written.position_m, written.rotation_deg);
    let shape = match &written.shape {
        Shape::Box { size_m } => solids::Shape::cuboid(*size_m)?,
        Shape::Sphere { radius_m } => solids::Shape::sphere(*radius_m)?,
        Shape::Cylinder { radius_m, height_m } => solids::Shape::cylinder(*radius_m, *height_m)?,
        Shape::Revolution { profile_m } => solids::Shape::Revolution(Profile::new(profile_m.clone())?),
        Shape::WineGlass(glass) => wine_glass(glass).shape()?,
        Shape::Mesh(file) => {
            let mesh = Mesh::read(&folder.join(&file.path), file.unit.map(dew::LengthUnit::in_metres))?;
            let notes = mesh.notes().iter().map(|note| format!("{}: {note}", file.path.display())).collect();
            return Ok((Solid::of_mesh(mesh, pose), notes));
        }
    };
    Ok((Solid::of_shape(shape, pose), Vec::new()))
}

fn wine_glass(glass: &dew::WineGlass) -> WineGlass {
    WineGlass {
        height: glass.height_m,
        bowl_radius: glass.bowl_radius_m,
        foot_radius: glass.foot_radius_m,
        stem_radius: glass.stem_radius_m,
        wall: glass.wall_m,
    }
}

/// The material of a solid or of a layer, at `key` in `dew.solid`.
fn material(key: &str, solid: &str, written: &dew::Material) -> Result<Material, BodyError> {
    match written {
        dew::Material::Named(material) => solids::material(material).copied().ok_or_else(|| BodyError::Material {
            name: solid.into(),
            key: key.into(),
            material: material.clone(),
            known: MATERIALS.iter().map(|material| material.name).collect::<Vec<_>>().join(", "),
        }),
        dew::Material::Own { conductivity_w_per_m_k, heat_capacity_j_per_kg_k, density_kg_per_m3 } => Ok(Material {
            name: "own",
            conductivity: *conductivity_w_per_m_k,
            heat_capacity: *heat_capacity_j_per_kg_k,
            density: *density_kg_per_m3,
            source: "the scene",
        }),
    }
}

/// Solids may touch: particles of one may be in the other by rounding, not by a tenth of a spacing.
fn refuse_overlap(bodies: &[Body], spacing: f64) -> Result<(), BodyError> {
    for (at, one) in bodies.iter().enumerate() {
        for other in bodies.iter().enumerate().filter(|(which, _)| *which != at).map(|(_, other)| other) {
            let [from, to] = other.solid.bounds();
            let inside = |point: &&[f64; 3]| (0..3).all(|axis| (from[axis]..=to[axis]).contains(&point[axis]));
            let depths = one.samples.positions.iter().filter(inside).map(|&at| (at, -other.solid.signed_distance(at)));
            let deepest = depths.max_by(|a, b| a.1.total_cmp(&b.1));
            if let Some((at, depth)) = deepest.filter(|(_, depth)| *depth > 0.1 * spacing) {
                return Err(BodyError::Overlap { one: one.name.clone(), other: other.name.clone(), at, depth });
            }
        }
    }
    Ok(())
}

/// Samples along each side of the box that are tested for air.
const FREE_SAMPLES_PER_SIDE: f64 = 64.0;

/// Refuses a box without a position half a spacing from all solids.
fn refuse_a_full_box(bodies: &[Body], dew: &Dew) -> Result<(), BodyError> {
    let counts = dew.size_m.map(|length| (length / dew.spacing_m).clamp(1.0, FREE_SAMPLES_PER_SIDE) as u32);
    let coordinate = |axis: usize, at: u32| dew.size_m[axis] * (f64::from(at) + 0.5) / f64::from(counts[axis]);
    let is_free = |point: [f64; 3]| bodies.iter().all(|body| body.solid.signed_distance(point) >= 0.5 * dew.spacing_m);
    let mut positions = (0..counts[2])
        .flat_map(|z| (0..counts[1]).flat_map(move |y| (0..counts[0]).map(move |x| [x, y, z])))
        .map(|[x, y, z]| [coordinate(0, x), coordinate(1, y), coordinate(2, z)]);
    if positions.any(is_free) { Ok(()) } else { Err(BodyError::NoRoom { size: dew.size_m }) }
}

//! From a scene to a model.

mod inflows;

use crate::air::{LEAST_SOUND, Properties, SOUND_OVER_MOTION, TemperatureCoefficients};
use crate::dew::{Dew, Setup};
use crate::drops::{DropLaws, MOST_SITES, Retention, SurfaceWater, WATER_DENSITY, most_per_area, smallest_reach};
use crate::fan::Fan;
use crate::humid_air::{HumidAir, ZERO_CELSIUS, is_frost};
use crate::layer::Layer;
use crate::room::{Face, Inflow, Room};
use crate::settings::{Condensation, Humidity, LowUtility, Mean, Settings, WallTreatment};
use crate::solids::sources::HeatSources;
use crate::solids::{Body, Surface, bodies};
use corpuscle_model::ModelError;
use corpuscle_processes::Processes;
use corpuscle_scene::Axis;
use corpuscle_scene::dew::{self as written, HumidityTransport, Scheme, Treatment};
use corpuscle_solids::Solid;
use inflows::Inflows;
use std::path::Path;
use std::sync::Arc;

/// Makes the model of a scene; `seed` is that of everything random, relative paths are taken from `folder`.
///
/// # Errors
/// [`ModelError::Setup`] where a solid cannot be made, or the scene requires what this version cannot do.
pub fn open(scene: &written::Dew, seed: u64, folder: &Path) -> Result<Dew, ModelError> {
    open_on(&Processes::alone(), scene, seed, folder)
}

/// As [`open`], with the air distributed over processes: all of them call it. The first then has the model; the others [follow](Processes::follow) it.
///
/// # Errors
/// As [`open`].
pub fn open_on(processes: &Processes, scene: &written::Dew, seed: u64, folder: &Path) -> Result<Dew, ModelError> {
    refuse_what_cannot_be(scene)?;
    // A file may be missing for one of several processes only.
    let bodies = processes.agree(bodies::open(scene, folder).map_err(ModelError::from), ModelError::Setup)?;
    let start = humid_air(&scene.air);
    if scene.air.mixing_ratio.is_some() {
        check_humidity("dew.air", &start)?;
    }
    // A file may be missing for one of several processes only.
    let inflows =
        processes.agree(Inflows::open(scene, &start, folder).map_err(ModelError::Setup), ModelError::Setup)?;
    let room = room(scene, &inflows);
    refuse_solids_at_inlets(&bodies, &room, scene.spacing_m)?;
    let air = properties(scene, &start, &inflows, &bodies);
    let settings = settings(scene, &start);
    let particles = bodies.iter().map(|body| particles(body, &room)).collect();
    let setup = Setup { settings, air, room, bodies: particles, fans: scene.fan.iter().map(fan).collect(), seed };
    let mut dew = Dew::new_on(processes, &setup, |_| [start.temperature, start.mass_fraction()])?;
    if !releases_heat(scene) {
        dew.without_latent_heat();
    }
    if scene.air.velocity_m_per_s != [0.0; 3] {
        dew.stir(|_| scene.air.velocity_m_per_s);
    }
    let layer = |body: &Body| {
        body.walls.and_then(|_| Layer::new(body, &dew.room, dew.scale.spacing, [&dew.contact, &dew.ghosts]))
    };
    dew.layers = setup.bodies.iter().map(layer).collect();
    dew.inflows = inflows.over_time();
    dew.names = bodies.iter().map(|body| body.name.clone()).collect();
    dew.add_walls(&bodies);
    dew.sources = HeatSources::new(&bodies, &dew.solids, &room, scene.spacing_m);
    dew.held_to = bodies.iter().map(|body| body.held.then(|| body.temperature.clone())).collect();
    dew.buoyant = scene.buoyancy;
    dew.shows = scene.output.clone();
    dew.warnings = warnings(scene, &bodies);
    dew.warnings.extend(dew.lags());
    let solids: Vec<Solid> = bodies.into_iter().map(|body| body.solid).collect();
    let laws = laws(scene, &solids)?;
    dew.lay_drops(laws, Arc::from(solids), water(scene), seed);
    measure_faces(scene, &mut dew)?;
    dew.lead();
    Ok(dew)
}

fn measure_faces(scene: &written::Dew, dew: &mut Dew) -> Result<(), ModelError> {
    let Some(wetting) = &mut dew.wetting else { return Ok(()) };
    for (row, solid) in scene.solid.iter().enumerate() {
        for (at, face) in solid.face.iter().enumerate() {
            if !wetting.measure_face(row, &face.name, face.side.axis_and_end()) {
                return Err(ModelError::Setup(format!(
                    "the face \"{}\" of the solid \"{}\" (dew.solid.{row}.face.{at}): no surface of the solid in the box faces {}, by its own axes before it \
                     is turned; give another side, or leave this face out",
                    face.name,
                    solid.name,
                    face.side.key()
                )));
            }
        }
    }
    Ok(())
}

/// What scenes can say and this version cannot do, by the name of the key.
fn refuse_what_cannot_be(scene: &written::Dew) -> Result<(), ModelError> {
    let refuse = |what: &str| Err(ModelError::Setup(what.into()));
    if humidity_transport(scene) == HumidityTransport::RelativeHumidity && scene.scheme == Scheme::Physical {
        return refuse(
            "dew.transport.humidity = \"relative-humidity\" goes with the scheme \"particle-condensation\" only: give \
             scheme = \"particle-condensation\", or \"mass-fraction\"",
        );
    }
    let is_any =
        |wanted: fn(&written::Face) -> bool| Axis::ALL.into_iter().flat_map(|axis| scene.faces.along(axis)).any(wanted);
    let leaves = is_any(|face| matches!(face, written::Face::Outflow | written::Face::Open));
    if scene.low_utility.is_some() && !leaves {
        return refuse(
            "dew.low_utility: air can leave nowhere, and what is taken out would leave a hole; make a side \"outflow\" or \"open\", or \
             leave [dew.low_utility] out",
        );
    }
    if is_any(|face| matches!(face, written::Face::Inflow(_))) && !leaves {
        return refuse("dew.faces: air comes in and can leave nowhere; make a side \"outflow\" or \"open\"");
    }
    Ok(())
}

/// Air that comes in needs some room before a solid, in spacings.
const BEFORE_INLET: f64 = 1.5;

fn refuse_solids_at_inlets(bodies: &[bodies::Body], room: &Room, spacing: f64) -> Result<(), ModelError> {
    for body in bodies {
        let [from, to] = body.solid.bounds();
        for axis in 0..3 {
            let gaps = [from[axis] - room.low[axis], room.high[axis] - to[axis]];
            for side in 0..2 {
                if matches!(room.faces[axis][side], Face::Inlet(_)) && gaps[side] < BEFORE_INLET * spacing {
                    return Err(ModelError::Setup(format!(
                        "the solid \"{}\" stands in a side of the box where air comes in (dew.faces.{}): leave at least {} m, {} \
                         spacings, between them",
                        body.name,
                        key_of_side(axis, side),
                        BEFORE_INLET * spacing,
                        BEFORE_INLET
                    )));
                }
            }
        }
    }
    Ok(())
}

fn key_of_side(axis: usize, side: usize) -> String {
    format!("{}_{}", ["x", "y", "z"][axis], ["min", "max"][side])
}

fn humidity_transport(scene: &written::Dew) -> HumidityTransport {
    let of_scheme = match scene.scheme {
        Scheme::Physical => HumidityTransport::MassFraction,
        Scheme::ParticleCondensation => HumidityTransport::RelativeHumidity,
    };
    scene.transport.humidity.unwrap_or(of_scheme)
}

fn releases_heat(scene: &written::Dew) -> bool {
    scene.transport.latent_heat.unwrap_or(scene.scheme == Scheme::Physical)
}

/// Air of one of three measures of humidity; the first that is given holds.
fn air_of(celsius: f64, pressure: f64, measures: [Option<f64>; 3]) -> Option<HumidAir> {
    let temperature = celsius + ZERO_CELSIUS;
    let [relative, dew_point, mixing] = measures;
    let relative = relative.map(|humidity| HumidAir::with_relative_humidity(temperature, pressure, humidity));
    let dew_point = dew_point.map(|point| HumidAir::with_dew_point(temperature, pressure, point + ZERO_CELSIUS));
    let mixing = mixing.map(|ratio| HumidAir::with_mixing_ratio(temperature, pressure, ratio));
    relative.or(dew_point).or(mixing)
}

/// Refuses air that holds more vapour than saturated air: it would be fog already.
fn check_humidity(key: &str, air: &HumidAir) -> Result<(), ModelError> {
    let humidity = air.relative_humidity();
    if humidity <= 1.0 + 1e-9 {
        return Ok(());
    }
    let most = HumidAir::with_relative_humidity(air.temperature, air.pressure, 1.0).mixing_ratio();
    Err(ModelError::Setup(format!(
        "{key}.mixing_ratio = {:.6} is more than saturated air at {:.1} °C holds, {most:.6}: such air would be fog already; it is in kg of vapour for a kg of dry air",
        air.mixing_ratio(),
        air.temperature - ZERO_CELSIUS,
    )))
}

fn humid_air(air: &written::Air) -> HumidAir {
    let measures = [air.relative_humidity, air.dew_point_c, air.mixing_ratio];
    let dry = || HumidAir::with_relative_humidity(air.temperature_c + ZERO_CELSIUS, air.pressure_pa, 0.0);
    air_of(air.temperature_c, air.pressure_pa, measures).unwrap_or_else(dry)
}

fn room(scene: &written::Dew, inflows: &Inflows) -> Room {
    let face = |axis: Axis, side: usize| match scene.faces.along(axis)[side] {
        written::Face::Wall => Face::Wall,
        written::Face::Periodic => Face::Periodic,
        written::Face::Open => Face::Open,
        written::Face::Outflow => Face::Outlet,
        written::Face::Inflow(inflow) => {
            let [temperature, vapour] = inflows.at_start(axis, side);
            Face::Inlet(Inflow { velocity: inflow.velocity_m_per_s, temperature, vapour })
        }
    };
    let faces = Axis::ALL.map(|axis| [0, 1].map(|side| face(axis, side)));
    Room { low: [0.0; 3], high: scene.size_m, faces }
}

fn fan(fan: &written::Fan) -> Fan {
    Fan::new(fan.position_m, fan.size_m, fan.velocity_m_per_s)
}

fn walls(treatment: Treatment) -> WallTreatment {
    match treatment {
        Treatment::DensityCorrection => WallTreatment::DensityCorrection,
        Treatment::VirtualForce => WallTreatment::VirtualForce,
        Treatment::Ghost => WallTreatment::Ghosts,
        Treatment::None => WallTreatment::None,
    }
}

fn settings(scene: &written::Dew, start: &HumidAir) -> Settings {
    let by_particles = scene.scheme == Scheme::ParticleCondensation;
    let of_scheme = if by_particles { written::Mean::Arithmetic } else { written::Mean::Harmonic };
    Settings {
        kernel: scene.kernel,
        walls: walls(scene.boundary.treatment),
        mean: match scene.transport.conductivity_mean.unwrap_or(of_scheme) {
            written::Mean::Harmonic => Mean::Harmonic,
            written::Mean::Arithmetic if by_particles => Mean::Diffusivity,
            written::Mean::Arithmetic => Mean::Arithmetic,
        },
        humidity: match humidity_transport(scene) {
            HumidityTransport::MassFraction => Humidity::MassFraction,
            HumidityTransport::RelativeHumidity => Humidity::Relative,
        },
        condensation: if by_particles { Condensation::Particle } else { Condensation::Diffusion },
        gravity: if scene.buoyancy { scene.gravity_m_per_s2 } else { [0.0; 3] },
        low_utility: scene.low_utility.as_ref().map(|low| LowUtility { distance: low.distance, after: low.after_s }),
        time_factor: scene.time_factor,
        threshold: scene.boundary.colour_threshold,
        kappa: scene.boundary.kappa,
        ..Settings::new(scene.spacing_m, start.temperature, start.mass_fraction())
    }
}

fn properties(scene: &written::Dew, start: &HumidAir, inflows: &Inflows, bodies: &[bodies::Body]) -> Properties {
    let transport = &scene.transport;
    let sound = (SOUND_OVER_MOTION * fastest(scene, start, inflows, bodies)).max(LEAST_SOUND);
    let mut air = Properties::of(start, sound);
    if scene.scheme == Scheme::ParticleCondensation {
        air.coefficients = TemperatureCoefficients::default();
    }
    // What the scene gives is the same at all temperatures.
    let set = |property: &mut f64, coefficient: &mut f64, value: Option<f64>| {
        if let Some(value) = value {
            (*property, *coefficient) = (value, 0.0);
        }
    };
    set(
        &mut air.viscosity,
        &mut air.coefficients.viscosity,
        transport.air_viscosity_pa_s.map(|value| value / air.density),
    );
    set(&mut air.conductivity, &mut air.coefficients.conductivity, transport.air_conductivity_w_per_m_k);
    set(&mut air.vapour_diffusivity, &mut air.coefficients.vapour_diffusivity, transport.vapour_diffusivity_m2_per_s);
    air.heat_capacity = transport.air_heat_capacity_j_per_kg_k.unwrap_or(air.heat_capacity);
    air
}

/// The fastest motion to come, m/s: that of the air at the start, at inlets and at fans, or the speed sqrt(g H dT/T) with which warm
/// air would rise through the whole box.
fn fastest(scene: &written::Dew, start: &HumidAir, inflows: &Inflows, bodies: &[bodies::Body]) -> f64 {
    let length = |vector: [f64; 3]| vector.iter().map(|along| along * along).sum::<f64>().sqrt();
    let inlets = Axis::ALL.into_iter().flat_map(|axis| scene.faces.along(axis)).filter_map(|face| match face {
        written::Face::Inflow(inflow) => Some(length(inflow.velocity_m_per_s)),
        _ => None,
    });
    let of_solids = bodies.iter().flat_map(|body| body.temperature.rows().iter().map(|row| row[1] + ZERO_CELSIUS));
    let temperatures = of_solids.chain(inflows.temperatures()).chain(HeatSources::temperatures(bodies));
    let contrast = temperatures.map(|other| (other / start.temperature - 1.0).abs()).fold(0.0, f64::max);
    let gravity = if scene.buoyancy { scene.gravity_m_per_s2 } else { [0.0; 3] };
    let fall: f64 = (0..3).map(|axis| gravity[axis].abs() * scene.size_m[axis]).sum();
    let fans = scene.fan.iter().map(|written| fan(written).speed());
    inlets.chain(fans).fold(length(scene.air.velocity_m_per_s).max((contrast * fall).sqrt()), f64::max)
}

/// The particles of a solid that are in the room.
fn particles(body: &bodies::Body, room: &Room) -> Body {
    let samples = &body.samples;
    let kept: Vec<usize> = (0..samples.positions.len()).filter(|&at| room.contains(samples.positions[at])).collect();
    let solid = body.solid.clone();
    let surface: Surface = Arc::new(move |position| solid.signed_distance(position));
    Body {
        positions: kept.iter().map(|&at| samples.positions[at]).collect(),
        volumes: kept.iter().map(|&at| samples.volumes[at]).collect(),
        areas: kept.iter().map(|&at| samples.areas[at]).collect(),
        material: body.material.into(),
        temperature: body.temperature.at(0.0) + ZERO_CELSIUS,
        held: body.held,
        surface: Some(surface),
        walls: body.treatment.map(walls),
    }
}

/// How water lies on each solid.
fn water(scene: &written::Dew) -> Vec<SurfaceWater> {
    let of = |solid: &written::Solid| match solid.wetting {
        written::Wetting::Drops => {
            SurfaceWater::Drops { sites_per_area: solid.sites_per_m2.unwrap_or(scene.drops.sites_per_m2) }
        }
        written::Wetting::Film => SurfaceWater::Film,
    };
    scene.solid.iter().map(of).collect()
}

/// Radius of the smallest drops where the scene does not say and there is room for as many, m.
const SMALLEST: f64 = 1e-5;

/// Sites that a scene has at most where it does not say how small the smallest drops are.
const DEFAULT_MAX_SITES: f64 = 2e5;

fn laws(scene: &written::Dew, solids: &[Solid]) -> Result<DropLaws, ModelError> {
    let with = |smallest_radius: f64| DropLaws { smallest_radius, ..laws_but_smallest(scene) };
    // Sites at most, of drops so large.
    let sites = |radius: f64| -> f64 {
        let most = most_per_area(smallest_reach(&with(radius)));
        solids.iter().zip(water(scene)).map(|(solid, water)| solid.area() * water.sites_per_area().min(most)).sum()
    };
    // They fall at most as one over the radius squared.
    let large_enough = |most: f64| {
        let mut radius = SMALLEST;
        while sites(radius) > most {
            radius *= 1.1;
        }
        radius
    };
    match scene.drops.smallest_radius_m {
        None => Ok(with(large_enough(DEFAULT_MAX_SITES))),
        Some(radius) if sites(radius) <= MOST_SITES => Ok(with(radius)),
        Some(radius) => Err(ModelError::Setup(format!(
            "dew.drops.smallest_radius_m = {radius}: drops could begin at {:.1e} positions on the solids, more than the {MOST_SITES:.0e} that can be followed; give {:.1e} or more, or fewer dew.drops.sites_per_m2",
            sites(radius),
            large_enough(MOST_SITES)
        ))),
    }
}

fn laws_but_smallest(scene: &written::Dew) -> DropLaws {
    DropLaws {
        contact_angle: scene.drops.contact_angle_deg.to_radians(),
        retention: retention(scene),
        viscosity: if scene.scheme == Scheme::ParticleCondensation { 0.0 } else { scene.drops.viscosity_pa_s },
        pressure: scene.air.pressure_pa,
        surface_tension: scene.drops.surface_tension_n_per_m,
        gravity: scene.gravity_m_per_s2,
        smallest_radius: SMALLEST,
        density: WATER_DENSITY,
        time_factor: scene.time_factor,
    }
}

/// Friction of drops where none is given in scheme `particle-condensation`: it holds a hemisphere of 2 mm on an upright pane.
const PATENTED_FRICTION: f64 = 1.3e-4;

fn retention(scene: &written::Dew) -> Retention {
    let has_angles = scene.drops.receding_angle_deg.is_some() || scene.drops.advancing_angle_deg.is_some();
    let of_scheme = (scene.scheme == Scheme::ParticleCondensation && !has_angles).then_some(PATENTED_FRICTION);
    let [receding, advancing] = scene.drops.angles_deg().map(f64::to_radians);
    scene.drops.friction.or(of_scheme).map_or(Retention::Hysteresis { receding, advancing }, Retention::Friction)
}

fn warnings(scene: &written::Dew, bodies: &[bodies::Body]) -> Vec<String> {
    let mut warnings: Vec<String> = bodies.iter().flat_map(|body| body.notes.iter().cloned()).collect();
    let coldest = |body: &bodies::Body| body.temperature.rows().iter().map(|row| row[1]).fold(f64::INFINITY, f64::min);
    for body in bodies.iter().filter(|body| is_frost(coldest(body) + ZERO_CELSIUS)) {
        warnings.push(format!(
            "the solid \"{}\" is at {} °C: below 0 °C there would be frost, which is out of scope; what condenses there is taken as \
             water",
            body.name,
            coldest(body)
        ));
    }
    if is_frost(scene.air.temperature_c + ZERO_CELSIUS) {
        warnings.push(format!(
            "the air is at {} °C: below 0 °C there would be frost and ice, which are out of scope; fog there is taken as water",
            scene.air.temperature_c
        ));
    }
    if scene.time_factor != 1.0 {
        warnings.push(format!(
            "time_factor: temperatures of solids that are free and the water on all of them change {0} times faster than in reality; the air, its \
             flows of heat and vapour, and drops that slide do not. A second of the run is {0} s for the solids",
            scene.time_factor
        ));
    }
    if !scene.buoyancy && scene.gravity_m_per_s2 != [0.0; 3] {
        warnings.push("buoyancy = false: air neither rises nor sinks, only drops feel gravity".into());
    }
    for solid in
        scene.solid.iter().filter(|solid| solid.treatment.unwrap_or(scene.boundary.treatment) == Treatment::None)
    {
        warnings.push(format!("treatment = \"none\": nothing keeps the air out of the solid \"{}\"", solid.name));
    }
    warnings
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_scene::Scene;

    fn held(scheme: &str, drops: &str) -> Retention {
        let text = format!(
            "run.until_s = 1\n[dew]\nsize_m = [0.01, 0.01, 0.01]\nspacing_m = 0.002\nscheme = \"{scheme}\"\n\
             air = {{ temperature_c = 25, relative_humidity = 0.5 }}\ndrops = {{ {drops} }}\n"
        );
        retention(Scene::parse(&text, "test", &[]).unwrap().dew().unwrap())
    }

    #[test]
    fn drops_are_held_as_the_scene_says_or_else_the_scheme() {
        let by_angles = |receding: f64, advancing: f64| Retention::Hysteresis {
            receding: receding.to_radians(),
            advancing: advancing.to_radians(),
        };
        assert_eq!(held("physical", ""), by_angles(74.0, 106.0));
        assert_eq!(held("particle-condensation", ""), Retention::Friction(PATENTED_FRICTION));
        for scheme in ["physical", "particle-condensation"] {
            assert_eq!(held(scheme, "friction = 1e-4"), Retention::Friction(1e-4));
            assert_eq!(held(scheme, "receding_angle_deg = 80, advancing_angle_deg = 95"), by_angles(80.0, 95.0));
        }
    }
}

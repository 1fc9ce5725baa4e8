//! Air pressed on solids stays outside them.

use super::{advance, ready, rows};
use crate::device::{is_reduced, reduction};
use crate::{Case, Options, Row};
use corpuscle_dew::air::{Particle, Properties};
use corpuscle_dew::solids::{Body, Material};
use corpuscle_dew::{Dew, Face, Room, Settings, Setup, WallTreatment};
use corpuscle_model::{Model, ModelError};
use corpuscle_solids::{Pose, Shape, Solid};
use std::f64::consts::PI;
use std::sync::Arc;
use std::time::Instant;

pub(super) const BOUNDARIES: Case = Case {
    name: "dew/boundaries",
    about: "Air pressed on a plane, a cylinder and a ball, and a column settled by its weight: depth of the deepest air, width of \
            the gap before the surface and density of the first layer, for density correction, virtual force and ghosts, and \
            for no treatment at all as control; what ghosts cost over density correction. The air is humid and the solids are \
            cold: water condenses on them and nowhere inside.",
    slow: true,
    reduced: 10.0,
    run: boundaries,
};

/// Spacing, m, and speed of sound, m/s.
const D: f64 = 1e-3;
const SOUND: f64 = 1.0;

/// Temperature of the air, and of the solids, on which its vapour condenses, K.
const WARM: f64 = 293.0;
const COLD: f64 = 278.0;

/// Vapour in the air, part of the mass: 90 % of what it can hold.
const VAPOUR: f64 = 0.013;

/// Half a spacing under the surface air is inside: as far as it stands above it at the start.
const INSIDE: f64 = -0.5;

const GLASS: Material = Material { conductivity: 1.4, heat_capacity: 750.0, density: 2500.0 };

/// A solid with air pressed on it.
struct Pressed {
    name: &'static str,
    size: [f64; 3],
    walls_along_z: bool,
    solid: Result<Solid, String>,
    /// Signed distance to the surface that is pressed on.
    distance: fn([f64; 3]) -> f64,
    /// Volume between the surface and a distance from it.
    shell: fn(f64) -> f64,
    velocity: [f64; 3],
    acceleration: [f64; 3],
}

/// Radius of cylinder and ball.
const RADIUS: f64 = 5.0 * D;

fn pressed() -> [Pressed; 4] {
    let solid = |shape: Result<Shape, corpuscle_solids::SolidError>, position: [f64; 3], turn: f64| {
        let placed = |shape| Solid::of_shape(shape, Pose::new(position, [turn, 0.0, 0.0]));
        shape.map(placed).map_err(|error| error.to_string())
    };
    let slab = || solid(Shape::cuboid([10.0 * D, 10.0 * D, 4.0 * D]), [5.0 * D, 5.0 * D, 2.0 * D], 0.0);
    // The weight of the column is 5 % of rho c^2. Without treatment its lower end is a free surface, where air is held together by a pressure below that
    // at rest: with 3 % it hangs from the wall above and is stretched by 0.7 spacings, no more; with 9 % it tears off. The wind is 3 % of the speed of sound.
    let weight = [0.0, 0.0, -0.05 * SOUND * SOUND / (22.0 * D)];
    let (wind, push) = ([0.03 * SOUND, 0.0, 0.0], [2e-4 * SOUND * SOUND / (24.0 * D), 0.0, 0.0]);
    let plane = |name, velocity| Pressed {
        name,
        size: [10.0 * D, 10.0 * D, 26.0 * D],
        walls_along_z: true,
        solid: slab(),
        distance: |[_, _, z]| z - 4.0 * D,
        shell: |width| 100.0 * D * D * width,
        velocity,
        acceleration: weight,
    };
    [
        plane("plane", [0.0, 0.0, -0.05 * SOUND]),
        plane("column", [0.0; 3]),
        Pressed {
            name: "cylinder",
            size: [24.0 * D, 8.0 * D, 24.0 * D],
            walls_along_z: false,
            solid: solid(Shape::cylinder(RADIUS, 8.0 * D), [12.0 * D, 4.0 * D, 12.0 * D], 90.0),
            distance: |[x, _, z]| (x - 12.0 * D).hypot(z - 12.0 * D) - RADIUS,
            shell: |width| 8.0 * D * PI * ((RADIUS + width).powi(2) - RADIUS.powi(2)),
            velocity: wind,
            acceleration: push,
        },
        Pressed {
            name: "ball",
            size: [20.0 * D; 3],
            walls_along_z: false,
            solid: solid(Shape::sphere(RADIUS), [10.0 * D; 3], 0.0),
            distance: |[x, y, z]| (x - 10.0 * D).hypot(y - 10.0 * D).hypot(z - 10.0 * D) - RADIUS,
            shell: |width| 4.0 / 3.0 * PI * ((RADIUS + width).powi(3) - RADIUS.powi(3)),
            velocity: wind,
            acceleration: push,
        },
    ]
}

/// Results of a run.
struct Found {
    /// Signed distance of the deepest air at any time, in spacings.
    deepest: f64,
    /// Width of what is empty before the surface, in spacings.
    gap: f64,
    /// Density of the first layer over that of the air farther off.
    first_layer: f64,
    /// Water on the solid's particles under its boundary particles, over all water on it.
    water_inside: f64,
    /// Wall-clock time over that of a particle and step, s.
    cost: f64,
}

fn boundaries(_: &Options) -> Vec<Row> {
    rows(BOUNDARIES.name, measure())
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let name = BOUNDARIES.name;
    let mut rows = Vec::new();
    for case in pressed() {
        let of = |measure: &str| format!("{measure}_{}", case.name);
        let corrected = press(&case, WallTreatment::DensityCorrection)?;
        rows.push(Row::at_least(name, &of("deepest_over_spacing"), corrected.deepest, "", 0.0));
        rows.push(Row::at_most(name, &of("gap_over_spacing"), corrected.gap.abs(), "", 0.1));
        rows.push(Row::at_most(name, &of("first_layer_density_error"), (corrected.first_layer - 1.0).abs(), "", 0.03));
        rows.push(Row::at_most(name, &of("water_inside_over_water_on"), corrected.water_inside, "", 0.0));
        let control = press(&case, WallTreatment::None)?;
        rows.push(Row::at_most(name, &of("deepest_over_spacing_without_treatment"), control.deepest, "", INSIDE));
        // The rest is only shown.
        if is_reduced() {
            continue;
        }
        let ghosts = press(&case, WallTreatment::Ghosts)?;
        let forced = press(&case, WallTreatment::VirtualForce)?;
        let beside = |measure: &str, value, bound, why| Row::beside(name, &of(measure), value, "", bound, why);
        let shown = "another treatment, shown beside density correction";
        rows.push(beside("gap_over_spacing_virtual_force", forced.gap, 0.1, shown));
        rows.push(beside("depth_over_spacing_virtual_force", -forced.deepest, 0.0, shown));
        rows.push(beside("gap_over_spacing_ghosts", ghosts.gap, 0.1, shown));
        rows.push(beside("depth_over_spacing_ghosts", -ghosts.deepest, 0.0, shown));
        rows.push(beside("cost_of_ghosts_over_density_correction", ghosts.cost / corrected.cost, 1.0, shown));
    }
    Ok(rows)
}

/// Presses for as long as sound takes to go so many spacings.
const LASTING: f64 = 300.0;

fn press(case: &Pressed, walls: WallTreatment) -> Result<Found, ModelError> {
    let solid = case.solid.clone().map_err(ModelError::Setup)?;
    let mut body = Body::sampled(solid, D, GLASS, COLD, true)?;
    body.surface = Some(Arc::new(case.distance));
    let faces =
        [[Face::Periodic; 2], [Face::Periodic; 2], [if case.walls_along_z { Face::Wall } else { Face::Periodic }; 2]];
    let solid_volume: f64 = body.volumes.iter().sum();
    let setup = Setup {
        settings: Settings {
            walls,
            gravity: [0.0; 3],
            fog: false,
            body_acceleration: case.acceleration,
            ..Settings::new(D, WARM, VAPOUR)
        },
        air: Properties { viscosity: 1e-5, ..Properties::at_room_temperature(SOUND) },
        room: Room { low: [0.0; 3], high: case.size, faces },
        bodies: vec![body],
        fans: Vec::new(),
        seed: 1,
    };
    let mut dew = Dew::new(&setup, |_| [WARM, VAPOUR])?;
    dew.stir(|_| case.velocity);
    let mut dew = ready(dew)?;
    let (mut deepest, mut gaps, mut layers, mut spent) = (f64::INFINITY, Vec::new(), Vec::new(), 0.0);
    let samples = (150.0 / reduction()) as u32;
    for sample in 1..=samples {
        let start = Instant::now();
        advance(&mut dew, f64::from(sample) / f64::from(samples) * LASTING / reduction() * D / SOUND)?;
        spent += start.elapsed().as_secs_f64();
        let distances: Vec<f64> = dew.air().iter().map(|particle| (case.distance)(particle.position)).collect();
        deepest = distances.iter().copied().fold(deepest, f64::min);
        if 2 * sample > samples {
            let room = case.size.iter().product::<f64>() - solid_volume;
            gaps.push(gap(case, &distances, room));
            layers.push(first_layer(dew.air(), &distances));
        }
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    Ok(Found {
        deepest: deepest / D,
        gap: mean(&gaps) / D,
        first_layer: mean(&layers),
        water_inside: water_inside(&dew),
        cost: spent / dew.particle_steps() as f64,
    })
}

/// Water on particles of the solids that are no boundary particles, over all water on them; not a number where none is.
fn water_inside(dew: &Dew) -> f64 {
    let water = || dew.solids().particles.iter().zip(dew.water_on_solids());
    let inside: f64 = water().filter(|(particle, _)| particle.normal.is_none()).map(|(_, water)| water).sum();
    inside / dew.water_on_solids().iter().sum::<f64>()
}

/// Width of the vacuum that there would be before the surface if the air began at once beyond it, m: from how much air is
/// missing within 2 to 4 spacings. `room` is the volume of all air.
fn gap(case: &Pressed, distances: &[f64], room: f64) -> f64 {
    let within = |width: f64| distances.iter().filter(|distance| **distance < width).count() as f64;
    let beyond = (distances.len() as f64 - within(3.0 * D)) / (room - (case.shell)(3.0 * D));
    let widths = (0..20).map(|k| (2.05 + 0.1 * f64::from(k)) * D);
    let missing = widths.map(|width| {
        let area = ((case.shell)(1.001 * width) - (case.shell)(width)) / (0.001 * width);
        ((case.shell)(width) - within(width) / beyond) / area
    });
    missing.sum::<f64>() / 20.0
}

/// Mean density within a spacing of the surface over that between 2 and 4.
fn first_layer(air: &[Particle], distances: &[f64]) -> f64 {
    let mean = |from: f64, to: f64| {
        let here = air.iter().zip(distances).filter(|(_, distance)| (from * D..to * D).contains(*distance));
        let densities: Vec<f64> = here.map(|(particle, _)| particle.density).collect();
        densities.iter().sum::<f64>() / densities.len() as f64
    };
    mean(f64::NEG_INFINITY, 1.0) / mean(2.0, 4.0)
}

//! A film of condensed water that runs down plates and a ball: its thickness beside Nusselt's.

use super::rows;
use super::slide::laws;
use crate::device::{is_reduced, reduced, refuse_on_gpu};
use crate::{Case, Options, Row};
use corpuscle_dew::drops::{DropLaws, Drops, Patch, SurfaceWater, Surfaces, WATER_DENSITY};
use corpuscle_model::{CompensatedSum, ModelError};
use corpuscle_solids::{Pose, Shape, Solid};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;
use std::sync::Arc;

pub(super) const FALLING_FILM: Case = Case {
    name: "dew/falling-film",
    about: "Filmwise condensation at a prescribed rate on a dry plate that stands upright, is turned by 30 degrees in its plane or inclined, and on a ball whose patches lie at \
            random positions, at three widths of patches: the thickness while it grows and when it is steady beside the solution of Nusselt (1916) for an even rate, \
            and what leaves at the edges beside what condenses.",
    slow: false,
    reduced: 1.5,
    run: falling_film,
};

const VISCOSITY: f64 = 1.0016e-3;
const GRAVITY: f64 = 9.81;

/// Rate of condensation, kg/(m2 s).
const RATE: f64 = 1e-4;

/// Side of the plates and radius of the ball, m.
const SIDE: f64 = 0.04;
const RADIUS: f64 = 0.02;

/// Widths of the patches, m.
const WIDTHS: [f64; 3] = [2e-3, 1e-3, 0.5e-3];

/// When the film has grown for a part of the way, and when it is steady, s.
const TIMES: [f64; 2] = [50.0, 300.0];

/// Time between two gains, s.
const STEP: f64 = 0.5;

fn falling_film(_: &Options) -> Vec<Row> {
    rows(FALLING_FILM.name, measure())
}

fn measure() -> Result<Vec<Row>, ModelError> {
    let name = FALLING_FILM.name;
    refuse_on_gpu("films, which stay with the CPU")?;
    let mut rows = Vec::new();
    let mut lost = 0.0_f64;
    let kinds: [Kind; 4] = [
        ("upright", |width| plate(width, 0.0, 90.0)),
        ("turned_30_deg", |width| plate(width, 30.0, 90.0)),
        ("inclined_20_deg_turned_45_deg", |width| plate(width, 45.0, 20.0)),
        ("ball", ball),
    ];
    for (kind, surface) in kinds {
        let mut errors = [[0.0; 2]; 3];
        for (error, &width) in errors.iter_mut().zip(reduced(&WIDTHS)) {
            let film = grow(surface(width));
            *error = film.errors;
            lost = lost.max(film.lost);
            // Round the ball the film does not grow evenly.
            let first = usize::from(kind == "ball");
            for (error, time) in error.iter().zip(TIMES).skip(first) {
                let measure = format!("error_{kind}_{}_mm_{time}_s", width * 1e3);
                // On a ball the patches lie unevenly, the finer ones as much as the others.
                let bound = if kind == "ball" { 0.035 } else { 22.0 * width };
                rows.push(Row::at_most(name, &measure, *error, "", bound));
            }
            let measure = format!("error_of_outflow_{kind}_{}_mm", width * 1e3);
            rows.push(Row::at_most(name, &measure, film.outflow, "", 1e-3));
        }
        if !is_reduced() && kind != "ball" {
            let order = |at: usize| (errors[0][at] / errors[2][at]).ln() / (WIDTHS[0] / WIDTHS[2]).ln();
            rows.push(Row::at_least(name, &format!("order_{kind}"), order(1), "", 0.8));
        }
    }
    rows.push(Row::at_most(name, "water_lost", lost, "", 1e-12));
    Ok(rows)
}

/// A name, and a surface with patches of a width, m.
type Kind = (&'static str, fn(f64) -> Surface);

/// Patches of a solid, and the thickness of the film on each in a steady state, m; none where it is not compared.
struct Surface {
    laws: DropLaws,
    solid: Solid,
    patches: Vec<Patch>,
    steady: Vec<Option<f64>>,
}

fn cubic(along: f64) -> f64 {
    (3.0 * VISCOSITY * RATE * along / (WATER_DENSITY.powi(2) * GRAVITY)).cbrt()
}

/// A plate in the plane x = 0. Its patches are turned by an angle in its plane, and it is inclined by another to the horizontal, degrees.
fn plate(width: f64, turned: f64, inclined: f64) -> Surface {
    let [(sin, cos), (steep, flat)] = [turned, inclined].map(|angle: f64| angle.to_radians().sin_cos());
    let count = (SIDE / width).round() as usize;
    let at = |index: usize| (index as f64 + 0.5) * width - 0.5 * SIDE;
    let patch =
        |y: f64, z: f64| Patch { solid: 0, position: [0.0, y, z], normal: [1.0, 0.0, 0.0], half_width: 0.5 * width };
    // The distance along which water has been gathered: up to the edge.
    let gathered = |y: f64, z: f64| ((0.5 * SIDE + y) / sin).min((0.5 * SIDE - z) / cos);
    let positions = || (0..count * count).map(|k| (at(k % count), at(k / count)));
    Surface {
        laws: DropLaws { gravity: [-GRAVITY * flat, GRAVITY * steep * sin, -GRAVITY * steep * cos], ..water() },
        solid: Solid::of_shape(Shape::Box { size: [0.01, SIDE, SIDE] }, Pose::new([-0.005, 0.0, 0.0], [0.0; 3])),
        patches: positions().map(|(y, z)| patch(y, z)).collect(),
        steady: positions().map(|(y, z)| Some(cubic(gathered(y, z) / steep))).collect(),
    }
}

/// The upper part of a ball with patches at the positions of a spiral, displaced at random. Between two parallels all that condenses above flows down:
/// h^3 = 3 mu j R / (rho^2 g (1 + cos theta)).
fn ball(width: f64) -> Surface {
    let count = (4.0 * PI * RADIUS * RADIUS / (width * width)).round() as usize;
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut normals = Vec::with_capacity(count);
    for at in 0..(0.8 * count as f64) as usize {
        // The golden angle spreads them evenly.
        let (up, angle) = (1.0 - (2 * at + 1) as f64 / count as f64, 2.399_963 * at as f64);
        let across = (1.0 - up * up).sqrt();
        let even = [across * angle.cos(), across * angle.sin(), up];
        let moved = even.map(|along| along + 0.1 * width / RADIUS * random.random_range(-1.0..1.0));
        let length = moved.iter().map(|along| along * along).sum::<f64>().sqrt();
        normals.push(moved.map(|along| along / length));
    }
    let steady = |up: f64| (-0.5..0.95).contains(&up).then(|| cubic(RADIUS / (1.0 + up)));
    Surface {
        laws: DropLaws { gravity: [0.0, 0.0, -GRAVITY], ..water() },
        solid: Solid::of_shape(Shape::Sphere { radius: RADIUS }, Pose::new([0.0; 3], [0.0; 3])),
        patches: normals
            .iter()
            .map(|&normal| Patch {
                solid: 0,
                position: normal.map(|along| RADIUS * along),
                normal,
                half_width: 0.5 * (4.0 * PI * RADIUS * RADIUS / count as f64).sqrt(),
            })
            .collect(),
        steady: normals.iter().map(|normal| steady(normal[2])).collect(),
    }
}

fn water() -> DropLaws {
    DropLaws { viscosity: VISCOSITY, ..laws(0.0, 0.5 * PI, 5e-5) }
}

/// What a film was like.
struct Film {
    /// Mean error of the thickness at each of [`TIMES`], over its mean.
    errors: [f64; 2],
    /// Relative error of what leaves at the end.
    outflow: f64,
    /// Water of which the account says nothing, over what condensed.
    lost: f64,
}

/// Lets water condense on a dry surface.
fn grow(Surface { laws, solid, patches, steady }: Surface) -> Film {
    let areas: Vec<f64> = patches.iter().map(Patch::area).collect();
    let surfaces =
        Surfaces { solids: Arc::from([solid]), water: vec![SurfaceWater::Film], patches, room: [[-1.0; 3], [1.0; 3]] };
    let mut drops = Drops::new(laws, surfaces, 1);
    let gains: Vec<f64> = areas.iter().map(|area| RATE * STEP * area).collect();
    let each = gains.iter().sum::<f64>();
    let mut film = Film { errors: [0.0; 2], outflow: 0.0, lost: 0.0 };
    let steps = (TIMES[1] / STEP) as u32;
    let condensed: CompensatedSum = (0..steps).map(|_| each).collect();
    for step in 1..=steps {
        let before = drops.dripped();
        drops.condense(&gains);
        drops.advance(STEP);
        film.outflow = ((drops.dripped() - before) / each - 1.0).abs();
        let time = f64::from(step) * STEP;
        if let Some(at) = TIMES.iter().position(|&seen| (seen - time).abs() < 0.5 * STEP) {
            film.errors[at] = error(&drops, &areas, &steady, time);
        }
    }
    film.lost = ((drops.water() + drops.dripped()) / condensed.value() - 1.0).abs();
    film
}

/// Mean difference of the thickness from the solution over the mean: it grows evenly where nothing has come from the upper edge yet.
fn error(drops: &Drops, areas: &[f64], steady: &[Option<f64>], time: f64) -> f64 {
    let [mut difference, mut all] = [0.0; 2];
    for ((share, area), steady) in drops.shares().iter().zip(areas).zip(steady) {
        let Some(steady) = steady else { continue };
        let exact = steady.min(RATE * time / WATER_DENSITY);
        difference += (share.water / (WATER_DENSITY * area) - exact).abs();
        all += exact;
    }
    difference / all
}

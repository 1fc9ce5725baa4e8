//! Pictures of a model that steps on the device that draws: sinks are given glances, and its particles stay there.
#![cfg(all(feature = "gpu", feature = "pictures"))]

use corpuscle::gpu::{Gpu, require_gpu};
use corpuscle::model::{Frame, Model, ModelError};
use corpuscle::pictures::Glance;
use corpuscle::scene::{Scene, builtin};
use corpuscle::{Error, Simulation, Sink};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Places of particles, m, by their identities.
type Places = Vec<(u64, [f64; 3])>;

/// Takes pictures of a model, or of glances at one device.
#[derive(Default)]
struct Album {
    gpu: Option<Gpu>,
    /// Times, s, and where particles are.
    pictures: Vec<(f64, Places)>,
    glances: usize,
    /// When it refuses more.
    full_at: Option<usize>,
}

impl Album {
    fn keep(&mut self, time: f64, mut places: Places) -> Result<(), Error> {
        places.sort_unstable_by_key(|(id, _)| *id);
        self.pictures.push((time, places));
        let is_full = self.full_at == Some(self.pictures.len());
        if is_full { Err(ModelError::Device("the album is full".into()).into()) } else { Ok(()) }
    }
}

fn places(frame: &Frame, name: &str) -> Places {
    let sets = frame.sets.iter().filter(|set| set.name == name);
    sets.flat_map(|set| set.id.iter().copied().zip(set.position.iter().copied())).collect()
}

impl Sink for Album {
    fn picture_period(&self) -> Option<f64> {
        Some(0.13)
    }

    fn picture(&mut self, model: &dyn Model) -> Result<(), Error> {
        let frame = model.frame();
        self.keep(frame.time, places(&frame, if model.name() == "flood" { "water" } else { "drops" }))
    }

    fn glances_on(&self) -> Option<&Gpu> {
        self.gpu.as_ref()
    }

    fn glance(&mut self, glance: &Glance) -> Result<(), Error> {
        self.glances += 1;
        let seen = match (&glance.on_device, &self.gpu) {
            (Some(particles), Some(gpu)) => {
                let from = particles.origin;
                let place = |place: [f32; 3]| std::array::from_fn(|axis| from[axis] + f64::from(place[axis]));
                let all = particles.read(gpu).unwrap();
                all.iter().map(|particle| (u64::from(particle.id), place(particle.position))).collect()
            }
            _ => places(&glance.frame, "drops"),
        };
        self.keep(glance.frame.time, seen)
    }
}

fn open(name: &str, changes: &[(&str, &str)], gpu: &Gpu) -> Simulation {
    let changes: Vec<_> = changes.iter().map(|(path, value)| ((*path).to_owned(), (*value).to_owned())).collect();
    let scene = Scene::parse(builtin(name).unwrap().text, name, &changes).unwrap();
    let mut simulation = Simulation::open(scene, Path::new("")).unwrap();
    simulation.use_this_gpu(gpu.clone()).unwrap();
    simulation
}

const DAM: [(&str, &str); 3] = [("flood.spacing_m", "2"), ("run.until_s", "1.3"), ("run.frame_every_s", "0.52")];

fn run(mut simulation: Simulation, album: &mut Album) -> Result<(), Error> {
    simulation.run(&mut [album], &AtomicBool::new(false), &mut |_| {}).map(|_| ())
}

#[test]
fn glances_are_given_when_pictures_are_due_and_show_what_the_model_does() {
    let Some(gpu) = require_gpu("glances at a model") else { return };
    // Drops so small, and so far apart, are soon seen.
    let dew = [
        ("run.until_s", "0.5"),
        ("run.frame_every_s", "0.26"),
        ("dew.drops.smallest_radius_m", "2e-5"),
        ("dew.drops.sites_per_m2", "1e7"),
    ];
    for (name, changes) in [("flood/dam-break", &DAM[..]), ("dew/pane", &dew)] {
        let [mut of_model, mut of_glances] = [None, Some(gpu.clone())].map(|gpu| Album { gpu, ..Album::default() });
        run(open(name, changes, &gpu), &mut of_model).unwrap();
        run(open(name, changes, &gpu), &mut of_glances).unwrap();
        let [one, other] = [&of_model, &of_glances].map(|album| &album.pictures);
        assert!(one.iter().map(|(time, _)| time).eq(other.iter().map(|(time, _)| time)), "{name}");
        // That of the start is one of the model.
        assert!((of_model.glances, of_glances.glances) == (0, other.len() - 1) && other.len() >= 5, "{name}");
        for ((time, one), (_, other)) in one.iter().zip(other) {
            assert_eq!(one.len(), other.len(), "{name}, {time} s");
            for ((id, one), (same_id, other)) in one.iter().zip(other) {
                let is_near = (0..3).all(|axis| (one[axis] - other[axis]).abs() < 1e-4);
                assert!(id == same_id && is_near, "{name}, {time} s: {one:?} {other:?}");
            }
        }
        assert!(other.last().is_some_and(|(_, places)| places.len() > 10), "{name}");
    }
}

/// Two pictures fall between two steps, again and again.
#[test]
fn a_model_that_is_called_back_gives_no_glance_twice() {
    let Some(gpu) = require_gpu("glances at a model that is called back") else { return };
    let mut changes = DAM.to_vec();
    changes.push(("run.checkpoint_every_wall_s", "1e-6"));
    let mut album = Album { gpu: Some(gpu.clone()), ..Album::default() };
    run(open("flood/dam-break", &changes, &gpu), &mut album).unwrap();
    let times: Vec<f64> = album.pictures.iter().map(|(time, _)| *time).collect();
    assert!(times.len() == 11 && times.windows(2).all(|pair| pair[0] < pair[1]), "{times:?}");
}

#[test]
fn a_glance_that_cannot_be_taken_ends_the_run() {
    let Some(gpu) = require_gpu("a glance that fails") else { return };
    let mut album = Album { gpu: Some(gpu.clone()), full_at: Some(4), ..Album::default() };
    let error = run(open("flood/dam-break", &DAM, &gpu), &mut album).unwrap_err();
    assert!(error.to_string().contains("full") && album.pictures.len() == 4, "{error}");
}

#[test]
fn another_device_than_the_one_that_steps_gets_the_model() {
    let Some(gpu) = require_gpu("glances on another device") else { return };
    let mut album = Album { gpu: Some(Gpu::open().unwrap()), ..Album::default() };
    run(open("flood/dam-break", &DAM, &gpu), &mut album).unwrap();
    assert!(album.glances == 0 && album.pictures.len() == 11, "{} {}", album.glances, album.pictures.len());
}

//! Messages between the window and a worker that runs the physics: no memory is shared.

use super::{Backend, Command, Event, Opened, scene_text};
use crate::snapshot::Snapshot;
use corpuscle::model::Surface;
use corpuscle::pictures::{Made, Scenery};
use corpuscle::scene::Scene;
use corpuscle::terrain::Terrain;
use corpuscle_render::HeightField;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::sync::Arc;

/// A message to the worker.
#[derive(Serialize, Deserialize)]
pub(super) enum ToWorker {
    /// Compute scenes that are opened from now on on this backend.
    Backend(Backend),
    /// A command.
    Command(Command),
    /// A file to be held in memory under a path.
    File(PathBuf, #[serde(with = "serde_bytes")] Vec<u8>),
    /// Make a scene of a flood over the terrain in a file that is held.
    Flood(PathBuf),
    /// Free all files in memory but those in this folder.
    KeepFiles(PathBuf),
    /// The last snapshot was taken: another may be sent.
    Taken,
}

/// A message from the worker.
#[derive(Serialize, Deserialize)]
pub(super) enum FromWorker {
    Opened(OpenedMessage),
    Refused(String),
    NotChanged(String),
    Ended,
    Fault(String),
    Broken(String),
    Snapshot(Arc<Snapshot>),
    /// Name and text of the scene of [`ToWorker::Flood`], or why there is none.
    Flood(Result<(String, String), String>),
}

/// A scene that is open at its start, without what the window makes anew from it.
#[derive(Serialize, Deserialize)]
pub(super) struct OpenedMessage {
    number: u64,
    #[serde(with = "scene_text")]
    scene: Box<Scene>,
    surfaces: Vec<Surface>,
    /// The terrain ([`Terrain::to_bytes`]): the page does not read it again.
    #[serde(with = "serde_bytes")]
    terrain: Option<Vec<u8>>,
    /// The heights of the ground as drawn.
    drawn: Option<Drawn>,
    gauges: Vec<String>,
    warnings: Vec<String>,
    computed_on: Option<String>,
    end: f64,
}

/// Heights on a grid, as numbers that are copied whole.
#[derive(Serialize, Deserialize)]
struct Drawn {
    origin: [f64; 2],
    cell: [f64; 2],
    nodes: [usize; 2],
    #[serde(with = "serde_bytes")]
    heights: Vec<u8>,
}

impl Drawn {
    fn of(field: HeightField) -> Self {
        let HeightField { origin, cell, nodes, heights } = field;
        Self { origin, cell, nodes, heights: bytemuck::cast_slice(&heights).to_vec() }
    }

    fn open(self) -> HeightField {
        let Self { origin, cell, nodes, heights } = self;
        HeightField { origin, cell, nodes, heights: bytemuck::pod_collect_to_vec(&heights) }
    }
}

impl OpenedMessage {
    /// The scene as the window takes it: shapes of solids, and ground from a formula, are made again.
    ///
    /// # Errors
    /// Why it cannot be opened, as text.
    pub fn open(self) -> Result<Opened, String> {
        let Self { number, scene, surfaces, terrain, drawn, gauges, warnings, computed_on, end } = self;
        let terrain = terrain.map(|bytes| Terrain::from_bytes(&bytes)).transpose()?;
        let made = Made { terrain, drawn: drawn.map(Drawn::open), surfaces };
        let scenery = Scenery::of_scene((*scene).clone(), made).map_err(|error| error.to_string())?;
        let scene = *scene;
        Ok(Opened { number, scene, pictures: None, scenery, gauges, warnings, computed_on, history: None, end })
    }
}

impl FromWorker {
    /// The message of an event. A worker makes no films.
    pub fn of(event: Event) -> Option<Self> {
        Some(match event {
            Event::Opened(opened) => {
                let Opened { number, scene, scenery, gauges, warnings, computed_on, end, .. } = *opened;
                let (scene, surfaces) = (Box::new(scene), scenery.surfaces().to_vec());
                let terrain = scenery.terrain().and_then(Terrain::to_bytes);
                let drawn = scenery.drawn_heights().map(Drawn::of);
                Self::Opened(OpenedMessage {
                    number,
                    scene,
                    surfaces,
                    terrain,
                    drawn,
                    gauges,
                    warnings,
                    computed_on,
                    end,
                })
            }
            Event::Refused(what) => Self::Refused(what),
            Event::NotChanged(what) => Self::NotChanged(what),
            Event::Filmed(_) => return None,
            Event::Ended => Self::Ended,
            Event::Fault(what) => Self::Fault(what),
            Event::Broken(what) => Self::Broken(what),
        })
    }
}

/// The bytes of a message.
///
/// # Errors
/// Where it has none, as of a scene that no file can hold.
pub(super) fn bytes<T: Serialize>(message: &T) -> Result<Vec<u8>, String> {
    postcard::to_stdvec(message).map_err(|error| format!("a message could not be written: {error}"))
}

/// A message from its bytes.
///
/// # Errors
/// Where they are none.
pub(super) fn message<T: for<'de> Deserialize<'de>>(bytes: &[u8]) -> Result<T, String> {
    postcard::from_bytes(bytes).map_err(|error| format!("a message could not be read: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::runner::Runner;
    use crate::physics::{Change, Shared};
    use corpuscle::gpu::wait_for;
    use corpuscle::scene::builtin;
    use std::sync::mpsc::channel;

    /// Sends a message.
    fn sent<T: Serialize + for<'de> Deserialize<'de>>(what: &T) -> T {
        message(&bytes(what).unwrap()).unwrap()
    }

    /// A scene that a runner without a window runs, by commands that were sent; what it answers, sent.
    fn run(name: &str, commands: Vec<Command>) -> (Vec<FromWorker>, Arc<Snapshot>) {
        let (events, answers) = channel();
        let shared = Arc::new(Shared::new(Arc::new(|| {})));
        let mut runner = Runner::new(events, shared.clone(), Backend::Auto, None);
        let scene = Scene::parse(builtin(name).unwrap().text, name, &[]).unwrap();
        for command in [Command::Open(Box::new(scene), "".into())].into_iter().chain(commands) {
            let ToWorker::Command(command) = sent(&ToWorker::Command(command)) else { panic!() };
            wait_for(runner.take(command));
        }
        let events = answers.try_iter().filter_map(FromWorker::of).map(|event| sent(&event)).collect();
        (events, shared.newest().unwrap())
    }

    #[test]
    fn a_scene_goes_to_a_worker_and_its_snapshots_come_back_to_the_bit() {
        for name in ["gas/maxwell", "flood/dam-break", "dew/pane"] {
            let (events, snapshot) = run(name, vec![Command::Step(0.01)]);
            let [FromWorker::Opened(_)] = &events[..] else { panic!("{name}: {}", events.len()) };
            let FromWorker::Snapshot(back) = sent(&FromWorker::Snapshot(snapshot.clone())) else { panic!() };
            assert!(back.frame.time > 0.0 && back.frame == snapshot.frame, "{name}");
            assert_eq!(back.measures.gauges.len(), snapshot.measures.gauges.len());
            assert_eq!(
                (&back.measures.names, &back.measures.ledger),
                (&snapshot.measures.names, &snapshot.measures.ledger)
            );
            assert_eq!((&back.paths, back.container), (&snapshot.paths, snapshot.container));
            let FromWorker::Opened(opened) = events.into_iter().next().unwrap() else { panic!() };
            let opened = opened.open().unwrap();
            assert!(opened.pictures.is_none() && opened.end > 0.0 && !opened.gauges.is_empty(), "{name}");
        }
    }

    #[test]
    fn changes_are_sent() {
        let heat = Change::Model(vec![corpuscle::GasLiveChange::Heat(4.0).into()]);
        let (_, before) = run("gas/maxwell", vec![Command::Step(0.0)]);
        let (_, after) = run("gas/maxwell", vec![Command::Change(heat), Command::Step(0.0)]);
        let temperature = |snapshot: &Snapshot| {
            let at = snapshot.measures.names.iter().position(|name| name == "gas.temperature").unwrap();
            snapshot.measures.gauges[at]
        };
        assert!((temperature(&after) / temperature(&before) - 4.0).abs() < 1e-9);
        let gauge = Change::Gauge { name: "P9".into(), at: [1.0, 0.5] };
        let (events, snapshot) = run("flood/dam-break", vec![Command::Change(gauge), Command::Step(0.0)]);
        assert!(events.len() == 1 && snapshot.measures.names.iter().any(|name| name.starts_with("P9.")));
    }

    #[test]
    fn what_is_refused_is_told() {
        let heat = Change::Model(vec![corpuscle::GasLiveChange::Heat(4.0).into()]);
        let (events, _) = run("flood/dam-break", vec![Command::Change(heat)]);
        assert!(matches!(&events[1], FromWorker::NotChanged(why) if why.contains("no gas")));
        assert!(message::<ToWorker>(&[9, 9, 9]).is_err());
    }
}

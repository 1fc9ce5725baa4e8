//! Simulations: opened scenes that advance.

use crate::arrays;
use crate::error::{exception, run_error, scene_error};
use crate::watch::watched;
use corpuscle::model::{Balance, ModelError};
use corpuscle::models::of;
use corpuscle::models::parameters;
use corpuscle::output::{FrameFormat, Summary, write_picture};
use corpuscle::parameters::{Current, as_number, set, value_at};
use corpuscle::pictures::{Moment, PictureSettings, Pictures};
use corpuscle::scene::Scene;
use corpuscle::{Error, Progress, Recorder, Sink};
use numpy::{IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyList};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, MutexGuard, TryLockError};

/// Rows of gauges since the simulation was opened.
#[derive(Default)]
struct Rows {
    times: Vec<f64>,
    values: Vec<Vec<f64>>,
    /// Where the present run began: a run has a row there, whether it is due or not.
    begin: Option<f64>,
}

impl Rows {
    /// The row of now.
    fn beginning(simulation: &corpuscle::Simulation) -> Self {
        let model = simulation.model();
        Self { times: vec![model.time()], values: vec![model.gauge_row()], begin: None }
    }
}

impl Sink for Rows {
    fn gauges(&mut self, time: f64, row: &[f64]) -> Result<(), Error> {
        if self.begin != Some(time) {
            self.times.push(time);
            self.values.push(row.to_vec());
        }
        Ok(())
    }
}

/// What changes while a simulation advances.
struct State {
    simulation: corpuscle::Simulation,
    /// The run's folder, where one is written.
    recorder: Option<Recorder>,
    rows: Rows,
    /// Live changes of the scene: keys, and values as written in TOML.
    changes: Vec<(String, String)>,
}

impl State {
    fn new((simulation, recorder): (corpuscle::Simulation, Option<Recorder>)) -> Result<Self, Error> {
        // A resumed run has written its rows so far.
        let rows = if recorder.is_none() { Rows::beginning(&simulation) } else { Rows::default() };
        Ok(Self { simulation, recorder, rows, changes: Vec::new() })
    }

    /// The scene with the live changes so far, and with one more.
    fn changed(&self, more: Option<(&str, &str)>) -> Result<(Vec<(String, String)>, Scene), Error> {
        let mut changes = self.changes.clone();
        if let Some((key, value)) = more {
            set(&mut changes, key, Some(value.into()));
        }
        let text = self.simulation.scene().to_toml()?;
        let scene = Scene::parse(&text, "the scene", &changes)?;
        Ok((changes, scene))
    }

    fn change(&mut self, key: &str, value: &str) -> Result<(), Error> {
        let (_, now) = self.changed(None)?;
        let document = now.to_toml()?.parse().unwrap_or_default();
        let offered = parameters(self.simulation.scene(), &now, document)?;
        let live = || offered.groups.iter().flat_map(|group| &group.parameters).filter(|known| known.live.is_some());
        let Some(found) = live().find(|known| known.path == key) else {
            let keys: Vec<_> = live().map(|known| known.path.as_str()).collect();
            let what = format!("{key} cannot be changed while it runs; {}", listed(&keys));
            return Err(ModelError::Setup(what).into());
        };
        let (changes, _) = self.changed(Some((key, value)))?;
        let number = |path: &str| value_at(&offered.document, path).and_then(as_number);
        let current = Current { scene: self.simulation.scene(), number: &number };
        let Some(change) = found.live.and_then(|live| live(key, value, &current)) else {
            let what = format!("{key} = {value}: this is no value of it; give a number, as in the scene");
            return Err(ModelError::Setup(what).into());
        };
        self.simulation.make_change(change)?;
        self.changes = changes;
        Ok(())
    }
}

/// An opened scene.
///
/// Threads are its own, so that a process that is forked before it opens a simulation has working ones.
#[pyclass(frozen)]
pub struct Simulation {
    state: Mutex<State>,
    threads: ThreadPool,
}

impl Simulation {
    fn lock(&self, py: Python<'_>) -> PyResult<MutexGuard<'_, State>> {
        match self.state.try_lock() {
            Ok(state) => Ok(state),
            Err(TryLockError::Poisoned(state)) => Ok(state.into_inner()),
            Err(TryLockError::WouldBlock) => Err(run_error(
                py,
                "this simulation advances at the moment; wait for the call that advances it, or open another one",
            )),
        }
    }

    /// Does work on the threads of this simulation while Python waits.
    fn watch<T: Send>(
        &self,
        py: Python<'_>,
        on_progress: Option<&Bound<'_, PyAny>>,
        work: impl FnOnce(&mut State, &AtomicBool, &mut (dyn FnMut(&Progress) + Send)) -> Result<T, Error> + Send,
    ) -> PyResult<T> {
        let mut state = self.lock(py)?;
        let (state, stop) = (&mut *state, AtomicBool::new(false));
        let threads = &self.threads;
        let done = watched(py, &stop, on_progress, |report| threads.install(|| work(state, &stop, report)))?;
        done.map_err(|error| exception(py, &error))
    }

    /// Reads from the model on the threads of this simulation: those that a process shares do not survive a fork.
    fn read<T: Send>(&self, py: Python<'_>, read: impl FnOnce(&mut State) -> T + Send) -> PyResult<T> {
        let mut state = self.lock(py)?;
        let state = &mut *state;
        Ok(py.detach(|| self.threads.install(|| read(state))))
    }

    /// Refuses what the files of a run that was resumed would lack.
    fn refuse_resumed(&self, py: Python<'_>) -> PyResult<()> {
        let what = "a resumed run goes on by `run` alone, so that its files are complete; open its scene anew for this";
        if self.lock(py)?.recorder.is_some() { Err(run_error(py, what)) } else { Ok(()) }
    }

    fn opened(
        py: Python<'_>,
        threads: Option<usize>,
        open: impl FnOnce() -> Result<(corpuscle::Simulation, Option<Recorder>), Error> + Send,
    ) -> PyResult<Self> {
        let pool = ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build();
        let threads = pool.map_err(|error| run_error(py, &format!("cannot start the threads: {error}")))?;
        let never = AtomicBool::new(false);
        let opened = watched(py, &never, None, |_| threads.install(|| open().and_then(State::new)))?;
        let state = opened.map_err(|error| exception(py, &error))?;
        Ok(Self { state: Mutex::new(state), threads })
    }
}

#[pymethods]
impl Simulation {
    /// Opens a scene on the CPU or, with `gpu`, on a GPU.
    #[new]
    #[pyo3(signature = (scene, threads=None, gpu=false))]
    fn new(py: Python<'_>, scene: &crate::scene::Scene, threads: Option<usize>, gpu: bool) -> PyResult<Self> {
        let (folder, scene) = (&scene.folder, scene.scene.clone());
        Self::opened(py, threads, move || {
            let mut simulation = corpuscle::Simulation::open(scene, folder)?;
            if gpu {
                simulation.use_gpu()?;
            }
            Ok((simulation, None))
        })
    }

    /// Opens an interrupted run from its folder, to be run to its end.
    #[staticmethod]
    #[pyo3(signature = (folder, threads=None))]
    fn resume(py: Python<'_>, folder: PathBuf, threads: Option<usize>) -> PyResult<Self> {
        Self::opened(py, threads, move || {
            Recorder::resume(&folder).map(|(simulation, recorder)| (simulation, Some(recorder)))
        })
    }

    /// Runs to the end of the scene, with a folder if one is given; the summary as JSON.
    #[pyo3(signature = (folder=None, frames="vtp", on_progress=None))]
    fn run(
        &self,
        py: Python<'_>,
        folder: Option<PathBuf>,
        frames: &str,
        on_progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<String> {
        let frames = format_of(py, frames)?;
        let summary = self.watch(py, on_progress, |state, stop, report| {
            let State { simulation, recorder, rows, .. } = state;
            rows.begin = Some(simulation.model().time());
            if let Some(folder) = folder {
                *recorder = Some(Recorder::create(&folder, simulation, frames)?);
            }
            let mut sinks: Vec<&mut dyn Sink> = vec![rows];
            sinks.extend(recorder.iter_mut().map(|recorder| recorder as &mut dyn Sink));
            let summary = simulation.run(&mut sinks, stop, report);
            drop(sinks);
            *recorder = None;
            summary
        })?;
        json(py, &summary)
    }

    /// Advances to a time, s.
    #[pyo3(signature = (time, on_progress=None))]
    fn advance(&self, py: Python<'_>, time: f64, on_progress: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        self.refuse_resumed(py)?;
        self.watch(py, on_progress, |state, stop, report| {
            let State { simulation, rows, .. } = state;
            simulation.advance_to(time, stop, rows, report)
        })
    }

    /// Changes a value while it runs: its key, and its value as written in TOML.
    fn change(&self, py: Python<'_>, key: &str, value: &str) -> PyResult<()> {
        self.read(py, |state| state.change(key, value))?.map_err(|error| exception(py, &error))
    }

    /// Simulated time, s.
    #[getter]
    fn time(&self, py: Python<'_>) -> PyResult<f64> {
        Ok(self.lock(py)?.simulation.model().time())
    }

    /// The end of the scene, s.
    #[getter]
    fn until(&self, py: Python<'_>) -> PyResult<f64> {
        Ok(self.lock(py)?.simulation.scene().run.until_s)
    }

    /// Steps taken (of a gas: collisions).
    #[getter]
    fn steps(&self, py: Python<'_>) -> PyResult<u64> {
        Ok(self.lock(py)?.simulation.model().steps())
    }

    /// Particles now.
    #[getter]
    fn particles(&self, py: Python<'_>) -> PyResult<usize> {
        Ok(self.lock(py)?.simulation.model().particles())
    }

    /// Where it computes: `cpu` or `gpu`.
    #[getter]
    fn backend(&self, py: Python<'_>) -> PyResult<&'static str> {
        Ok(self.lock(py)?.simulation.model().backend())
    }

    /// The scene as run, as TOML.
    #[getter]
    fn toml(&self, py: Python<'_>) -> PyResult<String> {
        let text = self.lock(py)?.simulation.scene().to_toml();
        text.map_err(|error| exception(py, &Error::from(error)))
    }

    /// Warnings and choices that were made, in sentences.
    #[getter]
    fn warnings(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.read(py, |state| [state.simulation.notes(), &state.simulation.warnings()].concat())
    }

    /// The particles now.
    fn frame<'py>(&self, py: Python<'py>) -> PyResult<(f64, Bound<'py, PyList>)> {
        let (frame, is_si) = self.read(py, |state| {
            let (scene, model) = (state.simulation.scene(), state.simulation.model());
            (model.frame(), of(scene).is_ok_and(|kind| kind.has_si_units(scene)))
        })?;
        arrays::frame(py, frame, is_si)
    }

    /// Rows of gauges so far: headers, times, and an array of a row for each time.
    fn gauges<'py>(&self, py: Python<'py>) -> PyResult<(Vec<String>, Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let state = self.lock(py)?;
        let headers: Vec<_> = state.simulation.model().gauge_columns().iter().map(|column| column.header()).collect();
        let values: Vec<f64> = state.rows.values.iter().flat_map(|row| row.iter().copied()).collect();
        let times = state.rows.times.clone().into_pyarray(py);
        let values = values.into_pyarray(py).reshape([state.rows.times.len(), headers.len()])?;
        Ok((headers, times.into_any(), values.into_any()))
    }

    /// Maps now.
    fn maps<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        arrays::maps(py, self.read(py, |state| state.simulation.model().maps())?)
    }

    /// The grid of the maps; none without terrain.
    fn grid<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let state = self.lock(py)?;
        state.simulation.terrain().map(|terrain| arrays::grid(py, terrain)).transpose()
    }

    /// Charts now.
    fn charts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        arrays::charts(py, self.read(py, |state| state.simulation.model().charts())?)
    }

    /// Trajectories of the particles that are followed.
    fn paths<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        arrays::paths(py, self.read(py, |state| state.simulation.model().paths())?)
    }

    /// The ledger: quantities, and what there was of each at the start, came in, went out, is there now, and the relative error.
    fn ledger(&self, py: Python<'_>) -> PyResult<Vec<(&'static str, [f64; 5])>> {
        let balances = self.read(py, |state| state.simulation.model().ledger().balances)?;
        let row = |balance: &Balance| {
            let &Balance { quantity, initial, inflow, outflow, now, .. } = balance;
            (quantity, [initial, inflow, outflow, now, balance.relative_error()])
        };
        Ok(balances.iter().map(row).collect())
    }

    /// The whole state, to the bit.
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &self.read(py, |state| state.simulation.model().save())?))
    }

    /// Takes back a state of the same scene.
    fn restore(&self, py: Python<'_>, saved: &[u8]) -> PyResult<()> {
        self.refuse_resumed(py)?;
        let restored = self.read(py, |state| -> Result<(), ModelError> {
            state.simulation.model_mut().restore(saved)?;
            state.rows = Rows::beginning(&state.simulation);
            Ok(())
        })?;
        restored.map_err(|error| exception(py, &error.into()))
    }

    /// A picture as an array of rows, columns and red, green, blue, opacity.
    fn picture<'py>(&self, py: Python<'py>, width: u32, height: u32) -> PyResult<Bound<'py, PyAny>> {
        let drawn = self.watch(py, None, |state, _, _| draw(state, [width, height]))?;
        let shape = [drawn.height as usize, drawn.width as usize, 4];
        Ok(drawn.rgba.into_pyarray(py).reshape(shape)?.into_any())
    }

    /// Writes a picture as a PNG file.
    fn write_picture(&self, py: Python<'_>, path: PathBuf, width: u32, height: u32) -> PyResult<()> {
        self.watch(py, None, |state, _, _| {
            let drawn = draw(state, [width, height])?;
            Ok(write_picture(&path, [drawn.width, drawn.height], &drawn.rgba)?)
        })
    }
}

fn draw(state: &mut State, size: [u32; 2]) -> Result<corpuscle::gpu::Image, Error> {
    let model = state.simulation.model();
    let settings = PictureSettings { size, ..PictureSettings::default() };
    let mut pictures = Pictures::open(&state.simulation, settings)?;
    let (frame, paths) = (model.frame(), model.paths());
    pictures.draw(&Moment { frame: &frame, on_device: None, paths: &paths, container: model.container() })
}

fn format_of(py: Python<'_>, name: &str) -> PyResult<FrameFormat> {
    match name {
        "vtp" => Ok(FrameFormat::Vtp),
        "csv" => Ok(FrameFormat::Csv),
        "xyz" => Ok(FrameFormat::Xyz),
        "none" => Ok(FrameFormat::None),
        _ => {
            Err(scene_error(py, &format!("frames = {name:?} is not known; give \"vtp\", \"csv\", \"xyz\" or \"none\"")))
        }
    }
}

fn json(py: Python<'_>, summary: &Summary) -> PyResult<String> {
    serde_json::to_string(summary).map_err(|error| run_error(py, &format!("the summary cannot be written: {error}")))
}

fn listed(keys: &[&str]) -> String {
    match keys {
        [] => "no value of this scene can: open it anew with the change".into(),
        keys => format!("what can: {}", keys.join(", ")),
    }
}

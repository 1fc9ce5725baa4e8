//! Runs that processes started by `mpirun` share.

use crate::args::RunOptions;
use crate::interrupt::stop_on_interrupt;
use crate::refusal::refuse;
use crate::scene_argument::{self, Named};
use crate::terrain::fetch_for;
use corpuscle::Simulation;
use corpuscle::processes::Processes;
use corpuscle::scene::Scene;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// What launchers of MPI programs set: Open MPI; MPICH and its kin; Slurm and others by PMIx.
#[cfg(feature = "mpi")]
const SET_BY_LAUNCHERS: [&str; 3] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"];

/// The processes of the run: those of `mpirun`, or this one alone.
///
/// # Errors
/// Where `mpirun` has started several of a program without MPI.
#[cfg(feature = "mpi")]
pub fn processes() -> anyhow::Result<Processes> {
    // MPI is not started for one process: Open MPI would start a program beside it.
    let is_launched = SET_BY_LAUNCHERS.iter().any(|name| std::env::var_os(name).is_some());
    Ok(if is_launched { corpuscle_mpi::connect() } else { Processes::alone() })
}

/// This process alone.
///
/// # Errors
/// Where `mpirun` has started several: each would run the whole scene.
#[cfg(not(feature = "mpi"))]
pub fn processes() -> anyhow::Result<Processes> {
    let above = |name: &str, least: usize| {
        let number = std::env::var(name).ok().and_then(|number| number.parse().ok());
        number.is_some_and(|number: usize| number > least)
    };
    // As Open MPI and MPICH set the number of processes, and PMIx that of this one.
    if above("OMPI_COMM_WORLD_SIZE", 1) || above("PMI_SIZE", 1) || above("PMIX_RANK", 0) {
        return Err(refuse(
            "mpirun has started several processes, and this program is built without MPI; build it with `cargo build --release --features mpi`",
        ));
    }
    Ok(Processes::alone())
}

/// Opens the same scene as the first process, and takes part in its run. The first has the same errors, reports them, and ends with their status; `mpirun` would
/// end it before that where another process ended with one.
pub fn follow(processes: &Processes, options: &RunOptions) -> ExitCode {
    // Ctrl-C reaches all processes; the first says when to stop.
    let opened = stop_on_interrupt().and_then(|stop| open(processes, options, &stop));
    if let Ok(mut simulation) = opened {
        simulation.follow(processes);
    }
    ExitCode::SUCCESS
}

fn open(processes: &Processes, options: &RunOptions, stop: &Arc<AtomicBool>) -> anyhow::Result<Simulation> {
    if let Some(folder) = &options.resume {
        let scene = read_of_run(processes, folder)?;
        return Ok(Simulation::open_to_restore_on(processes, scene, folder)?);
    }
    let named = read(processes, options, stop)?;
    Ok(Simulation::open_on(processes, named.scene, &named.folder)?)
}

/// The scene of a run, whose terrain is fetched by the first process where it names a server; in all processes, with the same error in all.
///
/// # Errors
/// Where any process cannot read it, or the first cannot fetch.
pub fn read(processes: &Processes, options: &RunOptions, stop: &Arc<AtomicBool>) -> anyhow::Result<Named> {
    let named = scene_argument::read(options.scene.scene.as_deref(), &options.scene.overrides());
    let named = processes.agree(named, refuse)?;
    let fetched = if processes.is_first() { fetch_for(&named.scene, stop) } else { Ok(()) };
    processes.agree(fetched, refuse)?;
    Ok(named)
}

/// The scene of a run that is resumed; in all processes, with the same error in all.
///
/// # Errors
/// Where any process cannot read it.
pub fn read_of_run(processes: &Processes, folder: &Path) -> anyhow::Result<Scene> {
    let scene = Scene::read(&folder.join("scene.toml"), &[]).map_err(|error| corpuscle::Error::from(error).into());
    processes.agree(scene, refuse)
}

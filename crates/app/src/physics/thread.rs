//! The physics in its own thread.

use super::runner::Runner;
use super::{Backend, Command, Devices, Event, Shared};
use crate::background_device::BackgroundDevice;
use crate::snapshot::{Snapshot, Wake};
use crate::view_state::ViewState;
use corpuscle::gpu::{Gpu, wait_for};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, PoisonError};
use std::thread::JoinHandle;

/// The handle of the physics thread. Dropping it ends the thread.
pub struct Physics {
    commands: Option<Sender<Command>>,
    events: Receiver<Event>,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl Physics {
    /// Starts the thread: `gpu`, if there is one, draws pictures and may take the steps too, `background` draws films.
    ///
    /// # Errors
    /// Where the thread cannot be started.
    pub(crate) fn start(
        gpu: Option<&Gpu>,
        background: BackgroundDevice,
        backend: Backend,
        wake: Wake,
    ) -> std::io::Result<Self> {
        let (commands, taken) = channel();
        let (sender, events) = channel();
        let shared = Arc::new(Shared::new(wake));
        let devices = gpu.map(|gpu| Devices { gpu: gpu.clone(), background });
        let runner = Runner::new(sender, shared.clone(), backend, devices);
        let own = shared.clone();
        let thread = std::thread::Builder::new().name("physics".into()).spawn(move || run(runner, &taken, &own))?;
        Ok(Self { commands: Some(commands), events, shared, thread: Some(thread) })
    }

    /// Sends a command. Never waits.
    pub fn send(&self, command: Command) {
        if let Some(commands) = &self.commands {
            // Set before the command is sent, so that it does not end the command's own slice.
            self.shared.stop.store(true, Ordering::Relaxed);
            // A thread that has ended has sent an event.
            let _ = commands.send(command);
        }
    }

    /// Sets the camera of films. Never waits.
    pub fn see(&self, view_state: ViewState) {
        *self.shared.view_state.lock().unwrap_or_else(PoisonError::into_inner) = view_state;
    }

    /// Sets whether a particle is followed: the particles are then read back from the GPU regularly. Never waits.
    pub fn follow(&self, follows: bool) {
        self.shared.follows.store(follows, Ordering::Relaxed);
    }

    /// The events since the last call, the oldest first.
    pub fn events(&self) -> Vec<Event> {
        self.events.try_iter().collect()
    }

    /// The newest snapshot.
    pub fn newest(&self) -> Option<Arc<Snapshot>> {
        self.shared.newest()
    }
}

impl Drop for Physics {
    fn drop(&mut self) {
        self.commands = None;
        self.shared.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Takes commands and advances until the sender of commands is dropped.
fn run(mut runner: Runner, commands: &Receiver<Command>, shared: &Shared) {
    loop {
        let next = match runner.time_left() {
            None => commands.recv().map_err(|_| RecvTimeoutError::Disconnected),
            Some(left) => commands.recv_timeout(left),
        };
        shared.stop.store(false, Ordering::Relaxed);
        // A panic must not end the window.
        let done = catch_unwind(AssertUnwindSafe(|| match next {
            Ok(command) => {
                wait_for(runner.take(command));
                true
            }
            Err(RecvTimeoutError::Timeout) => {
                wait_for(runner.slice());
                true
            }
            Err(RecvTimeoutError::Disconnected) => false,
        }));
        match done {
            Ok(true) => {}
            Ok(false) => return runner.end_film(),
            Err(_) => runner.broken(),
        }
    }
}

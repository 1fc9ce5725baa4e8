//! The page's handle of the worker.

use crate::background_device::BackgroundDevice;
use crate::physics::message::{FromWorker, ToWorker, bytes, message};
use crate::physics::{Backend, Command, Event};
use crate::snapshot::{Snapshot, Wake};
use crate::view_state::ViewState;
use crate::{Source, Start};
use corpuscle::gpu::Gpu;
use corpuscle::terrain::{in_memory, keep_in_memory};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use std::sync::mpsc::Sender;
use wasm_bindgen::prelude::*;
use web_sys::js_sys::Uint8Array;
use web_sys::{MessageEvent, Worker, WorkerOptions, WorkerType};

/// The script of the worker, beside the page.
const SCRIPT: &str = "worker.js";
const BROKEN: &str = "the scene was ended: it took more memory than a page has (4 GB), or an internal error stopped it. Open it again or make \
                      it smaller, or run it with the program (corpuscle view)";

/// A flood over a file that the worker is asked to make a scene of.
struct Flood {
    /// The folder of the file.
    folder: PathBuf,
    /// Takes what is to be opened.
    opens: Sender<Result<Start, String>>,
}

/// The handle of the worker. Dropping it ends the worker.
pub struct Physics {
    link: Rc<RefCell<Link>>,
    received: Rc<RefCell<Received>>,
}

/// The link to the worker. One that broke down is replaced when the next scene is opened.
struct Link {
    worker: RunningWorker,
    backend: Backend,
    wake: Wake,
    received: Rc<RefCell<Received>>,
    /// Files that the worker holds, which are also in the page's memory.
    held: Vec<PathBuf>,
}

/// A worker, and what calls back when it says something. Dropping it ends the worker.
struct RunningWorker {
    worker: Worker,
    _callbacks: [Closure<dyn FnMut(MessageEvent)>; 2],
    /// Messages that wait until the worker has started; none once it has.
    waiting: Rc<RefCell<Option<Vec<Vec<u8>>>>>,
}

/// What came from the worker.
#[derive(Default)]
struct Received {
    events: VecDeque<FromWorker>,
    newest: Option<Arc<Snapshot>>,
    /// What the worker is to be told.
    answers: Vec<ToWorker>,
    /// Who waits for the scene of a flood over a file.
    floods: VecDeque<Flood>,
    /// True once the worker broke down: it takes no more messages.
    is_broken: bool,
    /// True while the worker opens a scene: it takes no message before that is done.
    is_opening: bool,
}

impl Physics {
    /// Starts the worker.
    ///
    /// # Errors
    /// Where the browser starts none.
    pub(crate) fn start(_: Option<&Gpu>, _: BackgroundDevice, backend: Backend, wake: Wake) -> std::io::Result<Self> {
        let received = Rc::<RefCell<Received>>::default();
        let worker = RunningWorker::start(&received, &wake);
        let worker = worker.map_err(|error| std::io::Error::other(format!("{error:?}")))?;
        let link = Link { worker, backend, wake, received: received.clone(), held: Vec::new() };
        link.send(&ToWorker::Backend(backend));
        Ok(Self { link: Rc::new(RefCell::new(link)), received })
    }

    /// Sends a command. Never waits.
    pub fn send(&self, command: Command) {
        self.link.borrow_mut().command(command);
    }

    /// What gives files to the worker.
    pub(crate) fn holder(&self) -> FileHolder {
        FileHolder(self.link.clone())
    }

    /// Takes the camera of films, of which there are none.
    pub fn see(&self, _: ViewState) {}

    /// Sets whether a particle is followed; all particles come with every snapshot.
    pub fn follow(&self, _: bool) {}

    /// The events since the last call, the oldest first.
    pub fn events(&self) -> Vec<Event> {
        let events = std::mem::take(&mut self.received.borrow_mut().events);
        events.into_iter().filter_map(event).collect()
    }

    /// The newest snapshot.
    pub fn newest(&self) -> Option<Arc<Snapshot>> {
        let answers = std::mem::take(&mut self.received.borrow_mut().answers);
        for answer in answers {
            self.link.borrow_mut().send(&answer);
        }
        self.received.borrow().newest.clone()
    }
}

/// Gives files to the worker.
pub(crate) struct FileHolder(Rc<RefCell<Link>>);

impl FileHolder {
    /// Has the worker, and the page, free all files but those in a folder.
    pub fn keep(&self, folder: &Path) {
        let mut link = self.0.borrow_mut();
        if link.held.iter().any(|path| !path.starts_with(folder)) {
            link.held.retain(|path| path.starts_with(folder));
            link.send(&ToWorker::KeepFiles(folder.to_owned()));
            keep_in_memory(folder);
        }
    }

    /// Has the worker hold a file in memory under a path.
    pub fn hold(&self, path: PathBuf, bytes: &[u8]) {
        let mut link = self.0.borrow_mut();
        link.send(&ToWorker::File(path.clone(), bytes.to_vec()));
        link.held.push(path);
    }

    /// Has the worker make a scene of a flood over the terrain in a file that it holds: the page would stand still meanwhile. What is to
    /// be opened goes to `opens`.
    pub fn flood(&self, path: PathBuf, opens: Sender<Result<Start, String>>) {
        let mut link = self.0.borrow_mut();
        if let Err(error) = link.replace_broken() {
            // The receiver is gone when another file was dropped since.
            let _ = opens.send(Err(error));
            return;
        }
        // The folder tells which files its terrain needs.
        let folder = path.parent().map_or_else(PathBuf::new, Path::to_owned);
        link.received.borrow_mut().floods.push_back(Flood { folder, opens });
        link.send(&ToWorker::Flood(path));
    }
}

impl Drop for RunningWorker {
    fn drop(&mut self) {
        // What it has said already must not call what is gone.
        self.worker.set_onmessage(None);
        self.worker.set_onerror(None);
        self.worker.terminate();
    }
}

impl Link {
    /// Sends a command; a scene is opened by a new worker where the one before broke down, or still opens another scene.
    fn command(&mut self, command: Command) {
        let is_opened = matches!(command, Command::Open(..));
        if is_opened && self.received.borrow().is_opening {
            self.received.borrow_mut().broke();
        }
        if self.received.borrow().is_broken {
            match command {
                Command::Open(..) => {
                    if let Err(what) = self.replace_broken() {
                        return self.received.borrow_mut().events.push_back(FromWorker::Broken(what));
                    }
                }
                Command::Play | Command::Step(_) => {
                    return self.received.borrow_mut().events.push_back(FromWorker::Broken(BROKEN.into()));
                }
                _ => return,
            }
        }
        if is_opened {
            self.received.borrow_mut().is_opening = true;
        }
        self.send(&ToWorker::Command(command));
    }

    /// Replaces a worker that broke down.
    ///
    /// # Errors
    /// Why there is none, as text.
    fn replace_broken(&mut self) -> Result<(), String> {
        let is_broken = self.received.borrow().is_broken;
        if is_broken {
            let what = |error| format!("the browser starts no worker for the physics: {error:?}; load the page again");
            self.restart().map_err(what)?;
        }
        Ok(())
    }

    /// Starts a new worker with the backend and the files of the one before.
    fn restart(&mut self) -> Result<(), JsValue> {
        self.worker = RunningWorker::start(&self.received, &self.wake)?;
        *self.received.borrow_mut() = Received::default();
        self.send(&ToWorker::Backend(self.backend));
        let held = self.held.iter().filter_map(|path| Some((path, in_memory(path)?)));
        let files: Vec<_> = held.map(|(path, bytes)| ToWorker::File(path.clone(), bytes.to_vec())).collect();
        files.iter().for_each(|file| self.send(file));
        Ok(())
    }

    fn send(&self, message: &ToWorker) {
        let Ok(bytes) = bytes(message) else { return };
        match &mut *self.worker.waiting.borrow_mut() {
            Some(waiting) => waiting.push(bytes),
            None => post(&self.worker.worker, &bytes),
        }
    }
}

fn post(worker: &Worker, bytes: &[u8]) {
    let array = Uint8Array::from(bytes);
    // A worker that was ended takes no more messages.
    let _ = worker.post_message_with_transfer(&array, &web_sys::js_sys::Array::of1(&array.buffer()));
}

impl RunningWorker {
    /// Starts a worker that puts what it says into `received`.
    fn start(received: &Rc<RefCell<Received>>, wake: &Wake) -> Result<Self, JsValue> {
        let options = WorkerOptions::new();
        options.set_type(WorkerType::Module);
        let worker = Worker::new_with_options(SCRIPT, &options)?;
        let waiting = Rc::new(RefCell::new(Some(Vec::<Vec<u8>>::new())));
        let heard = {
            let (received, wake, waiting, worker) = (received.clone(), wake.clone(), waiting.clone(), worker.clone());
            Closure::<dyn FnMut(MessageEvent)>::new(move |event: MessageEvent| {
                match event.data().dyn_into::<Uint8Array>() {
                    Ok(bytes) => received.borrow_mut().take(&bytes.to_vec()),
                    // What is no message of bytes says that the worker has started.
                    Err(_) => {
                        for bytes in waiting.take().into_iter().flatten() {
                            post(&worker, &bytes);
                        }
                    }
                }
                wake();
            })
        };
        let failed = {
            let (received, wake) = (received.clone(), wake.clone());
            Closure::<dyn FnMut(MessageEvent)>::new(move |_| {
                received.borrow_mut().broke();
                wake();
            })
        };
        worker.set_onmessage(Some(heard.as_ref().unchecked_ref()));
        worker.set_onerror(Some(failed.as_ref().unchecked_ref()));
        // The worker runs the same program: it need not be compiled again.
        worker.post_message(&wasm_bindgen::module())?;
        Ok(Self { worker, _callbacks: [heard, failed], waiting })
    }
}

impl Received {
    fn take(&mut self, bytes: &[u8]) {
        match message(bytes) {
            Ok(FromWorker::Snapshot(snapshot)) => {
                let mut snapshot = Arc::unwrap_or_clone(snapshot);
                snapshot.known = snapshot.frame.clone();
                self.newest = Some(Arc::new(snapshot));
                self.answers.push(ToWorker::Taken);
            }
            Ok(FromWorker::Flood(made)) => self.flooded(made),
            Ok(event) => {
                self.is_opening &= !matches!(event, FromWorker::Opened(_) | FromWorker::Refused(_));
                self.events.push_back(event);
            }
            Err(error) => self.events.push_back(FromWorker::Fault(error)),
        }
    }

    /// Gives on what the worker has made of the file that has waited longest.
    fn flooded(&mut self, made: Result<(String, String), String>) {
        if let Some(Flood { folder, opens }) = self.floods.pop_front() {
            let source = made.map(|(name, text)| Source { name, text, folder, changes: Vec::new() });
            // The receiver is gone when another file was dropped since.
            let _ = opens.send(source.map(Start::Scene));
        }
    }

    /// The worker broke down, which is told once.
    fn broke(&mut self) {
        if !self.is_broken {
            self.is_broken = true;
            while !self.floods.is_empty() {
                self.flooded(Err(BROKEN.into()));
            }
            self.events.push_back(FromWorker::Broken(BROKEN.into()));
        }
    }
}

/// The event of a message.
fn event(message: FromWorker) -> Option<Event> {
    Some(match message {
        FromWorker::Opened(opened) => match opened.open() {
            Ok(opened) => Event::Opened(Box::new(opened)),
            Err(error) => Event::Refused(error),
        },
        FromWorker::Refused(what) => Event::Refused(what),
        FromWorker::NotChanged(what) => Event::NotChanged(what),
        FromWorker::Ended => Event::Ended,
        FromWorker::Fault(what) => Event::Fault(what),
        FromWorker::Broken(what) => Event::Broken(what),
        FromWorker::Snapshot(_) | FromWorker::Flood(_) => return None,
    })
}

//! The page's handle of the worker.

use crate::background_device::BackgroundDevice;
use crate::physics::message::{FromWorker, ToWorker, bytes, message};
use crate::physics::{Backend, Command, Event};
use crate::snapshot::{Snapshot, Wake};
use crate::view_state::ViewState;
use corpuscle::gpu::Gpu;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;
use wasm_bindgen::prelude::*;
use web_sys::js_sys::Uint8Array;
use web_sys::{MessageEvent, Worker, WorkerOptions, WorkerType};

/// The script of the worker, beside the page.
const SCRIPT: &str = "worker.js";
const BROKEN: &str = "the scene was ended: it took more memory than a page has (4 GB), or an internal error stopped it. Make it smaller, or run it \
                      with the program (corpuscle view)";

/// The handle of the worker. Dropping it ends the worker.
pub struct Physics {
    link: Rc<RefCell<Link>>,
    received: Rc<RefCell<Received>>,
}

/// The worker, and what calls back when it says something.
struct Link {
    worker: Worker,
    _callbacks: [Closure<dyn FnMut(MessageEvent)>; 2],
    /// Messages that wait until the worker has started; none once it has.
    waiting: Option<Vec<Vec<u8>>>,
}

/// What came from the worker.
#[derive(Default)]
struct Received {
    events: VecDeque<FromWorker>,
    newest: Option<Arc<Snapshot>>,
    /// What the worker is to be told.
    answers: Vec<ToWorker>,
}

impl Physics {
    /// Starts the worker.
    ///
    /// # Errors
    /// Where the browser starts none.
    pub(crate) fn start(_: Option<&Gpu>, _: BackgroundDevice, backend: Backend, wake: Wake) -> std::io::Result<Self> {
        let received = Rc::<RefCell<Received>>::default();
        let link = start(&received, &wake).map_err(|error| std::io::Error::other(format!("{error:?}")))?;
        link.borrow_mut().send(&ToWorker::Backend(backend));
        Ok(Self { link, received })
    }

    /// Sends a command. Never waits.
    pub fn send(&self, command: Command) {
        self.link.borrow_mut().send(&ToWorker::Command(command));
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
        let newest = {
            let mut received = self.received.borrow_mut();
            for answer in std::mem::take(&mut received.answers) {
                self.link.borrow_mut().send(&answer);
            }
            received.newest.clone()
        };
        newest
    }
}

/// Gives files to the worker.
pub(crate) struct FileHolder(Rc<RefCell<Link>>);

impl FileHolder {
    /// Has the worker hold a raster file in memory under a path.
    pub fn hold(&self, path: PathBuf, bytes: &[u8]) {
        self.0.borrow_mut().send(&ToWorker::File(path, bytes.to_vec()));
    }
}

impl Drop for Physics {
    fn drop(&mut self) {
        self.link.borrow().worker.terminate();
    }
}

impl Link {
    fn send(&mut self, message: &ToWorker) {
        let Ok(bytes) = bytes(message) else { return };
        match &mut self.waiting {
            Some(waiting) => waiting.push(bytes),
            None => post(&self.worker, &bytes),
        }
    }

    /// Sends what has waited.
    fn started(&mut self) {
        for bytes in self.waiting.take().into_iter().flatten() {
            post(&self.worker, &bytes);
        }
    }
}

fn post(worker: &Worker, bytes: &[u8]) {
    let array = Uint8Array::from(bytes);
    // A worker that was ended takes no more messages.
    let _ = worker.post_message_with_transfer(&array, &web_sys::js_sys::Array::of1(&array.buffer()));
}

/// Starts a worker that puts what it says into `received`.
fn start(received: &Rc<RefCell<Received>>, wake: &Wake) -> Result<Rc<RefCell<Link>>, JsValue> {
    let options = WorkerOptions::new();
    options.set_type(WorkerType::Module);
    let worker = Worker::new_with_options(SCRIPT, &options)?;
    let link = Rc::<RefCell<Option<Rc<RefCell<Link>>>>>::default();
    let heard = {
        let (received, wake, link) = (received.clone(), wake.clone(), link.clone());
        Closure::<dyn FnMut(MessageEvent)>::new(move |event: MessageEvent| {
            match event.data().dyn_into::<Uint8Array>() {
                Ok(bytes) => received.borrow_mut().take(&bytes.to_vec()),
                // What is no message of bytes says that the worker has started.
                Err(_) => {
                    if let Some(link) = &*link.borrow() {
                        link.borrow_mut().started();
                    }
                }
            }
            wake();
        })
    };
    let failed = {
        let (received, wake) = (received.clone(), wake.clone());
        Closure::<dyn FnMut(MessageEvent)>::new(move |_| {
            received.borrow_mut().events.push_back(FromWorker::Fault(BROKEN.into()));
            wake();
        })
    };
    worker.set_onmessage(Some(heard.as_ref().unchecked_ref()));
    worker.set_onerror(Some(failed.as_ref().unchecked_ref()));
    // The worker runs the same program: it need not be compiled again.
    worker.post_message(&wasm_bindgen::module())?;
    let started = Rc::new(RefCell::new(Link { worker, _callbacks: [heard, failed], waiting: Some(Vec::new()) }));
    *link.borrow_mut() = Some(started.clone());
    Ok(started)
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
            Ok(event) => self.events.push_back(event),
            Err(error) => self.events.push_back(FromWorker::Fault(error)),
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
        FromWorker::Snapshot(_) => return None,
    })
}

//! The worker itself: runs the physics between messages from the page.

use crate::physics::message::{FromWorker, ToWorker, bytes, message};
use crate::physics::runner::Runner;
use crate::physics::{Backend, Event, Shared};
use crate::snapshot::Snapshot;
use crate::{Source, dropped};
use corpuscle::Cpu;
use corpuscle::terrain::{hold_in_memory, keep_in_memory};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, channel};
use wasm_bindgen::prelude::*;
use wasm_bindgen_futures::spawn_local;
use web_sys::js_sys::{Array, Function, Uint8Array, global};
use web_sys::{DedicatedWorkerGlobalScope, MessageChannel, MessageEvent};

/// Timers of browsers are not shorter than this, ms: what is due sooner is called by a message.
const SHORTEST_TIMER: i32 = 4;

/// What the worker holds.
struct Server {
    scope: DedicatedWorkerGlobalScope,
    shared: Arc<Shared>,
    events: Receiver<Event>,
    state: RefCell<State>,
    /// Calls [`Server::slice`].
    slice: Function,
    /// Calls it at once.
    soon: MessageChannel,
}

/// What changes of it.
struct State {
    /// None while it works: it may await a GPU, and messages come meanwhile.
    runner: Option<Runner>,
    /// Messages that are not taken yet.
    messages: VecDeque<ToWorker>,
    /// The last snapshot sent.
    sent: Option<Arc<Snapshot>>,
    /// True until the page has taken the last snapshot: it may draw more slowly than the physics runs.
    is_taking: bool,
    /// True while a slice is due.
    is_due: bool,
}

/// Serves the page: called once, in a worker.
///
/// # Errors
/// Where this is no worker.
pub fn serve() -> Result<(), JsValue> {
    let scope: DedicatedWorkerGlobalScope = global().dyn_into()?;
    let (sender, events) = channel();
    let shared = Arc::new(Shared::new(Arc::new(|| {})));
    let mut runner = Runner::new(sender, shared.clone(), Backend::Auto, None);
    runner.cpu = Cpu::OneCore;
    let soon = MessageChannel::new()?;
    let server = Rc::<RefCell<Option<Rc<Server>>>>::default();
    let slice = {
        let server = server.clone();
        let slice = move || server.borrow().as_ref().map_or((), Server::slice);
        Closure::<dyn FnMut()>::new(slice).into_js_value().unchecked_into::<Function>()
    };
    soon.port1().set_onmessage(Some(&slice));
    let messages = VecDeque::new();
    let state = State { runner: Some(runner), messages, sent: None, is_taking: false, is_due: false };
    let state = RefCell::new(state);
    let own = Rc::new(Server { scope: scope.clone(), shared, events, state, slice, soon });
    *server.borrow_mut() = Some(own.clone());
    let heard = Closure::<dyn FnMut(MessageEvent)>::new(move |event: MessageEvent| {
        if let Ok(bytes) = event.data().dyn_into::<Uint8Array>() {
            own.hear(&bytes.to_vec());
        }
    });
    scope.set_onmessage(Some(heard.into_js_value().unchecked_ref()));
    // The page sends nothing before.
    scope.post_message(&JsValue::TRUE)
}

impl Server {
    /// Keeps a message, and takes it once the one before is done.
    fn hear(self: &Rc<Self>, bytes: &[u8]) {
        match message(bytes) {
            Ok(ToWorker::Taken) => {
                self.state.borrow_mut().is_taking = false;
                return self.answer();
            }
            Ok(message) => self.state.borrow_mut().messages.push_back(message),
            Err(error) => return self.post(&FromWorker::Fault(error)),
        }
        // Ends a slice that is under way.
        self.shared.stop.store(true, Ordering::Relaxed);
        self.work(false);
    }

    /// Advances, if that is still due.
    fn slice(self: &Rc<Self>) {
        self.state.borrow_mut().is_due = false;
        self.work(true);
    }

    /// Takes all messages, and advances where a slice is due; nothing while it does so already.
    fn work(self: &Rc<Self>, is_due: bool) {
        let Some(mut runner) = self.state.borrow_mut().runner.take() else { return };
        let server = self.clone();
        spawn_local(async move {
            loop {
                let message = server.state.borrow_mut().messages.pop_front();
                server.shared.stop.store(false, Ordering::Relaxed);
                match message {
                    Some(ToWorker::Flood(path)) => server.post(&FromWorker::Flood(flood(&path))),
                    Some(message) => take(&mut runner, message).await,
                    None => break,
                }
                server.answer();
            }
            if is_due && runner.time_left().is_some() {
                runner.slice().await;
                server.answer();
            }
            let left = runner.time_left();
            let has_messages = {
                let mut state = server.state.borrow_mut();
                state.runner = Some(runner);
                !state.messages.is_empty()
            };
            if has_messages {
                server.work(false);
            } else if let Some(left) = left {
                server.schedule(left.as_millis() as i32);
            }
        });
    }

    /// Has a slice called when it is due, in so many milliseconds.
    fn schedule(&self, milliseconds: i32) {
        let mut state = self.state.borrow_mut();
        if state.is_due {
            return;
        }
        let called = if milliseconds < SHORTEST_TIMER {
            self.soon.port2().post_message(&JsValue::NULL)
        } else {
            self.scope.set_timeout_with_callback_and_timeout_and_arguments_0(&self.slice, milliseconds).map(|_| ())
        };
        state.is_due = called.is_ok();
    }

    /// Sends events and the newest snapshot.
    fn answer(&self) {
        let events: Vec<_> = self.events.try_iter().filter_map(FromWorker::of).collect();
        // The window expects the snapshots of a scene after its opening.
        for event in &events {
            self.post(event);
        }
        let mut state = self.state.borrow_mut();
        let Some(newest) = self.shared.newest().filter(|_| !state.is_taking) else { return };
        if state.sent.as_ref().is_none_or(|sent| !Arc::ptr_eq(sent, &newest)) {
            state.is_taking = true;
            self.post(&FromWorker::Snapshot(newest.clone()));
            state.sent = Some(newest);
        }
    }

    fn post(&self, message: &FromWorker) {
        let Ok(bytes) = bytes(message) else { return };
        let array = Uint8Array::from(bytes.as_slice());
        // The page has gone where this fails, and ends the worker.
        let _ = self.scope.post_message_with_transfer(&array, &Array::of1(&array.buffer()));
    }
}

/// Name and text of the scene of a flood over the terrain in a file.
fn flood(path: &Path) -> Result<(String, String), String> {
    dropped::flood(path).map(|Source { name, text, .. }| (name, text))
}

/// Does what a message says.
async fn take(runner: &mut Runner, message: ToWorker) {
    match message {
        ToWorker::Backend(backend) => runner.backend = backend,
        ToWorker::Command(command) => runner.take(command).await,
        ToWorker::File(path, bytes) => hold_in_memory(path, &bytes),
        ToWorker::KeepFiles(folder) => keep_in_memory(&folder),
        ToWorker::Taken | ToWorker::Flood(_) => {}
    }
}

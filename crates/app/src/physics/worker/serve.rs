//! The worker itself: runs the physics between messages from the page.

use crate::physics::message::{FromWorker, ToWorker, bytes, message};
use crate::physics::runner::Runner;
use crate::physics::{Backend, Event, Shared};
use crate::snapshot::Snapshot;
use corpuscle::terrain::hold_in_memory;
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use wasm_bindgen::prelude::*;
use web_sys::js_sys::{Array, Function, Uint8Array, global};
use web_sys::{DedicatedWorkerGlobalScope, MessageChannel, MessageEvent};

/// Timers of browsers are not shorter than this, ms: what is due sooner is called by a message.
const SHORTEST_TIMER: i32 = 4;

/// What the worker holds.
struct Server {
    scope: DedicatedWorkerGlobalScope,
    runner: Runner,
    shared: Arc<Shared>,
    events: Receiver<Event>,
    /// The last snapshot sent.
    sent: Option<Arc<Snapshot>>,
    /// True until the page has taken the last snapshot: it may draw more slowly than the physics runs.
    is_taking: bool,
    /// True while a slice is due.
    is_due: bool,
    /// Advances.
    slice: Function,
    /// Calls that at once.
    soon: MessageChannel,
}

/// Serves the page: called once, in a worker.
///
/// # Errors
/// Where this is no worker.
pub fn serve() -> Result<(), JsValue> {
    let scope: DedicatedWorkerGlobalScope = global().dyn_into()?;
    let (sender, events) = channel();
    let shared = Arc::new(Shared::new(Arc::new(|| {})));
    let runner = Runner::new(sender, shared.clone(), Backend::Auto, None);
    let soon = MessageChannel::new()?;
    let server = Rc::<RefCell<Option<Server>>>::default();
    let slice = {
        let server = server.clone();
        let slice = move || server.borrow_mut().as_mut().map_or((), Server::slice);
        Closure::<dyn FnMut()>::new(slice).into_js_value().unchecked_into::<Function>()
    };
    soon.port1().set_onmessage(Some(&slice));
    let (is_taking, is_due) = (false, false);
    let own = scope.clone();
    *server.borrow_mut() =
        Some(Server { scope: own, runner, shared, events, sent: None, is_taking, is_due, slice, soon });
    let heard = Closure::<dyn FnMut(MessageEvent)>::new(move |event: MessageEvent| {
        if let (Ok(bytes), Some(server)) = (event.data().dyn_into::<Uint8Array>(), &mut *server.borrow_mut()) {
            server.take(&bytes.to_vec());
        }
    });
    scope.set_onmessage(Some(heard.into_js_value().unchecked_ref()));
    // The page sends nothing before.
    scope.post_message(&JsValue::TRUE)
}

impl Server {
    fn take(&mut self, bytes: &[u8]) {
        match message(bytes) {
            Ok(ToWorker::Command(command)) => self.runner.take(command),
            Ok(ToWorker::File(path, bytes)) => hold_in_memory(path, &bytes),
            Ok(ToWorker::Taken) => self.is_taking = false,
            Err(error) => self.post(&FromWorker::Fault(error)),
        }
        self.answer();
        self.schedule();
    }

    /// Has a slice called when it is due.
    fn schedule(&mut self) {
        let Some(left) = self.runner.time_left().filter(|_| !self.is_due) else { return };
        self.is_due = true;
        let milliseconds = left.as_millis() as i32;
        let called = if milliseconds < SHORTEST_TIMER {
            self.soon.port2().post_message(&JsValue::NULL)
        } else {
            self.scope.set_timeout_with_callback_and_timeout_and_arguments_0(&self.slice, milliseconds).map(|_| ())
        };
        self.is_due = called.is_ok();
    }

    /// Advances, if that is still due.
    fn slice(&mut self) {
        self.is_due = false;
        if self.runner.time_left().is_some() {
            self.runner.slice();
            self.answer();
        }
        self.schedule();
    }

    /// Sends events and the newest snapshot.
    fn answer(&mut self) {
        let events: Vec<_> = self.events.try_iter().filter_map(FromWorker::of).collect();
        // The window expects the snapshots of a scene after its opening.
        for event in &events {
            self.post(event);
        }
        let Some(newest) = self.shared.newest().filter(|_| !self.is_taking) else { return };
        if self.sent.as_ref().is_none_or(|sent| !Arc::ptr_eq(sent, &newest)) {
            self.is_taking = true;
            self.post(&FromWorker::Snapshot(newest.clone()));
            self.sent = Some(newest);
        }
    }

    fn post(&self, message: &FromWorker) {
        let Ok(bytes) = bytes(message) else { return };
        let array = Uint8Array::from(bytes.as_slice());
        // The page has gone where this fails, and ends the worker.
        let _ = self.scope.post_message_with_transfer(&array, &Array::of1(&array.buffer()));
    }
}

//! Dropped files on the disk.

use super::{Pending, Window};
use crate::dropped;
use egui::{Context, DroppedFileHandle};
use std::path::PathBuf;
use std::sync::mpsc::channel;

impl Window {
    /// Opens the first of the dropped files.
    pub(super) fn take_files(&mut self, context: &Context, files: &[DroppedFileHandle]) {
        if let Some(file) = files.first() {
            self.open_dropped(context, file.path().to_owned());
        }
    }

    /// Opens a file or a folder in a thread of its own: large terrain takes a while to read.
    pub fn open_dropped(&mut self, context: &Context, path: PathBuf) {
        self.fault = None;
        let (sender, receiver) = channel();
        let context = context.clone();
        let read = move || {
            // The receiver is gone when the window closes.
            let _ = sender.send(dropped::open(&path));
            context.request_repaint();
        };
        match std::thread::Builder::new().name("dropped".into()).spawn(read) {
            Ok(_) => self.pending = Some(Pending::Dropped(receiver)),
            Err(error) => self.fault = Some(error.to_string()),
        }
    }
}

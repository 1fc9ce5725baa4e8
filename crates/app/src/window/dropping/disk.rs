//! Dropped files on the disk.

use super::{Pending, Window};
use crate::{Source, dropped};
use egui::{Context, DroppedFileHandle, Ui};
use std::path::PathBuf;
use std::sync::mpsc::channel;

/// Files chosen by a button, of which there is none here.
#[derive(Default)]
pub(in crate::window) struct ChosenFiles {}

impl ChosenFiles {
    /// None.
    pub fn take(&self) -> Vec<DroppedFileHandle> {
        Vec::new()
    }
}

impl Window {
    /// Shows no button: files are dropped, or named on the command line.
    pub(in crate::window) fn open_button(&self, _: &mut Ui) {}

    /// What is said while a file hovers over the window.
    pub(super) const DROP_HINT: &str =
        "Drop terrain to flood it: a GeoTIFF or an ESRI ASCII grid.\nA scene file or the folder of a run is opened.";

    /// Opens the first of the dropped files.
    pub(super) fn take_files(&mut self, context: &Context, files: &[DroppedFileHandle]) {
        if let Some(file) = files.first() {
            self.open_dropped(context, file.path().to_owned());
        }
    }

    /// Frees nothing: files are on the disk.
    pub(in crate::window) fn free_dropped(&self, _: &Source) {}

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

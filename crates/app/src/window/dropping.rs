//! Files that are dropped on the window.

use super::{Pending, Start, Window};
use crate::dropped;
use egui::{Align2, Color32, Context, FontId, Id, LayerId, Order};
use std::path::PathBuf;
use std::sync::mpsc::channel;

impl Window {
    /// Opens a file that is dropped on the window, and shows a hint while one hovers over it.
    pub(super) fn take_dropped(&mut self, context: &Context) {
        let (hovers, dropped) = context.input(|input| {
            let dropped = input.raw.dropped_files.first().map(|file| file.path().to_owned());
            (!input.raw.hovered_files.is_empty(), dropped)
        });
        if let Some(path) = dropped {
            self.open_dropped(context, path);
        }
        if hovers {
            let painter = context.layer_painter(LayerId::new(Order::Foreground, Id::unique("dropping")));
            let whole = context.content_rect();
            painter.rect_filled(whole, 0.0, Color32::from_black_alpha(120));
            let text = "Drop terrain to flood it: a GeoTIFF or an ESRI ASCII grid.\nA scene file or the folder of a run is opened.";
            painter.text(whole.center(), Align2::CENTER_CENTER, text, FontId::proportional(20.0), Color32::WHITE);
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

    /// Opens the dropped file once it is read.
    pub(super) fn check_dropped(&mut self) {
        let Some(Pending::Dropped(receiver)) = &self.pending else { return };
        let Ok(read) = receiver.try_recv() else { return };
        self.pending = None;
        match read {
            Ok(Start::Scene(source)) => self.open(source),
            Ok(Start::Run(folder)) => self.open_run(folder),
            Ok(Start::Welcome) => {}
            Err(error) => self.fault = Some(error),
        }
    }
}

//! Files that are dropped on the window.

use super::{Awaited, Start, Window};
use crate::dropped;
use egui::{Align2, Color32, Context, FontId, Id, LayerId, Order};
use std::path::PathBuf;
use std::sync::mpsc::channel;

impl Window {
    /// Takes what is dropped on the window, and says so while it hovers over it.
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

    /// Opens a file or a folder; large terrain takes a while to read, and the window goes on meanwhile.
    pub fn open_dropped(&mut self, context: &Context, path: PathBuf) {
        self.fault = None;
        let (tell, told) = channel();
        let context = context.clone();
        let read = move || {
            // Nobody listens where the window is closing.
            let _ = tell.send(dropped::open(&path));
            context.request_repaint();
        };
        match std::thread::Builder::new().name("dropped".into()).spawn(read) {
            Ok(_) => self.awaited = Some(Awaited::Dropped(told)),
            Err(error) => self.fault = Some(error.to_string()),
        }
    }

    /// Opens what was dropped, once it is read.
    pub(super) fn look_for_dropped(&mut self) {
        let Some(Awaited::Dropped(told)) = &self.awaited else { return };
        let Ok(read) = told.try_recv() else { return };
        self.awaited = None;
        match read {
            Ok(Start::Scene(source)) => self.open(source),
            Ok(Start::Run(folder)) => self.open_run(folder),
            Ok(Start::Welcome) => {}
            Err(error) => self.fault = Some(error),
        }
    }
}

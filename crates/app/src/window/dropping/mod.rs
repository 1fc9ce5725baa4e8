//! Files that are dropped on the window.

#[cfg(not(target_arch = "wasm32"))]
mod disk;
#[cfg(target_arch = "wasm32")]
mod page;
#[cfg(not(target_arch = "wasm32"))]
pub(super) use disk::ChosenFiles;
#[cfg(target_arch = "wasm32")]
pub(super) use page::ChosenFiles;

use super::{Pending, Window};
use crate::Start;
use egui::{Align2, Color32, Context, FontId, Id, LayerId, Order};

impl Window {
    /// Opens a file that is dropped on the window, and shows a hint while one hovers over it.
    pub(super) fn take_dropped(&mut self, context: &Context) {
        let (hovers, dropped) =
            context.input(|input| (!input.raw.hovered_files.is_empty(), input.raw.dropped_files.clone()));
        let files = if dropped.is_empty() { self.chosen.take() } else { dropped };
        if !files.is_empty() {
            self.take_files(context, &files);
        }
        if hovers {
            let painter = context.layer_painter(LayerId::new(Order::Foreground, Id::unique("dropping")));
            let whole = context.content_rect();
            painter.rect_filled(whole, 0.0, Color32::from_black_alpha(120));
            painter.text(
                whole.center(),
                Align2::CENTER_CENTER,
                Self::DROP_HINT,
                FontId::proportional(20.0),
                Color32::WHITE,
            );
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

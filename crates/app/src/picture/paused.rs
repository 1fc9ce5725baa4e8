//! The full-quality picture of a paused scene: requested from the offscreen renderer, and shown when it is there.

use super::{Drawn, Painting, Picture};
use crate::offscreen::{OffscreenRenderer, PausedSettings, RenderJob};
use crate::snapshot::Snapshot;
use crate::view_state::ViewState;
use corpuscle::gpu::Image;
use corpuscle::pictures::Shown;
use std::sync::Arc;

impl Picture {
    /// Requests a picture, unless it is requested already.
    pub(super) fn request(
        &mut self,
        snapshot: &Arc<Snapshot>,
        drawn: Drawn,
        paper: [f32; 3],
        offscreen: &OffscreenRenderer,
    ) {
        if self.requested.as_ref().is_none_or(|(_, requested)| *requested != drawn) {
            let settings = PausedSettings { quality: drawn.quality, size: drawn.size, samples: drawn.samples, paper };
            self.requested = Some((offscreen.draw_paused(self.job(snapshot), settings), drawn));
        }
    }

    /// Shows a picture that was drawn, by the number of its request. One that is out of date is dropped: something changed since the request.
    pub fn take(&mut self, number: u64, result: Result<Box<(Shown, Image)>, String>) {
        let Some((_, drawn)) = self.requested.clone().filter(|(requested, _)| *requested == number) else { return };
        let Painting::Device(device) = &mut self.painting else { return };
        let laid = result.and_then(|drawn| {
            let (shown, image) = *drawn;
            device.take(&image).map(|()| shown)
        });
        match laid {
            Ok(shown) => (self.shown, self.drawn) = (Some(shown), Some(drawn)),
            Err(error) => self.fault = Some(error),
        }
    }

    /// The camera and the partition as the user set them.
    pub fn view_state(&self) -> ViewState {
        ViewState { camera_offset: self.camera_offset, lifted: self.lifted }
    }

    /// A snapshot to be drawn as it is seen now.
    pub fn job(&self, snapshot: &Arc<Snapshot>) -> RenderJob {
        RenderJob { scenery: self.scenery.clone(), snapshot: snapshot.clone(), view_state: self.view_state() }
    }
}

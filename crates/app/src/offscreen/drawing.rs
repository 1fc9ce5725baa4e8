//! What draws: the pictures of one scene on a device.

use super::{PausedSettings, RenderJob};
use crate::background_device::BackgroundDevice;
use crate::view_state::moment;
use corpuscle::Error;
use corpuscle::pictures::{PictureSettings, Pictures, Shown};
use corpuscle_render::RenderError;

/// Size of a still, pixels.
pub(super) const STILL_SIZE: [u32; 2] = [1920, 1080];

/// Draws scenes, one at a time.
pub(super) struct Drawing {
    device: BackgroundDevice,
    /// The scene that was drawn last, by its number, and its pictures.
    scene: Option<(u64, Pictures)>,
}

impl Drawing {
    /// On a device, without a scene.
    pub fn new(device: BackgroundDevice) -> Self {
        Self { device, scene: None }
    }

    /// Opens the scene again for the next picture.
    #[cfg_attr(target_arch = "wasm32", expect(dead_code, reason = "in a browser a panic ends the program"))]
    pub fn forget(&mut self) {
        self.scene = None;
    }

    /// Draws the window's picture of a paused scene, to be read.
    pub fn paused(&mut self, job: &RenderJob, settings: &PausedSettings) -> Result<(Shown, &mut Pictures), Error> {
        let pictures = self.pictures(job, settings.size, settings.samples)?;
        job.view_state.lift(pictures);
        let offset = &job.view_state.camera_offset;
        let shown = pictures.show(&moment(&job.snapshot), offset, settings.quality, settings.paper)?;
        Ok((shown, pictures))
    }

    /// What draws a scene, in this size.
    pub fn pictures(&mut self, job: &RenderJob, size: [u32; 2], samples: u32) -> Result<&mut Pictures, Error> {
        let number = job.snapshot.number;
        if self.scene.as_ref().is_none_or(|(open, _)| *open != number) {
            // The memory of the last one is free before the next takes its own.
            self.scene = None;
            let gpu = self.device.gpu().map_err(RenderError::from)?;
            let settings = PictureSettings { size, samples, ..PictureSettings::default() };
            self.scene = Some((number, Pictures::open_scenery(&gpu, &job.scenery, settings)?));
        }
        let (_, pictures) = self.scene.as_mut().expect("it was opened above");
        pictures.resize(size, samples)?;
        Ok(pictures)
    }
}

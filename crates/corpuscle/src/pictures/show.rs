//! Pictures for a window: drawn repeatedly on its device, with a camera that the user moves.

use super::{CameraOffset, Moment, Pictures};
use crate::Error;
use corpuscle_gpu::{Gpu, Image};
use corpuscle_render::{Camera, Inlay, InlayPainter, Overlay, Stage, Target};

/// Quality of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Quality {
    /// Shadows and realistic water.
    #[default]
    Full,
    /// Fast without a GPU: no shadows, water as particles coloured by depth.
    Simple,
}

/// A drawn picture, for a caller that draws text and lines over it.
#[derive(Debug, Clone)]
pub struct Shown {
    /// The part of the world that is shown.
    pub stage: Stage,
    /// The camera.
    pub camera: Camera,
    /// True where it is a drawing on paper, false where it is lit.
    pub on_paper: bool,
    /// False where the picture is linear light still, as simple pictures are.
    pub finished: bool,
    /// The overlay to be drawn over it.
    pub overlay: Overlay,
}

impl Pictures {
    /// The device that draws.
    pub fn gpu(&self) -> &Gpu {
        self.context.renderer.gpu()
    }

    /// Draws a moment and leaves the picture on the device ([`Pictures::inlay`]), without its overlay, on paper of a colour (linear
    /// light) where it is a drawing. Returns before the device is done.
    ///
    /// # Errors
    /// [`Error::Render`] where something cannot be drawn.
    pub fn show(
        &mut self,
        moment: &Moment<'_>,
        camera_offset: &CameraOffset,
        quality: Quality,
        paper: [f32; 3],
    ) -> Result<Shown, Error> {
        let context = &mut self.context;
        (context.overlaid, context.quality, context.camera_offset, context.paper) =
            (false, quality, *camera_offset, paper);
        self.subject.draw(context, &self.title, moment)
    }

    /// The picture of a moment as [`Pictures::draw`] makes it, with the user's camera.
    ///
    /// # Errors
    /// [`Error::Render`] where the device was lost.
    pub fn still(&mut self, moment: &Moment<'_>, camera_offset: &CameraOffset) -> Result<Image, Error> {
        self.draw_still(moment, camera_offset)?;
        self.read()
    }

    /// [`Pictures::still`] where one may not wait, as in a browser: it is drawn at once, and read back later.
    ///
    /// # Errors
    /// As there; [`Error::Render`] from the future where the device was lost.
    pub fn still_later(
        &mut self,
        moment: &Moment<'_>,
        camera_offset: &CameraOffset,
    ) -> Result<impl Future<Output = Result<Image, Error>> + use<>, Error> {
        self.draw_still(moment, camera_offset)?;
        Ok(self.read_later())
    }

    pub(super) fn draw_still(&mut self, moment: &Moment<'_>, camera_offset: &CameraOffset) -> Result<Shown, Error> {
        let context = &mut self.context;
        (context.overlaid, context.quality, context.camera_offset, context.paper) =
            (true, Quality::Full, *camera_offset, [1.0; 3]);
        self.subject.draw(context, &self.title, moment)
    }

    /// [`Pictures::read`] where one may not wait, as in a browser.
    pub fn read_later(&self) -> impl Future<Output = Result<Image, Error>> + use<> {
        let reading = self.context.renderer.read_later(&self.context.target);
        async move { Ok(reading.await?) }
    }

    /// What was shown last, finished ([`Shown::finished`]), in main memory. Waits for the device.
    ///
    /// # Errors
    /// [`Error::Render`] where the device was lost.
    pub fn read(&self) -> Result<Image, Error> {
        Ok(self.context.renderer.read(&self.context.target)?)
    }

    /// Makes pictures of another size, pixels, with so many samples each way in a pixel; false where they have it already.
    ///
    /// # Errors
    /// [`Error::Render`] where that is more than the device can hold.
    pub fn resize(&mut self, size: [u32; 2], samples: u32) -> Result<bool, Error> {
        let target = &mut self.context.target;
        if (target.size, target.samples) == (size, samples) {
            return Ok(false);
        }
        let transparent = target.transparent;
        *target = Target::new(self.context.renderer.gpu(), size, samples)?.without_background(transparent);
        Ok(true)
    }

    /// Draws no partition of a gas from a time on, s: the user lifted it.
    pub fn lift_partition(&mut self, time: f64) {
        self.subject.lift_partition(time);
    }

    /// What was shown last, ready to be laid into a window.
    pub fn inlay(&self, shown: &Shown, painter: &InlayPainter) -> Inlay {
        let target = &self.context.target;
        if shown.finished {
            painter.finished(self.gpu(), target)
        } else {
            painter.light(self.gpu(), target, !shown.on_paper)
        }
    }
}

//! Pictures that are shown where they are drawn, again and again, seen from where a hand moves the camera to.

use super::{CameraOffset, Moment, Pictures};
use crate::Error;
use corpuscle_gpu::{Gpu, Image};
use corpuscle_render::{Camera, Inlay, InlayPainter, Overlay, Stage, Target};

/// How much work a picture may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Quality {
    /// All there is: shadows, water that looks like water.
    #[default]
    Full,
    /// What can be drawn quickly without a GPU: no shadows, water as its particles, coloured by depth.
    Simple,
}

/// What was drawn, for whoever lays texts and lines over it.
#[derive(Debug, Clone)]
pub struct Shown {
    /// The part of the world that is shown.
    pub stage: Stage,
    /// From where.
    pub camera: Camera,
    /// True where it is a drawing on paper, false where it is lit.
    pub on_paper: bool,
    /// False where linear light was left, as quick pictures are.
    pub finished: bool,
    /// What is to lie over it.
    pub overlay: Overlay,
}

impl Pictures {
    /// The device that draws.
    pub fn gpu(&self) -> &Gpu {
        self.studio.renderer.gpu()
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
        let studio = &mut self.studio;
        (studio.overlaid, studio.quality, studio.camera_offset, studio.paper) = (false, quality, *camera_offset, paper);
        self.subject.draw(studio, &self.title, moment)
    }

    /// The picture of a moment as [`Pictures::draw`] makes it, seen from where a hand moved the camera to.
    ///
    /// # Errors
    /// [`Error::Render`] where the device was lost.
    pub fn still(&mut self, moment: &Moment<'_>, camera_offset: &CameraOffset) -> Result<Image, Error> {
        let studio = &mut self.studio;
        (studio.overlaid, studio.quality, studio.camera_offset, studio.paper) =
            (true, Quality::Full, *camera_offset, [1.0; 3]);
        self.subject.draw(studio, &self.title, moment)?;
        self.read()
    }

    /// What was shown last, finished ([`Shown::finished`]), in main memory. Waits for the device.
    ///
    /// # Errors
    /// [`Error::Render`] where the device was lost.
    pub fn read(&self) -> Result<Image, Error> {
        Ok(self.studio.renderer.read(&self.studio.target)?)
    }

    /// Makes pictures of another size, pixels, with so many samples each way in a pixel; false where they have it already.
    ///
    /// # Errors
    /// [`Error::Render`] where that is more than the device can hold.
    pub fn resize(&mut self, size: [u32; 2], samples: u32) -> Result<bool, Error> {
        let target = &mut self.studio.target;
        if (target.size, target.samples) == (size, samples) {
            return Ok(false);
        }
        *target = Target::new(self.studio.renderer.gpu(), size, samples)?;
        Ok(true)
    }

    /// The partition of a gas is drawn no longer from a time on, s: it was lifted by hand.
    pub fn lift_partition(&mut self, time: f64) {
        self.subject.lift_partition(time);
    }

    /// What was shown last, ready to be laid into a window.
    pub fn inlay(&self, shown: &Shown, painter: &InlayPainter) -> Inlay {
        let target = &self.studio.target;
        if shown.finished {
            painter.finished(self.gpu(), target)
        } else {
            painter.light(self.gpu(), target, !shown.on_paper)
        }
    }
}

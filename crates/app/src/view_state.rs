//! The camera and the partition as the user set them.

use crate::snapshot::Snapshot;
use corpuscle::Error;
use corpuscle::gpu::Image;
use corpuscle::pictures::{CameraOffset, Moment, Pictures};

/// The camera and the partition as the user set them, for pictures drawn elsewhere.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ViewState {
    /// How the user moved the camera.
    pub camera_offset: CameraOffset,
    /// When the user lifted the partition of a gas, s.
    pub lifted: Option<f64>,
}

impl ViewState {
    /// A still of a moment with this camera, with its title and axes.
    #[cfg_attr(target_arch = "wasm32", expect(dead_code, reason = "a browser does not wait for it"))]
    pub(crate) fn still(&self, pictures: &mut Pictures, moment: &Moment<'_>) -> Result<Image, Error> {
        self.lift(pictures);
        pictures.still(moment, &self.camera_offset)
    }

    /// Pictures from now on are without the partition, where it was lifted.
    pub(crate) fn lift(&self, pictures: &mut Pictures) {
        if let Some(time) = self.lifted {
            pictures.lift_partition(time);
        }
    }
}

/// The moment of a snapshot, for pictures.
pub(crate) fn moment(snapshot: &Snapshot) -> Moment<'_> {
    let Snapshot { frame, on_device, paths, container, .. } = snapshot;
    Moment { frame, on_device: on_device.as_ref(), paths, container: *container }
}

//! Particles of a simulation that steps on a GPU, which stay there to be drawn.

use crate::pictures::{gpu_of, particles_of};
use crate::{Error, Simulation, models};
use corpuscle_gpu::{DeviceParticles, Gpu};
use corpuscle_model::{AdvanceObserver, Glance};
use std::sync::atomic::AtomicBool;

impl Simulation {
    /// The GPU that takes the steps, if one does.
    pub(crate) fn stepping_gpu(&self) -> Option<Gpu> {
        gpu_of(self.model())
    }

    /// The particles in GPU memory, where the model steps on the device that draws it; else none.
    ///
    /// # Errors
    /// [`Error::Model`] where the device has too little memory.
    pub fn seen_on(&self, gpu: &Gpu) -> Result<Option<DeviceParticles>, Error> {
        if self.is_seen_on(gpu) && self.shows_particles() { particles_of(self.model()) } else { Ok(None) }
    }

    /// True where the model steps on this device and can be drawn there without reading its particles back.
    pub fn is_seen_on(&self, gpu: &Gpu) -> bool {
        self.stepping_gpu().is_some_and(|device| device.is_same(gpu))
    }

    /// True where pictures show particles in GPU memory.
    fn shows_particles(&self) -> bool {
        models::of(self.scene()).is_ok_and(|kind| kind.shows_particles(self.scene()))
    }

    /// Goes on as [`corpuscle_model::Model::advance_with`] does. Of a model that can be drawn where it steps ([`Simulation::is_seen_on`]) `show` is given a
    /// glance from the time `first`, s, on, and returns when the next is due, s (a time that has passed stands for the end of the next
    /// step); particles come back only at the end.
    ///
    /// # Errors
    /// [`Error::Model`] where the model breaks down, or its device is lost.
    pub fn advance_shown(
        &mut self,
        time: f64,
        stop: &AtomicBool,
        observer: &mut dyn AdvanceObserver,
        first: f64,
        show: &mut dyn FnMut(Glance) -> f64,
    ) -> Result<(), Error> {
        let with_particles = self.shows_particles();
        let model = self.model_mut();
        if let Some(model) = model.on_gpu_mut() {
            return Ok(model.advance_shown(time, stop, observer, (first, with_particles), show)?);
        }
        Ok(model.advance_with(time, stop, observer)?)
    }
}

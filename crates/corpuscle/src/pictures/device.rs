//! Pictures of a model that steps on the GPU that draws: its particles stay there.

use super::{Moment, Pictures};
use crate::Error;
use corpuscle_gpu::{DeviceParticles, Gpu, Image};
use corpuscle_model::{Frame, Glance, GpuModel, Model};

impl Pictures {
    /// The picture of a model in its current state. Where it steps on the device that draws, its particles are drawn from its memory.
    ///
    /// # Errors
    /// [`Error::Model`] where that device has too little memory, [`Error::Render`] where it was lost.
    pub fn draw_model(&mut self, model: &dyn Model) -> Result<Image, Error> {
        let particles = self.on_device(model)?;
        let frame = match particles {
            Some(_) => Frame { time: model.time(), sets: Vec::new() },
            None => model.frame(),
        };
        let (paths, container) = (model.paths(), model.container());
        self.draw(&Moment { frame: &frame, on_device: particles.as_ref(), paths: &paths, container })
    }

    /// The picture of a glance.
    ///
    /// # Errors
    /// [`Error::Render`] where the device was lost.
    pub fn draw_glance(&mut self, glance: &Glance) -> Result<Image, Error> {
        let Glance { frame, on_device } = glance;
        self.draw(&Moment { frame, on_device: on_device.as_ref(), paths: &[], container: None })
    }

    /// True where a glance suffices for a picture: not where the terrain shows a map of the depth.
    pub fn show_glances(&self) -> bool {
        self.subject.shows_glances()
    }

    /// The particles of a model on the device that draws; none where they are elsewhere, or the host is to draw them.
    fn on_device(&self, model: &dyn Model) -> Result<Option<DeviceParticles>, Error> {
        let is_here = gpu_of(model).is_some_and(|device| device.is_same(self.gpu()));
        if is_here && self.subject.draws_from_device() { particles_of(model) } else { Ok(None) }
    }
}

/// The GPU that takes the steps of a model, if one does.
pub(crate) fn gpu_of(model: &dyn Model) -> Option<Gpu> {
    model.on_gpu().and_then(GpuModel::gpu)
}

/// The particles of a model in GPU memory, where it has them there.
pub(crate) fn particles_of(model: &dyn Model) -> Result<Option<DeviceParticles>, Error> {
    Ok(model.on_gpu().map(GpuModel::particles_on_gpu).transpose()?.flatten())
}

#[cfg(all(test, feature = "gpu"))]
mod tests {
    use super::*;
    use crate::Simulation;
    use crate::pictures::{CameraOffset, GroundStyle, PictureSettings, Quality};
    use corpuscle_gpu::require_gpu;
    use corpuscle_scene::{Scene, builtin};
    use std::path::Path;
    use std::sync::atomic::AtomicBool;

    /// Mean difference of two pictures, of 255.
    const SAME: f64 = 0.01;

    fn difference(one: &Image, other: &Image) -> f64 {
        let sum: u64 = one.rgba.iter().zip(&other.rgba).map(|(one, other)| u64::from(one.abs_diff(*other))).sum();
        sum as f64 / one.rgba.len() as f64
    }

    fn by_frame(pictures: &mut Pictures, model: &dyn Model) -> Image {
        let frame = model.frame();
        pictures.draw(&Moment { frame: &frame, on_device: None, paths: &[], container: None }).unwrap()
    }

    #[test]
    fn a_flood_on_the_gpu_is_drawn_from_there_and_looks_as_its_frame_does() {
        let Some(gpu) = require_gpu("a flood drawn where it lies") else { return };
        let coarse = [("flood.spacing_m", "2")];
        let coarse = coarse.map(|(path, value)| (path.to_owned(), value.to_owned()));
        let scene = Scene::parse(builtin("flood/dam-break").unwrap().text, "dam", &coarse).unwrap();
        let mut simulation = Simulation::open(scene, Path::new("")).unwrap();
        simulation.use_this_gpu(gpu.clone()).unwrap();
        simulation.model_mut().advance_to(4.0, &AtomicBool::new(false)).unwrap();
        let settings = |ground| PictureSettings {
            size: [480, 270],
            samples: 1,
            heights: 4.0,
            ground,
            ..PictureSettings::default()
        };
        let mut pictures = Pictures::open(&simulation, settings(GroundStyle::Natural)).unwrap();
        assert!(pictures.gpu().is_same(&gpu) && pictures.on_device(simulation.model()).unwrap().is_some());
        let image = pictures.draw_model(simulation.model()).unwrap();
        let mut others = Pictures::open_on(&gpu, &simulation, settings(GroundStyle::Natural)).unwrap();
        let apart = difference(&image, &by_frame(&mut others, simulation.model()));
        println!("{apart} of 255");
        assert!(apart < SAME, "{apart}");
        let nothing = Frame { time: 4.0, sets: Vec::new() };
        let dry = others.draw(&Moment { frame: &nothing, on_device: None, paths: &[], container: None }).unwrap();
        assert!(difference(&image, &dry) > 100.0 * SAME, "{}", difference(&image, &dry));
        // The same at simple quality.
        let device = simulation.seen_on(&gpu).unwrap().unwrap();
        let frame = simulation.model().frame();
        let mut simple = |on_device| {
            let moment = Moment { frame: &frame, on_device, paths: &[], container: None };
            let shown = others.show(&moment, &CameraOffset::default(), Quality::Simple, [1.0; 3]).unwrap();
            assert!(!shown.finished);
            others.resize([480, 270], 2).unwrap();
            others.show(&moment, &CameraOffset::default(), Quality::Simple, [1.0; 3]).unwrap();
            let image = others.read().unwrap();
            others.resize([480, 270], 1).unwrap();
            image
        };
        let apart = difference(&simple(Some(&device)), &simple(None));
        assert!(apart < SAME, "{apart}");
        // The host draws the map of the depth.
        let mut of_depth = Pictures::open(&simulation, settings(GroundStyle::Depth)).unwrap();
        assert!(of_depth.on_device(simulation.model()).unwrap().is_none());
        assert!(difference(&of_depth.draw_model(simulation.model()).unwrap(), &dry) > 100.0 * SAME);
    }

    #[test]
    fn air_on_the_gpu_is_drawn_from_there_and_looks_as_its_frame_does() {
        let Some(gpu) = require_gpu("air drawn where it lies") else { return };
        let coarse = [("dew.spacing_m".to_owned(), "0.002".to_owned())];
        let scene = Scene::parse(builtin("dew/three-boundaries").unwrap().text, "three", &coarse).unwrap();
        let mut simulation = Simulation::open(scene, Path::new("")).unwrap();
        simulation.use_this_gpu(gpu.clone()).unwrap();
        simulation.model_mut().advance_to(0.002, &AtomicBool::new(false)).unwrap();
        let settings = PictureSettings { size: [480, 270], samples: 1, ..PictureSettings::default() };
        let mut pictures = Pictures::open(&simulation, settings).unwrap();
        let from_device = pictures.draw_model(simulation.model()).unwrap();
        let by_frame = by_frame(&mut pictures, simulation.model());
        let apart = difference(&from_device, &by_frame);
        assert!(pictures.on_device(simulation.model()).unwrap().is_some() && apart < SAME, "{apart}");
        // A GPU that is not the one that draws has its frame drawn.
        assert!(!simulation.is_seen_on(&Gpu::open().unwrap()));
    }
}

//! Times of the passes of pictures.

use super::Pictures;
use super::flood::FloodPicture;
use corpuscle_gpu::{Gpu, PassTiming};
use corpuscle_render::FluidPass;
use std::collections::BTreeMap;

/// Times of the passes that draw water.
pub(super) type Times = BTreeMap<&'static str, PassTiming>;

impl Pictures {
    /// Times the passes that draw the water of a flood, from the next picture on: each of them then waits for the one before it.
    pub fn measure(&mut self) {
        let gpu = self.context.renderer.gpu().clone();
        self.subject.measure(&gpu);
    }

    /// Draws the water of a flood by compute shaders from now on, instead of raster units.
    pub fn splat(&mut self) {
        self.subject.splat();
    }

    /// What they have taken since, by name: kernels that make discs by the device's own clock, where it has one; passes over pixels from
    /// the start of their encoding to their end on the device.
    pub fn taken(&self) -> Vec<(&'static str, PassTiming)> {
        self.subject.taken()
    }
}

impl FloodPicture {
    pub(super) fn measure_passes(&mut self, gpu: &Gpu) {
        self.times = Some(Times::new());
        self.fluid.iter_mut().for_each(corpuscle_render::Fluid::measure);
        self.device_water.iter_mut().for_each(|water| water.measure(gpu));
    }

    /// Adds those of the picture that was drawn.
    pub(super) fn note_times(&mut self) {
        let (Some(times), Some(fluid)) = (&mut self.times, &self.fluid) else { return };
        for (pass, took) in fluid.times() {
            let taken = times.entry(name(*pass)).or_default();
            taken.times += 1;
            taken.total += *took;
        }
    }

    pub(super) fn taken_by_passes(&self) -> Vec<(&'static str, PassTiming)> {
        let discs = self.device_water.iter().flat_map(corpuscle_render::DeviceWater::taken);
        let pixels = self.times.iter().flatten().map(|(name, taken)| (*name, *taken));
        discs.chain(pixels).collect()
    }
}

fn name(pass: FluidPass) -> &'static str {
    match pass {
        FluidPass::Depth => "water's depth",
        FluidPass::Thickness => "water's thickness",
        FluidPass::Smoothing => "smoothing",
        FluidPass::Normals => "normals",
        FluidPass::Wetting => "wetting",
        FluidPass::Shading => "shading",
        FluidPass::Composing => "composing",
    }
}

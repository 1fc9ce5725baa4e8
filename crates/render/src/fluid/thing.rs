//! A fluid in a picture.

use super::droplet::Batch;
use super::layers::{Layers, Splats};
use super::wet_ground::WetGround;
use super::{DeviceWater, Droplet, FluidPainter, FluidPass, FluidStyle};
use crate::buffer::uniform;
use crate::shared::{Direction, DropletInstance};
use crate::{Drawable, RenderError, Stage, Through};
use corpuscle_gpu::{Gpu, read_rgba8, wgpu};
use std::time::Duration;
use web_time::Instant;

/// Particles in one buffer at most: within the floor's 256 MiB.
const MOST: usize = 4 << 20;

/// A fluid in a picture: particles, filled in anew for each frame, and a style.
#[derive(Debug)]
pub struct Fluid {
    pub(super) painter: FluidPainter,
    pub(super) stage: Stage,
    pub(super) style: FluidStyle,
    pub(super) settings: wgpu::Buffer,
    /// `Direction` of smoothing.wgsl.
    pub(super) along_rows: wgpu::Buffer,
    pub(super) along_columns: wgpu::Buffer,
    pub(super) droplets: Vec<Batch>,
    pub(super) wet_ground: WetGround,
    layers: Option<Layers>,
    /// True where compute shaders draw the particles.
    splats: bool,
    /// Times of the passes, where they are measured.
    times: Option<Vec<(FluidPass, Duration)>>,
    /// A pass that a test leaves out.
    #[cfg(test)]
    pub(super) skipped: Option<FluidPass>,
}

impl Fluid {
    pub(super) fn new(painter: FluidPainter, gpu: &Gpu, stage: Stage, style: FluidStyle) -> Result<Self, RenderError> {
        let wet_ground = WetGround::new(gpu, &stage, style.wet_cell, style.rounding, style.drying)?;
        Ok(Self {
            painter,
            stage,
            style,
            settings: uniform(gpu, "fluid", &style.uniforms(&stage, 0.0)),
            along_rows: uniform(gpu, "along rows", &Direction { step: [1, 0], unused: [0; 2] }),
            along_columns: uniform(gpu, "along columns", &Direction { step: [0, 1], unused: [0; 2] }),
            droplets: Vec::new(),
            wet_ground,
            layers: None,
            splats: false,
            times: None,
            #[cfg(test)]
            skipped: None,
        })
    }

    /// Replaces the particles. Those without finite position are left out.
    pub fn fill(&mut self, gpu: &Gpu, droplets: impl IntoIterator<Item = Droplet>) {
        let all: Vec<DropletInstance> = droplets.into_iter().filter_map(|droplet| droplet.drawn(&self.stage)).collect();
        self.droplets = all.chunks(MOST).map(|part| Batch::counted(gpu, part)).collect();
    }

    /// Sets the time of the picture, s: ripples have moved with the water since, and ground has dried. A time before that of the last picture
    /// makes all ground dry that is not under water.
    pub fn set_time(&mut self, gpu: &Gpu, time: f64) {
        gpu.queue.write_buffer(&self.settings, 0, bytemuck::bytes_of(&self.style.uniforms(&self.stage, time)));
        self.wet_ground.set_time(gpu, time);
    }

    /// Replaces the particles by water in GPU memory, in its state when the picture is drawn.
    pub fn draw_from(&mut self, water: &DeviceWater) {
        self.droplets = water.droplets().into_iter().collect();
    }

    /// Draws the particles by compute shaders instead of raster units, the default: no GPU has been measured with the former.
    pub fn splat(&mut self, splats: bool) {
        self.splats = splats;
    }

    /// Times each pass of the pictures to come, which makes them wait for one another.
    pub fn measure(&mut self) {
        self.times = Some(Vec::new());
    }

    /// What each pass of the last picture took, from the start of its encoding to its end on the device. Empty without
    /// [`Fluid::measure`].
    pub fn times(&self) -> &[(FluidPass, Duration)] {
        self.times.as_deref().unwrap_or_default()
    }

    /// Buffers of the compute shaders that draw the particles, if they do.
    pub(super) fn splats<'a>(&self, layers: &'a Layers) -> Option<&'a Splats> {
        layers.splats.as_ref().filter(|_| self.splats)
    }

    /// The smoothed surface of the last picture, row by row from the top: distance along the line of sight of the picture's
    /// middle, m; none where there is no fluid.
    ///
    /// # Errors
    /// [`RenderError::Gpu`] where the device was lost.
    pub fn distances(&self, gpu: &Gpu) -> Result<Vec<Option<f64>>, RenderError> {
        let Some(layers) = &self.layers else { return Ok(Vec::new()) };
        let numbers = read_rgba8(gpu, self.surface(layers))?.rgba;
        let distance = |bytes: &[u8; 4]| f64::from(f32::from_le_bytes(*bytes)) * self.stage.unit();
        Ok(numbers.as_chunks::<4>().0.iter().map(distance).map(|length| (length > 0.0).then_some(length)).collect())
    }

    /// The normals of that surface.
    ///
    /// # Errors
    /// [`RenderError::Gpu`] where the device was lost.
    pub fn normals(&self, gpu: &Gpu) -> Result<Vec<Option<[f64; 3]>>, RenderError> {
        let Some(layers) = &self.layers else { return Ok(Vec::new()) };
        let numbers = read_rgba8(gpu, &layers.normals)?.rgba;
        Ok(numbers.as_chunks::<4>().0.iter().map(|bytes| unfold(*bytes)).collect())
    }

    /// Ends what is encoded so far and waits for it.
    fn wait(frame: &mut Through<'_>) {
        let next = frame.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let encoder = std::mem::replace(frame.encoder, next);
        frame.gpu.queue.submit([encoder.finish()]);
        // A lost device is an error where the picture is read.
        let _ = frame.gpu.device.poll(wgpu::PollType::wait_indefinitely());
    }
}

impl Drawable for Fluid {
    fn lets_light_through(&self) -> bool {
        true
    }

    fn draw_through(&mut self, frame: &mut Through<'_>) {
        let fits = self.layers.take().filter(|layers| layers.size == frame.size);
        let mut layers = fits
            .unwrap_or_else(|| Layers::new(frame.gpu, frame.size).expect("no larger than the target, which is there"));
        if self.splats && layers.splats.is_none() {
            // Raster units need no such memory.
            layers.splats = Splats::new(frame.gpu, frame.size).ok();
            self.splats = layers.splats.is_some();
        }
        let timed = self.times.is_some();
        let mut times = Vec::new();
        if timed {
            Self::wait(frame);
        }
        for pass in FluidPass::ALL {
            #[cfg(test)]
            if self.skipped == Some(pass) {
                continue;
            }
            let start = Instant::now();
            self.encode(pass, &layers, frame);
            if timed {
                Self::wait(frame);
                times.push((pass, start.elapsed()));
            }
        }
        self.times = timed.then_some(times);
        self.layers = Some(layers);
    }
}

/// A direction of two numbers of 16 bits, as `fold` of fluid_normals.wgsl makes it.
fn unfold(bytes: [u8; 4]) -> Option<[f64; 3]> {
    if bytes == [0x00, 0x80, 0x00, 0x80] {
        return None;
    }
    let [x, y] = [[bytes[0], bytes[1]], [bytes[2], bytes[3]]].map(|two| f64::from(i16::from_le_bytes(two)) / 32767.0);
    let z = 1.0 - x.abs() - y.abs();
    let [x, y] = if z >= 0.0 { [x, y] } else { [(1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y)] };
    Some(glam::DVec3::new(x, y, z).normalize().into())
}

//! Choice of a device.

use crate::GpuError;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Duration;

/// What kind of device pictures are drawn with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GpuKind {
    /// A GPU in hardware.
    Hardware,
    /// A program in its place, such as Mesa's lavapipe.
    Software,
}

/// An open device with its queue. Clones are the same device.
#[derive(Debug, Clone)]
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// Name, as the driver gives it.
    pub name: String,
    /// A GPU, or a program in its place.
    pub kind: GpuKind,
    faults: Faults,
    compiled: Compiled,
}

/// The pipelines of a device by what they are compiled from, so that nothing is compiled twice: a second model or picture on the same device has them.
#[derive(Debug, Clone, Default)]
struct Compiled {
    computing: Once<wgpu::ComputePipeline>,
    drawing: Once<wgpu::RenderPipeline>,
}

/// What is made once for each text.
#[derive(Debug, Clone)]
struct Once<T>(Arc<Mutex<HashMap<String, T>>>);

impl<T> Default for Once<T> {
    fn default() -> Self {
        Self(Arc::default())
    }
}

impl<T: Clone> Once<T> {
    fn get(&self, text: String, make: impl FnOnce(&str) -> T) -> T {
        let mut made = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let known = made.get(&text).cloned();
        known.unwrap_or_else(|| {
            let new = make(&text);
            made.insert(text, new.clone());
            new
        })
    }
}

/// What went wrong on a device, which reports errors asynchronously.
#[derive(Debug, Clone, Default)]
struct Faults(Arc<Faulty>);

#[derive(Debug, Default)]
struct Faulty {
    /// Why the device was lost.
    loss: OnceLock<String>,
    /// The first call that failed. What goes wrong later follows from it.
    call: OnceLock<String>,
}

impl Faults {
    /// Listens to a device.
    fn of(device: &wgpu::Device) -> Self {
        let faults = Self::default();
        let (of_calls, of_loss) = (faults.clone(), faults.clone());
        device.on_uncaptured_error(Arc::new(move |error| _ = of_calls.0.call.set(error.to_string())));
        device.set_device_lost_callback(move |_, reason| _ = of_loss.0.loss.set(format!("it was lost ({reason})")));
        faults
    }

    /// What went wrong, if anything: calls on a device that was lost fail too, and may be heard of before the loss.
    fn first(&self, device: &wgpu::Device) -> Option<String> {
        let call = self.0.call.get();
        if call.is_some() {
            // A loss is told once what was under way has ended.
            _ = device.poll(wgpu::PollType::Wait { submission_index: None, timeout: Some(Duration::from_secs(1)) });
        }
        self.0.loss.get().or(call).cloned()
    }
}

impl Gpu {
    /// Features that a device needs to time kernels; requested where available, and nothing but [`crate::Stopwatch`] needs it.
    pub(crate) const TIMING: wgpu::Features =
        wgpu::Features::TIMESTAMP_QUERY.union(wgpu::Features::TIMESTAMP_QUERY_INSIDE_PASSES);

    /// Opens the best device: a discrete GPU, then an integrated one, then software. The first that keeps to the portable floor
    /// is taken.
    ///
    /// # Errors
    /// [`GpuError::NoDevice`], [`GpuError::Refused`].
    pub fn open() -> Result<Self, GpuError> {
        pollster::block_on(Self::open_async())
    }

    /// [`Gpu::open`] where one may not wait, as in a browser.
    ///
    /// # Errors
    /// Those of [`Gpu::open`].
    pub async fn open_async() -> Result<Self, GpuError> {
        let mut description = wgpu::InstanceDescriptor::new_without_display_handle();
        description.flags = wgpu::InstanceFlags::empty();
        let instance = wgpu::Instance::new(description);
        let mut adapters = instance.enumerate_adapters(wgpu::Backends::all()).await;
        adapters.sort_by_key(Self::rank);
        let mut refused = GpuError::NoDevice;
        for adapter in adapters {
            match adapter.request_device(&Self::request(&adapter)).await {
                Ok((device, queue)) => return Ok(Self::of(&adapter, device, queue)),
                Err(error) => refused = GpuError::Refused { name: adapter.get_info().name, reason: error.to_string() },
            }
        }
        Err(refused)
    }

    /// A device that the caller opened with [`Gpu::request`], such as a window's.
    pub fn of(adapter: &wgpu::Adapter, device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let info = adapter.get_info();
        let software = info.device_type == wgpu::DeviceType::Cpu;
        let kind = if software { GpuKind::Software } else { GpuKind::Hardware };
        let faults = Faults::of(&device);
        // Browsers tell none.
        let name = if info.name.is_empty() { "the browser's device".into() } else { info.name };
        Self { device, queue, name, kind, faults, compiled: Compiled::default() }
    }

    /// Whether this is the same device, opened once: what lies on one is not on another. (wgpu's own comparison takes the first devices of two
    /// instances for one.)
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.faults.0, &other.faults.0)
    }

    /// The request for a device: the portable limits, as much memory as there is, and timestamps if it has them.
    pub fn request(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
        wgpu::DeviceDescriptor {
            label: Some("corpuscle"),
            required_features: adapter.features() & Self::TIMING,
            required_limits: limits(&adapter.limits(), Self::rank(adapter) == rank(wgpu::DeviceType::Cpu)),
            ..wgpu::DeviceDescriptor::default()
        }
    }

    /// The order in which adapters are tried, the smallest first.
    pub fn rank(adapter: &wgpu::Adapter) -> u8 {
        rank(adapter.get_info().device_type)
    }

    /// Whether there was no error so far. A device reports errors late: call this again after reading something back.
    ///
    /// # Errors
    /// [`GpuError::Lost`] with what went wrong first.
    pub fn check(&self) -> Result<(), GpuError> {
        match self.faults.first(&self.device) {
            None => Ok(()),
            Some(reason) => Err(GpuError::Lost { name: self.name.clone(), reason }),
        }
    }

    /// The error of a call that failed: why the device was lost, where that is the reason.
    pub(crate) fn failed(&self, what: impl std::fmt::Display) -> GpuError {
        _ = self.faults.0.call.set(what.to_string());
        let reason = self.faults.first(&self.device).unwrap_or_default();
        GpuError::Lost { name: self.name.clone(), reason }
    }

    /// The compute pipeline that is compiled from a text; it is compiled where this device has not compiled it yet.
    pub fn computing(
        &self,
        text: String,
        compile: impl FnOnce(&str) -> wgpu::ComputePipeline,
    ) -> wgpu::ComputePipeline {
        self.compiled.computing.get(text, compile)
    }

    /// The pipeline that draws, compiled from what a text says: the shader's own, and all else that it depends on. It is compiled where this device
    /// has not compiled it yet.
    pub fn drawing(&self, text: String, compile: impl FnOnce(&str) -> wgpu::RenderPipeline) -> wgpu::RenderPipeline {
        self.compiled.drawing.get(text, compile)
    }

    /// Largest memory that a shader can see as one piece, bytes.
    pub fn most_bytes(&self) -> u64 {
        let limits = self.device.limits();
        limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
    }

    /// Largest width and height of a texture, pixels.
    pub fn most_pixels(&self) -> u32 {
        self.device.limits().max_texture_dimension_2d
    }
}

/// The portable floor, but as much memory as there is. Software takes uniform buffers as storage besides: see `Kernel`.
fn limits(most: &wgpu::Limits, software: bool) -> wgpu::Limits {
    let floor = wgpu::Limits::default();
    let storage = floor.max_storage_buffers_per_shader_stage;
    wgpu::Limits {
        max_storage_buffers_per_shader_stage: if software { storage + 2 } else { storage },
        max_storage_buffer_binding_size: most.max_storage_buffer_binding_size,
        max_buffer_size: most.max_buffer_size,
        ..floor
    }
}

/// What is taken first.
fn rank(kind: wgpu::DeviceType) -> u8 {
    match kind {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    }
}

/// The device for a test; none, after a line that says so, where there is none.
///
/// # Panics
/// Where there is none and the environment has `CORPUSCLE_REQUIRE_GPU=1`.
pub fn require_gpu(test: &str) -> Option<Gpu> {
    match Gpu::open() {
        Ok(gpu) => Some(gpu),
        Err(error) => {
            let required = std::env::var_os("CORPUSCLE_REQUIRE_GPU").is_some_and(|value| value == "1");
            assert!(!required, "{test} needs a GPU: {error}");
            eprintln!("skipped {test}: {error}");
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pipeline of a shader that does nothing but have a name.
    fn compile(gpu: &Gpu, text: &str) -> wgpu::ComputePipeline {
        let source = wgpu::ShaderSource::Wgsl(text.into());
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: None,
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        })
    }

    #[test]
    fn a_device_compiles_a_shader_once() {
        let Some(gpu) = require_gpu("shaders compiled once") else { return };
        let mut count = 0;
        let texts = ["one", "other", "one"].map(|name| format!("@compute @workgroup_size(1) fn {name}() {{}}"));
        for text in texts {
            gpu.clone().computing(text, |text| {
                count += 1;
                compile(&gpu, text)
            });
        }
        assert_eq!(count, 2);
    }
}

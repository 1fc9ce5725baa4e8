//! Programs that compute.

use crate::{Buffers, Gpu, GpuKind, Pass, ShaderLibrary};
use std::marker::PhantomData;

/// Threads in a group of every kernel that has one thread for each particle or cell.
pub const THREADS: u32 = 256;

/// Groups in one dimension at most (WebGPU's own limit).
pub const MOST_GROUPS: u32 = 65_535;

/// A compute shader, whose entry is `main` and whose bindings a declaration names: see [`declare!`](crate::declare).
#[derive(Debug)]
pub struct Kernel<B> {
    name: &'static str,
    pipeline: wgpu::ComputePipeline,
    /// Numbers of the bindings that it uses.
    used: Vec<u32>,
    of: PhantomData<B>,
}

/// A kernel with what it works on.
#[derive(Debug)]
pub struct Task {
    name: &'static str,
    pipeline: wgpu::ComputePipeline,
    bindings: wgpu::BindGroup,
}

impl<B: Buffers> Kernel<B> {
    /// Compiles the shader `text`, joined from its pieces, which imports the declaration; a device compiles the same shader once.
    ///
    /// # Panics
    /// Where a piece is missing from `library` or the shader is wrong, which a test of all shaders finds.
    pub fn new(gpu: &Gpu, name: &'static str, text: &str, library: ShaderLibrary<'_>) -> Self {
        let complete = B::declaration().complete(name, text, library);
        let (text, used) = complete.expect("a test completes every shader");
        let pipeline = gpu.computing(for_device(gpu, text), |text| {
            let source = wgpu::ShaderSource::Wgsl(text.into());
            let module = module(gpu, wgpu::ShaderModuleDescriptor { label: Some(name), source });
            gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(name),
                layout: None,
                module: &module,
                entry_point: Some("main"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            })
        });
        Self { name, pipeline, used, of: PhantomData }
    }

    /// Gives it the buffers that it uses.
    pub fn on(&self, gpu: &Gpu, buffers: &B) -> Task {
        let buffers = buffers.in_order();
        let entry = |&binding: &u32| {
            let resource = buffers[binding as usize].as_entire_binding();
            wgpu::BindGroupEntry { binding, resource }
        };
        let bindings = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(self.name),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &self.used.iter().map(entry).collect::<Vec<_>>(),
        });
        Task { name: self.name, pipeline: self.pipeline.clone(), bindings }
    }
}

/// The shader as a device runs it. On a GPU loops go without the count by which wgpu ends one that never would: it takes a tenth of the
/// time of a step of 60,000 particles, and a thirtieth of one of a million (see the guide's benchmarks).
#[allow(unsafe_code, reason = "wgpu drops the bound on loops only by an unsafe call; a measured gain")]
fn module(gpu: &Gpu, description: wgpu::ShaderModuleDescriptor<'_>) -> wgpu::ShaderModule {
    match gpu.kind {
        GpuKind::Software => gpu.device.create_shader_module(description),
        // SAFETY: what is read and written out of bounds is checked as ever. Only loops are trusted to end, and those of our shaders do: they
        // count up or down to a number that does not grow, or leave after a bounded number of turns.
        GpuKind::Hardware => unsafe {
            let checks =
                wgpu::ShaderRuntimeChecks { force_loop_bounding: false, ..wgpu::ShaderRuntimeChecks::checked() };
            gpu.device.create_shader_module_trusted(description, checks)
        },
    }
}

/// The text as a device takes it. Mesa's software Vulkan puts what uniform buffers hold into its programs wherever a loop or a choice
/// depends on them alone, and compiles anew at each dispatch: most of its time went there, and memory that it never gives back. What
/// lies in a storage buffer it leaves alone.
fn for_device(gpu: &Gpu, text: String) -> String {
    match gpu.kind {
        GpuKind::Software => text.replace("var<uniform>", "var<storage, read>"),
        GpuKind::Hardware => text,
    }
}

impl Task {
    /// Runs it with a number of groups of threads.
    pub fn run(&self, pass: &mut Pass<'_>, groups: u32) {
        self.set(pass);
        pass.pass.dispatch_workgroups(groups, 1, 1);
        pass.mark(self.name);
    }

    /// Does it with as many groups as the three numbers at `slot` of `groups` say, each slot being 12 bytes: the device itself decides.
    pub fn dispatch_indirect(&self, pass: &mut Pass<'_>, groups: &wgpu::Buffer, slot: u32) {
        self.set(pass);
        pass.pass.dispatch_workgroups_indirect(groups, 12 * u64::from(slot));
        pass.mark(self.name);
    }

    fn set(&self, pass: &mut Pass<'_>) {
        pass.pass.set_pipeline(&self.pipeline);
        pass.pass.set_bind_group(0, &self.bindings, &[]);
    }
}

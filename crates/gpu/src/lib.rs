//! The GPU: which one, within which limits, memory and programs on it, sorting into cells, pictures off screen and back,
//! shaders joined from pieces.
//!
//! Everything here keeps to the portable floor, so that the same shaders run in a browser: WebGPU's default limits (8 storage
//! buffers a stage, 256 threads a group, 65535 groups a dimension), no optional feature. As much memory is requested as the device
//! has to give: 128 MiB a binding at least.

mod buffer;
mod declare;
mod device;
mod error;
mod group_layout;
mod image;
mod kernel;
mod particles;
mod pass;
mod reflect;
mod shader;
mod sort;
mod steps;
mod texture;

pub use buffer::{filled, read, read_together, storage, uniform, wait_for};
pub use declare::{
    AtomicI32, AtomicU32, Binding, Buffers, DECLARED, Declaration, Layout, Member, Shared, SharedConstant, SharedPiece,
    SharedStruct,
};
pub use device::{Gpu, GpuKind, require_gpu};
pub use error::{GpuError, ImportError};
pub use group_layout::GroupLayout;
pub use image::Image;
pub use kernel::{Kernel, MOST_GROUPS, THREADS, Task};
pub use particles::{DeviceParticle, DeviceParticles, Seen, SeenParticles};
pub use pass::{Pass, PassTiming, Stopwatch, submit};
pub use reflect::{MOST_STORAGE_BUFFERS, MOST_THREADS, check_layouts, check_layouts_in, check_shader};
pub use shader::{COMPENSATED_SUMS, GROUP_REDUCTION, SUMS_BEFORE, ShaderLibrary, join};
pub use sort::{CellSort, SortSlots, sort_blocks};
pub use steps::{
    ARRIVED, BATCH_START, BROKEN, Batches, GOING, Halt, MOST_STEPS, NEEDS_HOST, SORT_BLOCK, Stepping, from_halves,
    from_pair, to_pair,
};
pub use texture::{read_rgba8, read_rgba8_later, texture_2d};
pub use wgpu;

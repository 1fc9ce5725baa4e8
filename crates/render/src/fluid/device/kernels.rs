//! The kernels that make discs of water on the device.

use corpuscle_gpu::{DEVICE_PARTICLES, Gpu, Kernel, ShaderLibrary};

/// Pieces that they import.
const LIBRARY: ShaderLibrary<'_> = &[
    DEVICE_PARTICLES,
    ("water_device", include_str!("water_device.wgsl")),
    ("water_borders", include_str!("water_borders.wgsl")),
    ("water_planes", include_str!("water_planes.wgsl")),
];

/// One for each pass, in their order.
#[derive(Debug)]
pub(super) struct Kernels {
    pub begin: Kernel,
    pub count: Kernel,
    pub columns: Kernel,
    pub told: Kernel,
    pub settle: Kernel,
    pub settled: Kernel,
    pub calm: Kernel,
    pub discs: Kernel,
    pub foam: Kernel,
    pub levels: Kernel,
    pub faces: Kernel,
}

impl Kernels {
    pub fn new(gpu: &Gpu) -> Self {
        macro_rules! kernel {
            ($name:literal) => {
                Kernel::new(gpu, $name, include_str!(concat!($name, ".wgsl")), LIBRARY)
            };
        }
        Self {
            begin: kernel!("water_begin"),
            count: kernel!("water_count"),
            columns: kernel!("water_columns"),
            told: kernel!("water_told"),
            settle: kernel!("water_settle"),
            settled: kernel!("water_settled"),
            calm: kernel!("water_calm"),
            discs: kernel!("water_discs"),
            foam: kernel!("water_foam"),
            levels: kernel!("water_levels"),
            faces: kernel!("water_faces"),
        }
    }
}

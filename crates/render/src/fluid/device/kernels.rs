//! The kernels that make discs of water on the device.

use super::shared::Memory;
use corpuscle_gpu::{Gpu, Kernel, ShaderLibrary};

type OfWater = Kernel<Memory>;

/// Pieces that they import.
const LIBRARY: ShaderLibrary<'_> = &[
    ("water_device", include_str!("water_device.wgsl")),
    ("water_borders", include_str!("water_borders.wgsl")),
    ("water_planes", include_str!("water_planes.wgsl")),
];

/// One for each pass, in their order.
#[derive(Debug)]
pub(super) struct Kernels {
    pub begin: OfWater,
    pub count: OfWater,
    pub columns: OfWater,
    pub draw_arguments: OfWater,
    pub settle: OfWater,
    pub settled: OfWater,
    pub calm: OfWater,
    pub discs: OfWater,
    pub foam: OfWater,
    pub levels: OfWater,
    pub faces: OfWater,
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
            draw_arguments: kernel!("water_draw_arguments"),
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

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_gpu::{Buffers, check_layouts, check_shader};

    #[test]
    fn every_shader_is_valid_and_within_the_floor() {
        check_layouts(&Memory::declaration()).unwrap();
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/fluid/device");
        let mut count = 0;
        for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            let text = std::fs::read_to_string(&path).unwrap_or_default();
            if path.extension().is_some_and(|extension| extension == "wgsl") && text.contains("@compute") {
                let name = path.file_stem().unwrap().to_str().unwrap();
                let (text, _) = Memory::declaration().complete(name, &text, LIBRARY).unwrap();
                check_shader(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
                count += 1;
            }
        }
        assert_eq!(count, 11);
    }
}

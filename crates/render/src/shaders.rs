//! The modules that shaders of this crate import.

use crate::shared::declared;
use corpuscle_gpu::{DECLARED, Gpu, GroupLayout, ImportError, join, wgpu};

/// Pieces by name: see `#import`.
const LIBRARY: [(&str, &str); 20] = [
    ("full_screen", include_str!("full_screen.wgsl")),
    ("noise", include_str!("noise.wgsl")),
    ("view", include_str!("view.wgsl")),
    ("sky", include_str!("sky/sky.wgsl")),
    ("light", include_str!("light.wgsl")),
    ("ball", include_str!("balls/ball.wgsl")),
    ("ball_corner", include_str!("balls/ball_corner.wgsl")),
    ("cap", include_str!("caps/cap.wgsl")),
    ("droplet", include_str!("fluid/droplet.wgsl")),
    ("droplet_depth", include_str!("fluid/droplet_depth.wgsl")),
    ("droplet_matter", include_str!("fluid/droplet_matter.wgsl")),
    ("fluid", include_str!("fluid/fluid.wgsl")),
    ("ripples", include_str!("fluid/ripples.wgsl")),
    ("mirror", include_str!("fluid/mirror.wgsl")),
    ("press", include_str!("tone/press.wgsl")),
    ("smoothing", include_str!("fluid/smoothing.wgsl")),
    ("surface", include_str!("solids/surface.wgsl")),
    ("cut", include_str!("terrain/cut.wgsl")),
    ("splat", include_str!("fluid/splat.wgsl")),
    ("splat_sums", include_str!("fluid/splat_sums.wgsl")),
];

/// Constants of shaders of what is never in a room: without the street before its windows they are half as long.
const OUTDOORS: &[(&str, f64)] = &[("may_be_in_room", 0.0)];

/// The text of a shader of this crate, joined from its pieces. `text` is the file of the same name.
fn joined(name: &str, text: &str) -> Result<String, ImportError> {
    let declared = declared();
    let library: Vec<_> = LIBRARY.into_iter().chain([(DECLARED, declared.as_str())]).collect();
    join(name, text, &library)
}

/// A shader of this crate, joined from its pieces.
pub(crate) struct Shader<'a> {
    /// Its name.
    pub name: &'a str,
    /// The whole of it.
    pub text: String,
    /// Constants that are not as the text says.
    constants: &'static [(&'static str, f64)],
}

impl<'a> Shader<'a> {
    /// The shader of a name; `text` is the file of the same name.
    pub(crate) fn new(name: &'a str, text: &str) -> Self {
        Self { name, text: joined(name, text).expect("a test joins every shader"), constants: &[] }
    }

    /// The same of what is never in a room.
    pub(crate) fn outdoors(self) -> Self {
        Self { constants: OUTDOORS, ..self }
    }

    /// What tells it from other shaders.
    pub(crate) fn key(&self) -> String {
        format!("{:?} {}", self.constants, self.text)
    }

    /// Options of a pipeline that it is in.
    pub(crate) fn options(&self) -> wgpu::PipelineCompilationOptions<'_> {
        wgpu::PipelineCompilationOptions { constants: self.constants, ..Default::default() }
    }

    /// Its module on a device.
    pub(crate) fn module(&self, gpu: &Gpu) -> wgpu::ShaderModule {
        gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(self.name),
            source: wgpu::ShaderSource::Wgsl(self.text.as_str().into()),
        })
    }
}

impl Shader<'static> {
    /// The layout of one of its groups.
    pub(crate) fn group(&self, gpu: &Gpu, group: u32) -> GroupLayout {
        GroupLayout::new(&gpu.device, self.name, group, &[&self.text]).expect("the shader is valid, as a test says")
    }
}

/// The layout of a group that shaders of this crate share; their names and texts are as for [`Shader::new`].
pub(crate) fn layout(gpu: &Gpu, label: &'static str, group: u32, shaders: &[(&str, &str)]) -> GroupLayout {
    let whole = |(name, text): &(&str, &str)| joined(name, text).expect("a test joins every shader");
    let texts: Vec<String> = shaders.iter().map(whole).collect();
    let texts: Vec<&str> = texts.iter().map(String::as_str).collect();
    GroupLayout::new(&gpu.device, label, group, &texts).expect("the shader is valid, as a test says")
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_gpu::{SharedPiece, check_layouts_in, check_shader};
    use std::path::Path;

    /// Name and text of every shader below a folder, but for those of kernels that have a declaration of their own.
    fn shaders_below(folder: &Path) -> Vec<(String, String)> {
        let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let of = |path: std::path::PathBuf| {
            if path.is_dir() && !path.ends_with("fluid/device") {
                return shaders_below(&path);
            }
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            let is_shader = path.extension().is_some_and(|extension| extension == "wgsl") && name != "balls_device";
            is_shader.then(|| (name, std::fs::read_to_string(&path).unwrap())).into_iter().collect()
        };
        entries.flat_map(of).collect()
    }

    #[test]
    fn every_shader_is_valid_and_within_the_floor() {
        let all = shaders_below(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
        for (name, text) in &all {
            let text = joined(name, text).unwrap();
            check_shader(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
        }
        assert!(all.len() > 30, "{} shaders", all.len());
    }

    /// Mesa's software Vulkan compiles a shader anew for each picture, and keeps it, where a branch depends on parameters alone and the shader is much shorter
    /// without it: `select` takes its place.
    #[test]
    fn no_branch_depends_on_parameters_alone() {
        let all = shaders_below(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
        let parameters = ["view.", "fluid.", "ground.", "is_paper()", "!is_paper()"];
        let begins = |line: &str| {
            let condition = line.trim_start().strip_prefix("if ").or(line.trim_start().strip_prefix("} else if "));
            condition.is_some_and(|condition| parameters.iter().any(|parameter| condition.starts_with(parameter)))
        };
        let is_branch = |line: &&str| begins(line) && !line.contains(" | ") && !line.contains(" & ");
        let lines = |(name, text): &(String, String)| -> Vec<String> {
            text.lines().filter(is_branch).map(|line| format!("{name}: {}", line.trim())).collect()
        };
        let found: Vec<String> = all.iter().flat_map(lines).collect();
        // Short with either branch.
        assert_eq!(found, ["terrain: if ground.cell.w == 0.0 {"]);
    }

    #[test]
    fn host_and_device_lay_structures_out_alike() {
        use crate::shared::{Bound, Vertices};
        check_layouts_in(&Bound::wgsl(), &Bound::structs()).unwrap();
        check_layouts_in(&Vertices::wgsl(), &Vertices::structs()).unwrap();
    }
}

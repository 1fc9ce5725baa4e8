//! The modules that shaders of this crate import.

use crate::shared::declared;
use corpuscle_gpu::{DECLARED, Gpu, GroupLayout, ImportError, join, wgpu};

/// Pieces by name: see `#import`.
const LIBRARY: [(&str, &str); 22] = [
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
    ("wet_ground", include_str!("fluid/wet_ground/wet_ground.wgsl")),
    ("wetness", include_str!("fluid/wet_ground/wetness.wgsl")),
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

    /// Names of the parameters of all shaders: what is uniform.
    fn parameters(all: &[(String, String)]) -> Vec<&str> {
        let declared = |line: &'_ str| -> Option<(usize, usize)> {
            let start = line.find("var<uniform> ")? + "var<uniform> ".len();
            Some((start, start + line[start..].find(':')?))
        };
        let names = all.iter().flat_map(|(_, text)| text.lines());
        names.filter_map(|line| declared(line).map(|(start, end)| &line[start..end])).collect()
    }

    /// True where a condition names parameters and nothing else that could differ within a picture.
    fn is_of_parameters_alone(condition: &str, parameters: &[&str]) -> bool {
        let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_' || letter == '.' || letter == '(';
        let words = condition.split(|letter| !is_part(letter)).map(|word| word.trim_start_matches('('));
        let mut words = words.filter(|word| word.starts_with(|first: char| first.is_ascii_alphabetic())).peekable();
        let is_parameter = |word: &str| {
            word.starts_with("is_paper(") || parameters.contains(&word.split('.').next().unwrap_or_default())
        };
        words.peek().is_some() && words.all(is_parameter)
    }

    /// The conditions of a line that become branches: those of `if`, and each that `&&` and `||` join.
    fn branches(line: &str) -> Vec<&str> {
        let code = line.split("//").next().unwrap_or_default();
        let joined = code.contains("&&") || code.contains("||");
        let of_if = code.split_once("if ").filter(|(before, _)| before.trim().trim_start_matches("} else").is_empty());
        let condition =
            of_if.or_else(|| code.split_once("= ").or_else(|| code.split_once("return ")).filter(|_| joined));
        condition.map_or(Vec::new(), |(_, condition)| condition.split("&&").flat_map(|part| part.split("||")).collect())
    }

    /// Mesa's software Vulkan compiles a shader anew for each picture, and keeps it, where a branch depends on parameters alone and the shader is much
    /// shorter without it: `select`, `&` and `|` take its place.
    #[test]
    fn no_branch_depends_on_parameters_alone() {
        let all = shaders_below(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
        let parameters = parameters(&all);
        assert!(parameters.contains(&"view") && parameters.contains(&"fluid"), "{parameters:?}");
        let is_branch = |line: &&str| branches(line).iter().any(|one| is_of_parameters_alone(one, &parameters));
        let lines = |(name, text): &(String, String)| -> Vec<String> {
            text.lines().filter(is_branch).map(|line| format!("{name}: {}", line.trim())).collect()
        };
        let mut found: Vec<String> = all.iter().flat_map(lines).collect();
        found.sort();
        // Short with either branch.
        let known = ["terrain: if ground.cell.w == 0.0 {"];
        let of_tone = found.extract_if(.., |line| line.starts_with("tone: ")).count();
        assert!(found == known && of_tone == 4, "{found:#?} and {of_tone} of tone");
    }

    #[test]
    fn branches_on_parameters_are_told_from_others() {
        let is_one = |line: &str| branches(line).iter().any(|one| is_of_parameters_alone(one, &["view", "style"]));
        for line in
            ["if view.eye.w > 0.5 {", "} else if !is_paper() {", "let a = style.roof.w > 0.5 && normal.z > 0.5;"]
        {
            assert!(is_one(line), "{line}");
        }
        for line in [
            "if moving * view.eye.w > 0.5 {",
            "let a = view.eye.w > 0.5;",
            "if is_paper() | (at.w < 0.5) {",
            "return view.a > 1.5;",
            "// if view.a {",
        ] {
            assert!(!is_one(line), "{line}");
        }
    }

    #[test]
    fn host_and_device_lay_structures_out_alike() {
        use crate::shared::{Bound, Vertices};
        check_layouts_in(&Bound::wgsl(), &Bound::structs()).unwrap();
        check_layouts_in(&Vertices::wgsl(), &Vertices::structs()).unwrap();
    }
}

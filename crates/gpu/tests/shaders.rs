//! Every shader of the project: valid, and within the portable floor.

use corpuscle_gpu::{DECLARED, MOST_STORAGE_BUFFERS, MOST_THREADS};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::fs;
use std::path::{Path, PathBuf};

fn shaders_below(folder: &Path, found: &mut Vec<PathBuf>) {
    for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if path.is_dir() {
            shaders_below(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "wgsl") {
            found.push(path);
        }
    }
}

/// Name and text of every shader in the tree, but for those that import a declaration of their model, themselves or by another: the model tests them.
fn all_shaders() -> Vec<(String, String)> {
    let mut paths = Vec::new();
    shaders_below(&Path::new(env!("CARGO_MANIFEST_DIR")).join(".."), &mut paths);
    paths.sort();
    let name = |path: &Path| path.file_stem().unwrap().to_str().unwrap().to_owned();
    let all: Vec<_> = paths.iter().map(|path| (name(path), fs::read_to_string(path).unwrap())).collect();
    let library: Vec<(&str, &str)> = all
        .iter()
        .map(|(name, text)| (name.as_str(), text.as_str()))
        .chain([(DECLARED, MARK), ("smoothing_kernel", MARK)])
        .collect();
    let is_whole = |(name, text): &&(String, String)| {
        let joined = corpuscle_gpu::join(name, text, &library);
        !text.contains("#import declared") && !joined.is_ok_and(|text| text.contains(MARK))
    };
    all.iter().filter(is_whole).cloned().collect()
}

/// Stands for what a model declares.
const MARK: &str = "// declared";

fn check(text: &str) -> Result<naga::Module, String> {
    let module = naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))?;
    // No capability: what WebGPU has without any feature.
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|error| error.emit_to_string(text))?;
    Ok(module)
}

#[test]
fn every_shader_is_valid_and_within_the_floor() {
    let shaders = all_shaders();
    let library: Vec<(&str, &str)> = shaders.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    assert!(!library.is_empty());
    for (name, text) in &library {
        let named_so = library.iter().filter(|(other, _)| other == name).count();
        assert_eq!(named_so, 1, "{name}.wgsl: imports go by name, so each name is there once");
        let joined = corpuscle_gpu::join(name, text, &library).unwrap();
        let module = check(&joined).unwrap_or_else(|error| panic!("{name}.wgsl: {error}"));
        for entry in &module.entry_points {
            let threads: u32 = entry.workgroup_size.iter().product();
            assert!(threads <= MOST_THREADS, "{name}.wgsl: {} has {threads} threads a group", entry.name);
        }
        let storage = |space: naga::AddressSpace| matches!(space, naga::AddressSpace::Storage { .. });
        let buffers = module.global_variables.iter().filter(|(_, variable)| storage(variable.space)).count();
        assert!(buffers <= MOST_STORAGE_BUFFERS, "{name}.wgsl has {buffers} storage buffers");
    }
}

#[test]
fn a_shader_beyond_the_floor_is_refused() {
    assert!(check("@compute @workgroup_size(64) fn main() { let x = 1.0; }").is_ok());
    assert!(check("@compute @workgroup_size(64) fn main() { let x = 1.0lf; }").is_err());
    assert!(check("enable subgroups;\n@compute @workgroup_size(64) fn main() { let x = subgroupAdd(1.0); }").is_err());
}

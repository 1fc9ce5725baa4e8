//! No constant and no structure that host and shaders share stands twice.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A file, its crate, and what stands in it.
struct Source {
    file: String,
    of: String,
    text: String,
}

/// All files of a kind below the sources of all crates.
fn sources(extension: &str) -> Vec<Source> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut found = Vec::new();
    for entry in fs::read_dir(crates).unwrap().map(|entry| entry.unwrap()) {
        let of = entry.file_name().to_string_lossy().into_owned();
        collect(&entry.path().join("src"), &of, extension, &mut found);
    }
    assert!(found.len() > 50, "{} files of kind {extension}", found.len());
    found
}

fn collect(folder: &Path, of: &str, extension: &str, found: &mut Vec<Source>) {
    for path in fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path()) {
        if path.is_dir() {
            collect(&path, of, extension, found);
        } else if path.extension().is_some_and(|own| own == extension) {
            let text = fs::read_to_string(&path).unwrap();
            found.push(Source { file: path.display().to_string(), of: of.into(), text });
        }
    }
}

/// The names of the constants of a text, Rust or WGSL.
fn constants(text: &str) -> Vec<&str> {
    let lines = text.lines().map(str::trim_start).filter(|line| !line.starts_with("//"));
    lines.filter_map(constant).collect()
}

/// The name of the constant that a line declares.
fn constant(line: &str) -> Option<&str> {
    let (before, rest) = line.split_once("const ")?;
    let is_declared = before.is_empty() || before.starts_with("pub");
    let (name, _) = rest.split_once([':', ' ', '='])?;
    (is_declared && name.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_')).then_some(name)
}

/// Name and members of the structures of a WGSL text, without comments and spaces.
fn structures(text: &str) -> Vec<(String, String)> {
    let bare: String = text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect();
    let mut found = Vec::new();
    for part in bare.split("struct ").skip(1) {
        if let Some((name, rest)) = part.split_once('{')
            && let Some((members, _)) = rest.split_once('}')
        {
            found.push((name.trim().to_owned(), members.split_whitespace().collect()));
        }
    }
    found
}

/// Constants that two shaders have by one name, with the same value or another, or a shader and the Rust code of its crate or of the crate for all that have shaders.
fn repeated_constants(shaders: &[Source], code: &[Source]) -> Vec<String> {
    let mut repeated = Vec::new();
    for (number, shader) in shaders.iter().enumerate() {
        for name in constants(&shader.text) {
            let of_crate = code.iter().filter(|source| source.of == shader.of || source.of == "gpu");
            let others = shaders[number + 1..].iter().chain(of_crate);
            let same = others.filter(|other| constants(&other.text).contains(&name));
            repeated.extend(same.map(|other| format!("{name}: {} and {}", shader.file, other.file)));
        }
    }
    repeated
}

/// Structures that two shaders have with the same members.
fn repeated_structures(shaders: &[Source]) -> Vec<String> {
    let mut first: BTreeMap<String, String> = BTreeMap::new();
    let mut repeated = Vec::new();
    for shader in shaders {
        for (name, members) in structures(&shader.text) {
            let here = format!("{name} in {}", shader.file);
            if let Some(there) = first.get(&members) {
                repeated.push(format!("{here} is {there}"));
            }
            first.insert(members, here);
        }
    }
    repeated
}

#[test]
fn no_constant_stands_twice() {
    let repeated = repeated_constants(&sources("wgsl"), &sources("rs"));
    assert!(repeated.is_empty(), "declare these once (`declare!`):\n{}", repeated.join("\n"));
}

#[test]
fn no_structure_stands_twice() {
    let repeated = repeated_structures(&sources("wgsl"));
    assert!(repeated.is_empty(), "declare these once (`declare!`), or in a piece:\n{}", repeated.join("\n"));
}

/// Whether a Rust text lays out a structure, to be copied as bytes, that a shader could have too: WGSL has no numbers of 64 bits.
fn lays_out_for_shaders(text: &str) -> bool {
    let members =
        |part: &str| part.split_once('{').and_then(|(_, rest)| rest.split_once('}')).map(|found| found.0.to_owned());
    let is_of_shaders = |members: String| !["f64", "u64", "i64"].iter().any(|wide| members.contains(wide));
    text.contains("Pod") && text.split("repr(C").skip(1).filter_map(members).any(is_of_shaders)
}

/// Structures that the device sees come from declarations, which give the WGSL too.
#[test]
fn no_structure_is_laid_out_by_hand() {
    let shaders = sources("wgsl");
    let has_shaders = |source: &Source| shaders.iter().any(|shader| shader.of == source.of);
    let code = sources("rs");
    let handwritten = code.iter().filter(|source| lays_out_for_shaders(&source.text) && has_shaders(source));
    let handwritten: Vec<_> = handwritten.map(|source| &source.file).collect();
    assert!(handwritten.len() == 1 && handwritten[0].ends_with("gpu/src/declare.rs"), "{handwritten:#?}");
}

#[test]
fn structures_of_messages_are_none_of_shaders() {
    let structure = |members: &str| format!("#[derive(Pod)]\n#[repr(C)]\nstruct Of {{ {members} }}");
    assert!(lays_out_for_shaders(&structure("position: [f32; 3], id: u32")));
    assert!(!lays_out_for_shaders(&structure("position: [f64; 3], id: u32")));
}

/// Kernels of models, and of crates that only compute, get their bindings from declarations.
#[test]
fn no_kernel_writes_its_bindings() {
    let draws = ["render", "app"];
    let writes = |source: &&Source| source.text.contains("@binding") && !draws.contains(&source.of.as_str());
    let found: Vec<_> = sources("wgsl").iter().filter(writes).map(|source| source.file.clone()).collect();
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn what_stands_twice_is_found() {
    let source = |file: &str, text: &str| Source { file: file.into(), of: "flood".into(), text: text.into() };
    let shaders = [
        source("a.wgsl", "const THIN = 1e-6;\nconst NAMES = 3u;\nstruct A {\n    // m\n    depth: f32,\n}\n"),
        source("b.wgsl", "const THIN: f32 = 2e-6;\nconst PAIR = vec2f(1.5, 2.0);\nstruct B { depth: f32, }\n"),
    ];
    let code = [source(
        "c.rs",
        "pub(crate) const NAMES: usize = 4;\n/// const NAMES = 3;\nconst OTHER: f64 = 3.0;\n    const PAIR: [f64; 2] = [1.5, 2.0];\nconst fn thin() {}",
    )];
    let constants = repeated_constants(&shaders, &code);
    let found = ["THIN", "NAMES", "PAIR"].map(|name| constants.iter().filter(|line| line.starts_with(name)).count());
    assert_eq!((found, constants.len()), ([1; 3], 3), "{constants:?}");
    assert_eq!(repeated_structures(&shaders), ["B in b.wgsl is A in a.wgsl"]);
}

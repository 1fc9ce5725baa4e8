//! The README and the guide tell every command, option and case that there is, and their links lead somewhere.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What the binary says, on both ways out.
fn corpuscle(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_corpuscle")).args(arguments).output().unwrap();
    String::from_utf8([output.stdout, output.stderr].concat()).unwrap()
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn page(name: &str) -> String {
    fs::read_to_string(root().join("docs/src").join(name)).unwrap()
}

/// The pages of the guide.
fn pages() -> Vec<PathBuf> {
    let pages = fs::read_dir(root().join("docs/src")).unwrap().map(|entry| entry.unwrap().path());
    pages.filter(|path| path.extension().is_some_and(|ending| ending == "md")).collect()
}

/// Where the links of a page lead.
fn links(text: &str) -> Vec<&str> {
    text.split("](").skip(1).filter_map(|rest| rest.split(')').next()).collect()
}

/// A heading as the end of a link.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.map(|c| if c == ' ' { '-' } else { c.to_ascii_lowercase() }).collect()
}

#[test]
fn every_option_and_command_is_told() {
    let told = page("command-line.md");
    let plain =
        ["run", "render", "export", "view", "check", "scenes", "validate", "bench"].map(|command| vec![command]);
    let terrain = ["fetch", "info", "clip"].map(|command| vec!["terrain", command]);
    for words in plain.into_iter().chain(terrain) {
        let command = words.join(" ");
        assert!(told.contains(&format!("**{command}**")), "{command}");
        let help = corpuscle(&[&words[..], &["--help"]].concat());
        let options: Vec<_> = help.split_whitespace().filter(|word| word.starts_with("--")).collect();
        assert!(options.len() > 2, "{help}");
        for option in options {
            let option = option.trim_end_matches([',', '`']);
            assert!(told.contains(&format!("`{option}")), "{command} {option}");
        }
    }
}

#[test]
fn every_case_and_built_in_scene_is_told() {
    let refused = corpuscle(&["validate", "no-such-case"]);
    let told =
        ["validation-voronoi.md", "validation-flood.md", "validation-gas.md", "validation-dew.md"].map(page).concat();
    let cases: Vec<_> = refused.split("there are:").nth(1).unwrap().split(',').map(str::trim).collect();
    assert!(cases.len() > 5, "{refused}");
    for case in cases {
        assert!(told.contains(&format!("**`{case}`**")), "{case}");
    }
    let told = [page("first-flood.md"), page("first-gas.md"), page("first-dew.md")].concat();
    let list = corpuscle(&["scenes"]);
    let names: Vec<_> = list.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert!(names.len() > 3, "{list}");
    for name in names {
        assert!(told.contains(&format!("`{name}`")), "{name}");
    }
}

#[test]
fn links_lead_to_files_and_headings_that_exist() {
    let mut texts = pages();
    texts.extend(["README.md", "ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md"].map(|name| root().join(name)));
    let mut followed = 0;
    for path in texts {
        let text = fs::read_to_string(&path).unwrap();
        for link in links(&text).into_iter().filter(|link| !link.contains("://")) {
            let (file, heading) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { path.clone() } else { path.parent().unwrap().join(file) };
            assert!(target.exists(), "{}: {link}", path.display());
            if !heading.is_empty() {
                let text = fs::read_to_string(&target).unwrap();
                let mut headings =
                    text.lines().filter(|line| line.starts_with('#')).map(|line| line.trim_start_matches('#'));
                assert!(headings.any(|line| anchor(line) == heading), "{}: {link}", path.display());
            }
            followed += 1;
        }
    }
    assert!(followed > 30, "{followed}");
}

#[test]
fn the_table_of_contents_names_every_page() {
    let summary = page("SUMMARY.md");
    for page in pages() {
        let name = page.file_name().unwrap().to_str().unwrap();
        assert!(name == "SUMMARY.md" || summary.contains(&format!("({name})")), "{name}");
    }
}

/// The Rust files of a folder and of those in it.
fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let of = |path: PathBuf| match path.is_dir() {
        true => rust_files(&path),
        false => vec![path],
    };
    entries.flat_map(of).filter(|path| path.extension().is_some_and(|ending| ending == "rs")).collect()
}

#[test]
fn the_architecture_lists_every_file_with_code_of_one_platform() {
    let text = fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    let list = text.split("by `cfg(target_arch)` in these files alone: ").nth(1).unwrap().split(". ").next().unwrap();
    let mut told: Vec<_> = list.split('`').skip(1).step_by(2).map(str::to_owned).collect();
    told.sort();
    let crates = root().join("crates");
    let sources = fs::read_dir(&crates).unwrap().map(|entry| entry.unwrap().path().join("src"));
    let files = sources.filter(|folder| folder.is_dir()).flat_map(|folder| rust_files(&folder));
    let has_one = |path: &PathBuf| fs::read_to_string(path).unwrap().contains("target_arch = ");
    let name = |path: PathBuf| path.strip_prefix(&crates).unwrap().to_string_lossy().into_owned();
    let mut found: Vec<_> = files.filter(has_one).map(name).collect();
    found.sort();
    assert_eq!(told, found);
}

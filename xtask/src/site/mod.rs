//! The site: start page, guide, and the window as a page.

mod guide;
mod offline;
mod program;
mod start;

use anyhow::{Context, Result, ensure};
use flate2::Compression;
use flate2::write::GzEncoder;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Largest size of the program, compressed, bytes.
const MOST: u64 = 6_000_000;

/// Files of the pages as they are.
const PAGES: [(&str, &str); 4] = [
    ("style.css", include_str!("../../pages/style.css")),
    ("app/index.html", include_str!("../../pages/app.html")),
    ("app/page.js", include_str!("../../pages/page.js")),
    ("app/worker.js", include_str!("../../pages/worker.js")),
];

/// Makes the site in a folder.
///
/// # Errors
/// Where the program cannot be built, a file not be written, or a page of the guide names one that is not there.
pub fn make(out: &Path) -> Result<()> {
    let root = root();
    // What is built first is what takes longest, and may fail.
    let module = program::build(&root)?;
    if out.exists() {
        ensure!(out.join("app/index.html").exists(), "{} is not a site: name another folder", out.display());
        fs::remove_dir_all(out).with_context(|| format!("{} cannot be replaced", out.display()))?;
    }
    program::write(&module, &out.join("app"))?;
    for (name, text) in PAGES {
        write(&out.join(name), text.as_bytes())?;
    }
    start::write(&root, out)?;
    guide::write(&root.join("docs/src"), &out.join("guide"))?;
    offline::write(out)?;
    report(out)
}

/// The folder of the project.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Writes a file, and the folders that it is in.
fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    fs::write(path, bytes).with_context(|| path.display().to_string())
}

/// All files of a folder, by their paths in it, in order.
fn files(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(&next).with_context(|| next.display().to_string())? {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
            } else {
                found.push(path.strip_prefix(folder)?.to_owned());
            }
        }
    }
    found.sort();
    Ok(found)
}

/// Says what was made, and how large it is.
fn report(out: &Path) -> Result<()> {
    let size = |name: &str| -> Result<(u64, u64)> {
        let bytes = fs::read(out.join(name)).with_context(|| name.to_owned())?;
        let mut packed = GzEncoder::new(Vec::new(), Compression::best());
        packed.write_all(&bytes)?;
        Ok((bytes.len() as u64, packed.finish()?.len() as u64))
    };
    let (whole, packed) = size("app/corpuscle_bg.wasm")?;
    let megabytes = |bytes: u64| bytes as f64 / 1e6;
    println!("program: {:.2} MB, compressed (gzip) {:.2} MB", megabytes(whole), megabytes(packed));
    println!("files: {}", files(out)?.len());
    println!("served by: python3 -m http.server --directory {}", out.display());
    ensure!(packed <= MOST, "the program is larger than {} MB compressed", megabytes(MOST));
    Ok(())
}

//! Files that the window writes: into the folder that the program was started in, where none is ever overwritten; in a browser as downloads.

#[cfg(not(target_arch = "wasm32"))]
#[path = "disk.rs"]
mod store;
#[cfg(target_arch = "wasm32")]
#[path = "download.rs"]
mod store;

use corpuscle::output::OutputError;
use std::io;
use std::path::{Path, PathBuf};

/// A path in a folder where there is no file yet: `gas-maxwell.png`, then `gas-maxwell-2.png`.
pub fn free(folder: &Path, name: &str, ending: &str) -> PathBuf {
    let stem: String = name.chars().map(|c| if c.is_alphanumeric() || "-_".contains(c) { c } else { '-' }).collect();
    let stem = stem.trim_matches('-');
    let numbered = |number: usize| match number {
        1 => folder.join(format!("{stem}.{ending}")),
        _ => folder.join(format!("{stem}-{number}.{ending}")),
    };
    (1..).map(numbered).find(|path| !path.exists()).unwrap_or_else(|| numbered(1))
}

/// Writes a text; returns the path.
pub fn text(folder: &Path, name: &str, ending: &str, text: &str) -> io::Result<PathBuf> {
    let path = free(folder, name, ending);
    store::write(&path, text.as_bytes())?;
    Ok(path)
}

/// Writes a picture as a PNG file; returns the path.
pub fn picture(folder: &Path, name: &str, image: &corpuscle::gpu::Image) -> Result<PathBuf, corpuscle::Error> {
    let path = free(folder, name, "png");
    let png = corpuscle_drawing::png::encode_rgba(image.width, image.height, &image.rgba);
    let written = png.map_err(io::Error::other).and_then(|png| store::write(&path, &png));
    written.map_err(|source| OutputError::Write { path: path.clone(), source })?;
    Ok(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_file_is_overwritten() {
        let folder = tempfile::tempdir().unwrap();
        let first = text(folder.path(), "gas/maxwell", "toml", "a").unwrap();
        let second = text(folder.path(), "gas/maxwell", "toml", "b").unwrap();
        assert!(first.ends_with("gas-maxwell.toml") && second.ends_with("gas-maxwell-2.toml"));
        assert_eq!(std::fs::read_to_string(first).unwrap(), "a");
    }
}

//! The service worker, which keeps the site for use without a network.

use super::files;
use anyhow::{Context, Result};
use sha2::{Digest, Sha256};
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Writes it: it knows all files of the site, and a version that follows from them.
///
/// # Errors
/// Where a file cannot be read or written.
pub fn write(out: &Path) -> Result<()> {
    let (mut hash, mut list) = (Sha256::new(), String::new());
    for file in files(out)? {
        hash.update(fs::read(out.join(&file)).with_context(|| file.display().to_string())?);
        let name = file.to_string_lossy().replace('\\', "/");
        let address = name.strip_suffix("index.html").unwrap_or(&name);
        let _ = writeln!(list, "  {:?},", format!("./{address}"));
    }
    let version: String = hash.finalize().iter().take(8).map(|byte| format!("{byte:02x}")).collect();
    let text = include_str!("../../pages/service.js").replace("{version}", &version).replace("{files}", &list);
    super::write(&out.join("service.js"), text.as_bytes())
}

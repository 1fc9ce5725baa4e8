//! The program of the page: built for WebAssembly, with the JavaScript that calls it.

use anyhow::{Context, Result, ensure};
use std::path::{Path, PathBuf};
use std::process::Command;
use wasm_bindgen_cli_support::Bindgen;

const TARGET: &str = "wasm32-unknown-unknown";
/// Its name in the site.
const NAME: &str = "corpuscle";

/// Builds it; gives the module.
///
/// # Errors
/// Where Cargo fails, as without the target.
pub fn build(root: &Path) -> Result<PathBuf> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let arguments = ["build", "--profile", "web", "--package", "corpuscle-web", "--target", TARGET];
    let status = Command::new(cargo).args(arguments).current_dir(root).status().context("cargo cannot be started")?;
    ensure!(status.success(), "the program was not built; its target is installed by: rustup target add {TARGET}");
    let built = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    Ok(built.join(TARGET).join("web/corpuscle_web.wasm"))
}

/// Writes it with its JavaScript into a folder, and makes it smaller where `wasm-opt` is installed.
///
/// # Errors
/// Where a file cannot be written.
pub fn write(module: &Path, folder: &Path) -> Result<()> {
    let mut bindgen = Bindgen::new();
    bindgen.input_path(module).web(true)?.typescript(false).out_name(NAME);
    bindgen.remove_name_section(true).remove_producers_section(true).generate(folder)?;
    let written = folder.join(format!("{NAME}_bg.wasm"));
    let smaller = folder.join("smaller.wasm");
    let optimised = Command::new("wasm-opt").args(["-O2", "--all-features", "-o"]).args([&smaller, &written]).status();
    match optimised {
        Ok(status) if status.success() => std::fs::rename(smaller, written)?,
        Ok(_) => println!("this wasm-opt cannot read the program: it is a little larger than it might be"),
        Err(_) => println!("wasm-opt is not installed: the program is a little larger than it might be"),
    }
    Ok(())
}

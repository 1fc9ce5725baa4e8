//! Dropped files in a browser: read into memory, here and in the worker.

use super::{Pending, Window};
use crate::dropped;
use corpuscle::terrain::hold_in_memory;
use egui::{Context, DroppedFileHandle};
use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;
use wasm_bindgen_futures::spawn_local;

/// The folder that dropped files have in memory.
const FOLDER: &str = "/dropped";

/// Largest file that is read, bytes: it is in memory twice, as is the terrain in it, and a page has 4 GB.
const MOST: usize = 512 << 20;

impl Window {
    /// Reads the dropped files, and opens the first.
    pub(super) fn take_files(&mut self, context: &Context, files: &[DroppedFileHandle]) {
        self.fault = None;
        let (sender, receiver) = channel();
        let (context, files, holder) = (context.clone(), files.to_vec(), self.physics.holder());
        spawn_local(async move {
            let mut first = None;
            for file in files {
                let path = Path::new(FOLDER).join(file.path());
                match file.bytes_async().await {
                    Ok(bytes) if bytes.len() > MOST => {
                        let _ = sender.send(Err(format!(
                            "{}: a page reads files of at most {} MB; make it smaller (`corpuscle terrain clip`), or open it with the \
                             program (`corpuscle view`)",
                            file.path().display(),
                            MOST >> 20
                        )));
                    }
                    Ok(bytes) => {
                        holder.hold(path.clone(), &bytes);
                        hold_in_memory(path.clone(), &bytes);
                        first.get_or_insert((path, bytes));
                    }
                    Err(error) => {
                        let _ = sender.send(Err(format!("{}: {error}", file.path().display())));
                    }
                }
            }
            if let Some((path, bytes)) = first {
                // The receiver is gone when another file was dropped since.
                let _ = sender.send(open(path, bytes));
            }
            context.request_repaint();
        });
        self.pending = Some(Pending::Dropped(receiver));
    }
}

fn open(path: PathBuf, bytes: Vec<u8>) -> Result<crate::Start, String> {
    let is_scene = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"));
    if !is_scene {
        return dropped::open(&path);
    }
    let text = String::from_utf8(bytes).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(dropped::scene(&path, text))
}

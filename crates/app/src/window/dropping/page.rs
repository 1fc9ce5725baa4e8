//! Dropped files in a browser: read into memory, here and in the worker.

use super::{Pending, Window};
use crate::physics::FileHolder;
use crate::{Source, Start};
use corpuscle::terrain::hold_in_memory;
use egui::{Context, DroppedFile, DroppedFileHandle, Ui};
use send_wrapper::SendWrapper;
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::pin::Pin;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::mpsc::channel;
use wasm_bindgen::prelude::*;
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::HtmlInputElement;
use web_sys::js_sys::Uint8Array;

/// The folder that dropped files have in memory: each drop has one of its own in it.
const FOLDER: &str = "/dropped";

/// Largest file that is read, bytes: it is in memory twice, as is the terrain in it, and a page has 4 GB.
const MOST: usize = 512 << 20;

/// Files that the user chose by the button, for a device that drops none.
#[derive(Default)]
pub(in crate::window) struct ChosenFiles {
    files: Rc<RefCell<Vec<DroppedFileHandle>>>,
    /// Drops and choices so far.
    drops: usize,
}

impl ChosenFiles {
    /// Those chosen since the last call.
    pub fn take(&self) -> Vec<DroppedFileHandle> {
        self.files.take()
    }

    /// Has the browser ask for files.
    fn ask(&self, context: &Context) -> Result<(), JsValue> {
        let document = web_sys::window().and_then(|window| window.document()).ok_or("there is no page")?;
        let input: HtmlInputElement = document.create_element("input")?.dyn_into()?;
        input.set_type("file");
        input.set_multiple(true);
        let (files, context, chooser) = (self.files.clone(), context.clone(), input.clone());
        let chosen = Closure::once_into_js(move || {
            let list = chooser.files();
            let list = list.iter().flat_map(|list| (0..list.length()).filter_map(|number| list.get(number)));
            files.borrow_mut().extend(list.map(|file| Arc::new(ChosenFile::from(file)) as DroppedFileHandle));
            context.request_repaint();
        });
        input.set_onchange(Some(chosen.unchecked_ref()));
        input.click();
        Ok(())
    }
}

/// A file that was chosen.
#[derive(Debug)]
struct ChosenFile {
    file: SendWrapper<web_sys::File>,
    path: PathBuf,
}

impl From<web_sys::File> for ChosenFile {
    fn from(file: web_sys::File) -> Self {
        Self { path: file.name().into(), file: SendWrapper::new(file) }
    }
}

impl DroppedFile for ChosenFile {
    fn path(&self) -> &Path {
        &self.path
    }

    fn bytes_async(&self) -> Pin<Box<dyn Future<Output = Result<Vec<u8>, String>> + '_>> {
        Box::pin(async {
            let buffer = JsFuture::from(self.file.array_buffer()).await;
            buffer.map(|buffer| Uint8Array::new(&buffer).to_vec()).map_err(|error| format!("{error:?}"))
        })
    }

    fn web_file(&self) -> Option<&web_sys::File> {
        Some(&self.file)
    }
}

impl Window {
    /// A button that has the browser ask for files, as a phone has nothing to drop them from.
    pub(in crate::window) fn open_button(&mut self, ui: &mut Ui) {
        let hint = "Terrain (a GeoTIFF or an ESRI ASCII grid), or a scene with its files";
        if ui.button("Open files").on_hover_text(hint).clicked()
            && let Err(error) = self.chosen.ask(ui.ctx())
        {
            self.fault = Some(format!("the browser asks for no files: {error:?}"));
        }
    }

    /// What is said while a file hovers over the window.
    pub(super) const DROP_HINT: &str = "Drop terrain to flood it: a GeoTIFF or an ESRI ASCII grid.\nA scene file is opened; drop the files that it names with it.";

    /// Reads the dropped files, and opens the scene among them, or else the first.
    pub(super) fn take_files(&mut self, context: &Context, files: &[DroppedFileHandle]) {
        self.fault = None;
        self.chosen.drops += 1;
        let folder = Path::new(FOLDER).join(self.chosen.drops.to_string());
        let (sender, receiver) = channel();
        let (context, files, holder) = (context.clone(), files.to_vec(), self.physics.holder());
        spawn_local(async move {
            match read(&files, &folder, &holder).await {
                Ok(Dropped::Terrain(path)) => holder.flood(path, sender),
                // The receiver is gone when another file was dropped since.
                Ok(Dropped::Scene(source)) => drop(sender.send(Ok(Start::Scene(source)))),
                Err(error) => drop(sender.send(Err(error))),
            }
            context.request_repaint();
        });
        self.pending = Some(Pending::Dropped(receiver));
    }

    /// Frees the files of drops whose scene is not open any more.
    pub(in crate::window) fn free_dropped(&self, open: &Source) {
        self.physics.holder().keep(&open.folder);
    }
}

/// What dropped files open.
enum Dropped {
    Scene(Source),
    /// Terrain to be flooded, by its path in memory.
    Terrain(PathBuf),
}

/// Reads dropped files into a folder in memory; gives what they open.
async fn read(files: &[DroppedFileHandle], folder: &Path, holder: &FileHolder) -> Result<Dropped, String> {
    let is_scene = |file: &&DroppedFileHandle| has_ending(file.path(), &["toml"]);
    let main = files.iter().find(is_scene).or(files.first()).ok_or("nothing was dropped")?;
    let mut text = None;
    for file in files {
        check(file)?;
        let bytes = file.bytes_async().await.map_err(|error| format!("{}: {error}", file.path().display()))?;
        let path = folder.join(file.path());
        holder.hold(path.clone(), &bytes);
        hold_in_memory(path, &bytes);
        if std::ptr::eq(file, main) && is_scene(&file) {
            text = Some(String::from_utf8(bytes).map_err(|error| format!("{}: {error}", file.path().display()))?);
        }
    }
    let Some(text) = text else { return Ok(Dropped::Terrain(folder.join(main.path()))) };
    let name = main.path().file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok(Dropped::Scene(Source { name, text, folder: folder.to_owned(), changes: Vec::new() }))
}

/// Refuses what a page does not read, before it is read.
fn check(file: &DroppedFileHandle) -> Result<(), String> {
    let name = file.path().display();
    if file.web_file().is_some_and(|file| file.size() > MOST as f64) {
        return Err(format!(
            "{name}: a page reads files of at most {} MB; make it smaller (`corpuscle terrain clip`), or open it with the program \
             (`corpuscle view`)",
            MOST >> 20
        ));
    }
    Ok(())
}

fn has_ending(path: &Path, endings: &[&str]) -> bool {
    path.extension().is_some_and(|ending| endings.iter().any(|one| ending.eq_ignore_ascii_case(one)))
}

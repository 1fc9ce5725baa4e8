//! The thread itself.

use super::{Counter, Finish, Print, Sitting, SlowDevice};
use crate::files;
use crate::physics::Wake;
use crate::sight::moment;
use corpuscle::Error;
use corpuscle::gpu::Image;
use corpuscle::pictures::{PictureSettings, Pictures, Shown};
use corpuscle_render::RenderError;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::PoisonError;
use std::sync::mpsc::Sender;

/// Size of a still, pixels.
const STILL_SIZE: [u32; 2] = [1920, 1080];
const FAULT: &str = "a fault in the program stopped the picture";

/// Draws what is asked for until the counter is closed.
pub(super) fn run(counter: &Counter, tell: &Sender<Print>, wake: &Wake, device: &SlowDevice) {
    let mut thread = Thread { device, scene: None };
    while let Some(wish) = next(counter) {
        // Nobody listens where the window is closing.
        let _ = tell.send(thread.print(wish));
        wake();
    }
}

/// What is drawn next.
enum Wish {
    Still(Sitting, PathBuf, String),
    Rest(u64, Sitting, Finish),
}

/// Waits for the next wish; none where the counter is closed. Who asked for a still waits for it: it comes first.
fn next(counter: &Counter) -> Option<Wish> {
    let mut tray = counter.tray();
    loop {
        if let Some((sitting, folder, name)) = tray.stills.pop_front() {
            return Some(Wish::Still(sitting, folder, name));
        }
        if tray.closed {
            return None;
        }
        if let Some((number, sitting, finish)) = tray.rest.take() {
            return Some(Wish::Rest(number, sitting, finish));
        }
        tray = counter.bell.wait(tray).unwrap_or_else(PoisonError::into_inner);
    }
}

struct Thread<'a> {
    device: &'a SlowDevice,
    /// The scene that was drawn last, by its number, and what draws it.
    scene: Option<(u64, Pictures)>,
}

impl Thread<'_> {
    fn print(&mut self, wish: Wish) -> Print {
        match wish {
            Wish::Still(sitting, folder, name) => {
                Print::Still(self.guarded(|thread| thread.still(&sitting, &folder, &name)))
            }
            Wish::Rest(number, sitting, finish) => {
                Print::Rest(number, self.guarded(|thread| thread.rest(&sitting, &finish)))
            }
        }
    }

    /// A fault of the program must not take the window's pictures with it.
    fn guarded<T>(&mut self, draw: impl FnOnce(&mut Self) -> Result<T, Error>) -> Result<T, String> {
        match catch_unwind(AssertUnwindSafe(|| draw(self))) {
            Ok(done) => done.map_err(|error| error.to_string()),
            Err(_) => {
                self.scene = None;
                Err(FAULT.into())
            }
        }
    }

    fn still(&mut self, sitting: &Sitting, folder: &Path, name: &str) -> Result<PathBuf, Error> {
        let pictures = self.pictures(sitting, STILL_SIZE, 2)?;
        let image = sitting.sight.still(pictures, &moment(&sitting.snapshot))?;
        files::picture(folder, name, &image)
    }

    fn rest(&mut self, sitting: &Sitting, finish: &Finish) -> Result<Box<(Shown, Image)>, Error> {
        let pictures = self.pictures(sitting, finish.size, finish.samples)?;
        sitting.sight.lift(pictures);
        let shown = pictures.show(&moment(&sitting.snapshot), &sitting.sight.hand, finish.look, finish.paper)?;
        Ok(Box::new((shown, pictures.read()?)))
    }

    /// What draws a scene, in this size.
    fn pictures(&mut self, sitting: &Sitting, size: [u32; 2], samples: u32) -> Result<&mut Pictures, Error> {
        let number = sitting.snapshot.number;
        if self.scene.as_ref().is_none_or(|(open, _)| *open != number) {
            // The memory of the last one is free before the next takes its own.
            self.scene = None;
            let gpu = self.device.gpu().map_err(RenderError::from)?;
            let settings = PictureSettings { size, samples, ..PictureSettings::default() };
            self.scene = Some((number, Pictures::open_scenery(&gpu, &sitting.scenery, settings)?));
        }
        let (_, pictures) = self.scene.as_mut().expect("it was opened above");
        pictures.resize(size, samples)?;
        Ok(pictures)
    }
}

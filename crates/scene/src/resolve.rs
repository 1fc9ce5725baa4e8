//! Defaults and paths that depend on the rest of the scene.

use crate::Scene;
use std::path::Path;

impl Scene {
    /// Fills in what was left out and depends on nothing but the scene.
    pub fn resolve_defaults(&mut self) {
        let gauge_period = self.run.gauge_period_s();
        self.run.frame_every_s = Some(self.run.frame_period_s());
        self.run.gauge_every_s = Some(gauge_period);
        self.model.resolve_defaults(&self.run);
    }

    /// Makes every path absolute; relative ones are taken from `folder`, the folder of the scene's file.
    pub fn resolve_paths(&mut self, folder: &Path) {
        // The folder of `scene.toml` alone is empty, which `absolute` refuses.
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        // Where the current folder is gone the path stays relative, and opening the file says so.
        let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
        for path in self.model.paths() {
            *path = folder.join(&*path);
        }
    }
}

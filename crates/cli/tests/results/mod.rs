//! What a run has written, to compare two runs.

use std::fs;
use std::path::Path;

/// All files of a run that do not depend on the clock on the wall, by name.
pub fn results(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for sub in ["", "frames", "maps", "charts"] {
        let entries = fs::read_dir(folder.join(sub));
        for entry in entries.into_iter().flatten() {
            let path = entry.unwrap().path();
            let name = path.strip_prefix(folder).unwrap().display().to_string();
            if path.is_file() && !["summary.json", "report.html", "log.txt"].contains(&name.as_str()) {
                found.push((name, fs::read(path).unwrap()));
            }
        }
    }
    found.sort();
    found
}

/// Whether a run has written what another has.
#[allow(dead_code, reason = "not every test uses it")]
pub fn compare(found: &[(String, Vec<u8>)], expected: &[(String, Vec<u8>)], when: &str) {
    let names = |files: &[(String, Vec<u8>)]| files.iter().map(|file| file.0.clone()).collect::<Vec<_>>();
    assert_eq!(names(found), names(expected), "{when}");
    for (found, expected) in found.iter().zip(expected) {
        assert!(found == expected, "{when}: {} differs", found.0);
    }
}

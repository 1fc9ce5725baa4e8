//! Running the binary in a folder of its own.
#![allow(dead_code, reason = "not every test uses all of it")]

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A small lake over a bump: runs in a blink.
#[allow(dead_code, reason = "not every test uses it")]
pub const LAKE: &str = "[run]
until_s = 2.0
frame_every_s = 1.0
[terrain.bump]
extent = { length_m = 20.0, width_m = 20.0, cell_m = 1.0 }
height_m = 1.0
width_m = 5.0
[flood]
spacing_m = 2.0
spacing_depth_m = 2.0
water = [{ level_m = 2.0 }]
gauge = [{ name = \"P1\", at = [3.0, 3.0] }]
[flood.edges]
west = \"wall\"
east = \"wall\"
south = \"wall\"
north = \"wall\"
";

/// Balls in a box, one of them heavy and followed: runs in a blink.
#[allow(dead_code, reason = "not every test uses it")]
pub const BALLS: &str = "[run]
until_s = 2.0
frame_every_s = 1.0
[gas]
size = [60.0, 40.0]
follow = 0
[[gas.ball]]
name = \"heavy\"
position = [30.0, 20.0]
radius = 4.0
mass = 50.0
[[gas.species]]
name = \"light\"
count = 100
radius = 1.0
mass = 1.0
temperature = 100.0
";

/// Humid air before a cold pane, small enough to be opened at once.
#[allow(dead_code, reason = "not every test uses it")]
pub const DEW: &str = "run = { until_s = 0.6, frame_every_s = 0.1, gauge_every_s = 0.01, checkpoint_every_wall_s = 0.005 }
[dew]
size_m = [0.04, 0.03, 0.03]
spacing_m = 0.005
air = { temperature_c = 25.0, relative_humidity = 0.9 }
drops = { sites_per_m2 = 1e4, smallest_radius_m = 1e-4 }
solid = [{ name = \"pane\", shape = { box = { size_m = [0.005, 0.03, 0.03] } }, position_m = [0.0025, 0.015, 0.015], temperature_c = 5.0, held = true }]
";

/// An ESRI ASCII grid with a valley down its middle.
pub const SMALL_TERRAIN: &str = "ncols 5\nnrows 4\nxllcorner 0\nyllcorner 0\ncellsize 10\n\
    9 5 1 5 9\n9 5 2 5 9\n9 5 3 5 9\n9 5 4 5 9\n";

/// A folder of its own for one test.
pub struct Place(tempfile::TempDir);

impl Place {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// The binary with these arguments, in this folder, without what the surroundings may set.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_corpuscle"));
        command.args(arguments).current_dir(self.0.path()).env_remove("CORPUSCLE_DATA");
        command
    }

    pub fn run(&self, arguments: &[&str]) -> Ended {
        Ended::of(self.command(arguments).output().unwrap())
    }
}

/// What came of a command.
pub struct Ended {
    pub status: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Ended {
    pub fn of(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Self { status: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
    }

    pub fn expect_status(self, status: i32) -> Self {
        assert_eq!(self.status, Some(status), "stdout: {}\nstderr: {}", self.stdout, self.stderr);
        assert!(!self.stderr.contains("panicked"), "{}", self.stderr);
        self
    }

    pub fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("{error}: {}", self.stdout))
    }
}

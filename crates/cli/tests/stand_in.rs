//! Pictures of the scenes whose terrain is fetched, on ground made up in its place: what the gallery shows of them.
//!
//! `cargo test --release -p corpuscle-cli --test stand_in -- --ignored` writes them into `target/stand-in`.

// Of the stand-in, which the tests of fetching use in full, only a part is wanted here.
#[allow(dead_code)]
#[path = "../../fetch/tests/common/mod.rs"]
mod bucket;

use bucket::{Bucket, tile_of};
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Metres in a degree of latitude.
const DEGREE_M: f64 = 111_200.0;

/// A number between -1 and 1 for a point of a square grid, the same each time.
fn scattered(column: i64, row: i64) -> f64 {
    let mut bits =
        (column as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ (row as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F);
    bits = (bits ^ (bits >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    bits = (bits ^ (bits >> 32)).wrapping_mul(0x94D0_49BB_1331_11EB);
    (bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// Smooth hills between -1 and 1, a unit wide.
fn hills(x: f64, y: f64) -> f64 {
    let ([column, row], smooth) = ([x.floor(), y.floor()], |t: f64| t * t * t * (t * (6.0 * t - 15.0) + 10.0));
    let (u, v) = (smooth(x - column), smooth(y - row));
    let at = |right: i64, up: i64| scattered(column as i64 + right, row as i64 + up);
    (1.0 - v) * ((1.0 - u) * at(0, 0) + u * at(1, 0)) + v * ((1.0 - u) * at(0, 1) + u * at(1, 1))
}

/// Hills on hills, each kind half as wide as the one before and `roughness` times as high.
fn landscape(x: f64, y: f64, kinds: i32, roughness: f64, hill: impl Fn(f64, f64) -> f64) -> f64 {
    (0..kinds)
        .map(|kind| roughness.powi(kind) * hill(x * 2_f64.powi(kind), (y + f64::from(kind)) * 2_f64.powi(kind)))
        .sum()
}

/// A river of the plains: its channel winds between banks, past terraces and hollows, below low hills.
fn plain(longitude: f64, latitude: f64) -> f64 {
    let (east, north) = ((longitude + 91.54) * 83_100.0, (latitude - 41.659) * DEGREE_M);
    if east.abs() > 2600.0 || north.abs() > 3300.0 {
        return 205.0;
    }
    let winding = 110.0 * (TAU * north / 2100.0).sin() + 420.0 * (1.0 - (TAU * north / 6400.0).cos());
    let aside = (east - winding).abs();
    let channel = 4.5 * (-(aside / 75.0).powi(4)).exp();
    let hills_of_the_plain = 16.0 * (1.0 + landscape(east / 900.0, north / 900.0, 4, 0.42, hills));
    let hollows = 1.2 * landscape(east / 170.0, north / 170.0, 2, 0.5, hills);
    let away = 1.0 - (-(aside / 600.0).powi(2)).exp();
    200.0 - channel + hollows * (1.0 - (-(aside / 150.0).powi(2)).exp()) + away * hills_of_the_plain
}

/// The head of a valley in the mountains: a stream's bed that winds down to the north-east between ridges with gullies.
fn mountains(longitude: f64, latitude: f64) -> f64 {
    let (east, north) = ((longitude - 104.867) * 98_500.0, (latitude - 27.7067) * DEGREE_M);
    if east.abs() > 2500.0 || north.abs() > 2800.0 {
        return 1900.0;
    }
    let [down, across] = [0.83 * east + 0.56 * north, 0.83 * north - 0.56 * east];
    let winding = 55.0 * (down / 150.0).sin() + 25.0 * (down / 61.0).sin();
    let aside = (across - winding).abs();
    let ridge = |x: f64, y: f64| 1.0 - 2.0 * hills(x, y).abs();
    let ridges = 130.0 * (1.0 + landscape(across / 800.0, down / 800.0, 6, 0.5, ridge));
    let height = 1.0 - (-(aside / 420.0).powf(1.5)).exp();
    1800.0 - 0.14 * down + 0.4 * ((900.0 + aside * aside).sqrt() - 30.0).min(150.0) + height * ridges
}

/// Runs a scene on a tile of `ground` and draws it at a time.
fn picture(name: &str, corner: [i32; 2], ground: fn(f64, f64) -> f64, view: &[&str]) {
    let bucket = Bucket::empty();
    bucket.put_tiles([(corner, tile_of(corner[0], corner[1], 3600, ground))]);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("../stand-in").join(name.replace('/', "-"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(folder.parent().unwrap()).unwrap();
    let run = folder.to_string_lossy().into_owned();
    for arguments in [&["run", name, "-o", &run][..], &[&["render", &run][..], view].concat()] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_corpuscle"));
        command.env("CORPUSCLE_GLO30", &bucket.base).env("CORPUSCLE_CACHE", bucket.cache.path());
        assert!(command.args(arguments).status().unwrap().success());
    }
}

#[test]
#[ignore = "minutes: it runs the scene and draws it"]
fn the_river_of_the_plains() {
    let view = ["--at", "120", "--from", "170,32", "--look", "-91.54,41.659", "--zoom", "2.4"];
    picture("flood/iowa-river", [41, -92], plain, &view);
}

#[test]
#[ignore = "minutes: it runs the scene and draws it"]
fn the_head_of_the_valley() {
    let view = ["--at", "60", "--from", "75,32", "--look", "104.8695,27.7082", "--zoom", "6"];
    picture("flood/chishui", [27, 104], mountains, &view);
}

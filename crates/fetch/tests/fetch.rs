//! Fetching from a stand-in for the public bucket.

mod common;

use common::{Bucket, COLUMNS, Fault, ROWS, ground, name, tile_of};
use corpuscle_fetch::{ATTRIBUTION, FetchError, FetchObserver, Fetched, Progress, Source, fetch};
use corpuscle_terrain::MapBox;
use proptest::prelude::*;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// A box of 7 x 37 cells or so inside the tile N85 E006.
const SMALL: [f64; 4] = [6.40, 85.500, 6.42, 85.510];

fn get(source: &Source, sides: [f64; 4]) -> Result<Fetched, FetchError> {
    fetch(source, &MapBox::new(sides).unwrap(), &FetchObserver::none())
}

/// Every cell has the height of the ground at its centre, and the box is covered.
fn assert_ground(fetched: &Fetched, sides: [f64; 4]) {
    let raster = &fetched.raster;
    for row in 0..raster.rows {
        for column in 0..raster.columns {
            let [longitude, latitude] = raster.georeference.centre(column, row);
            let (height, expected) = (raster.values[row * raster.columns + column], ground(longitude, latitude));
            assert!((height - expected).abs() < 1e-3, "{column} {row}: {height}, not {expected}");
        }
    }
    let outline = raster.outline();
    let (dx, dy) = (1.0 / COLUMNS as f64, 1.0 / ROWS as f64);
    for (side, box_side, cell) in [
        (outline.west, sides[0], dx),
        (outline.east, sides[2], -dx),
        (outline.south, sides[1], dy),
        (outline.north, sides[3], -dy),
    ] {
        let beyond = (box_side - side) / cell;
        assert!((-1e-3..1.0).contains(&beyond), "{outline:?} round {sides:?}: {beyond}");
    }
}

#[test]
fn only_what_is_needed_comes_and_only_once() {
    let bucket = Bucket::with(&[[85, 6]]);
    let fetched = get(&bucket.source(), SMALL).unwrap();
    assert_ground(&fetched, SMALL);
    let whole = bucket.file(&format!("{0}/{0}.tif", name(85, 6))).len() as u64;
    assert!(fetched.bytes < whole / 2, "{} of {whole} bytes came", fetched.bytes);
    assert_eq!((fetched.tiles, fetched.sea.len(), fetched.renewed), (vec![name(85, 6)], 0, 0));
    assert_eq!(fetched.raster.warnings, [ATTRIBUTION]);
    assert_eq!(fetched.raster.georeference.system.as_ref().unwrap().name, "EPSG:4326");
    assert!(!bucket.requests().is_empty());
    let again = get(&bucket.source(), SMALL).unwrap();
    assert_eq!((again.bytes, bucket.requests()), (0, Vec::new()));
    assert_eq!(again.raster.values, fetched.raster.values);
}

#[test]
fn a_box_across_four_tiles_is_seamless() {
    let bucket = Bucket::with(&[[85, 6], [85, 7], [86, 6], [86, 7]]);
    let sides = [6.95, 85.99, 7.05, 86.01];
    let fetched = get(&bucket.source(), sides).unwrap();
    assert_ground(&fetched, sides);
    assert_eq!(fetched.tiles.len(), 4);
    // On to the last half second that belongs to the tile in the south.
    let sides = [6.5, 86.0, 6.6, 86.01];
    let fetched = get(&bucket.source(), sides).unwrap();
    assert_ground(&fetched, sides);
    assert_eq!(fetched.tiles, [name(86, 6), name(85, 6)]);
}

#[test]
fn tiles_with_cells_of_different_width_join_without_a_seam() {
    let bucket = Bucket::empty();
    let (wide, narrow) = (tile_of(85, 6, COLUMNS, ground), tile_of(84, 6, 2 * COLUMNS, ground));
    bucket.put_tiles([([85, 6], wide), ([84, 6], narrow)]);
    let raster = get(&bucket.source(), [6.3, 84.99, 6.5, 85.01]).unwrap().raster;
    assert!((raster.georeference.cell[0] * 720.0 - 1.0).abs() < 1e-9, "{:?}", raster.georeference.cell);
    for row in 0..raster.rows {
        // Between the centres of wide cells linear interpolation is off by less than 2 cm on this ground.
        let near = if raster.georeference.centre(0, row)[1] > 85.0001 { 0.02 } else { 1e-3 };
        for column in 0..raster.columns {
            let [longitude, latitude] = raster.georeference.centre(column, row);
            let error = raster.values[row * raster.columns + column] - ground(longitude, latitude);
            assert!(error.abs() < near, "{column} {row}: {error}");
        }
    }
}

#[test]
fn progress_is_shown() {
    let bucket = Bucket::with(&[[85, 6], [86, 6]]);
    let shown: Arc<Mutex<Vec<Progress>>> = Arc::default();
    let seen = shown.clone();
    let observer =
        FetchObserver { show: Arc::new(move |progress| seen.lock().unwrap().push(progress)), ..FetchObserver::none() };
    let part = MapBox::new([6.4, 85.99, 6.42, 86.01]).unwrap();
    let fetched = fetch(&bucket.source(), &part, &observer).unwrap();
    let shown = shown.lock().unwrap();
    assert!(shown.len() >= 4 && shown.windows(2).all(|two| two[0].bytes <= two[1].bytes), "{shown:?}");
    assert_eq!(*shown.last().unwrap(), Progress { tiles: 2, of_tiles: 2, bytes: fetched.bytes });
}

#[test]
fn passing_faults_are_overcome() {
    for fault in [Fault::Cut, Fault::Short, Fault::OtherRange, Fault::Status(503), Fault::Status(429), Fault::Silent] {
        let bucket = Bucket::with(&[[85, 6]]);
        bucket.fail(fault, 2);
        let fetched = get(&bucket.hasty(), SMALL).unwrap_or_else(|error| panic!("{fault:?}: {error}"));
        assert_ground(&fetched, SMALL);
    }
}

#[test]
fn lasting_faults_are_told() {
    let told = [
        (Fault::Cut, "ended early"),
        (Fault::Short, "instead of"),
        (Fault::OtherRange, "requested bytes"),
        (Fault::Status(503), "503"),
        (Fault::Silent, "too slow"),
        (Fault::Trickle, "imeout"),
    ];
    for (fault, words) in told {
        let bucket = Bucket::with(&[[85, 6]]);
        bucket.fail(fault, usize::MAX);
        let start = Instant::now();
        let error = get(&Source { attempts: 2, ..bucket.hasty() }, SMALL).unwrap_err();
        let text = error.to_string();
        assert!(matches!(error, FetchError::Network { attempts: 2, .. }), "{fault:?}: {text}");
        assert!(text.contains(words) && text.contains(&bucket.base) && text.contains("try again"), "{fault:?}: {text}");
        assert!(!error.is_refusal() && start.elapsed() < Duration::from_secs(15), "{fault:?}");
        assert_eq!(bucket.requests().len(), 2);
        // With the network sound again it goes on.
        bucket.fail(fault, 0);
        assert_ground(&get(&bucket.source(), SMALL).unwrap(), SMALL);
    }
}

#[test]
fn a_refusal_is_not_repeated() {
    let bucket = Bucket::with(&[[85, 6]]);
    bucket.fail(Fault::Status(401), usize::MAX);
    let text = get(&bucket.source(), SMALL).unwrap_err().to_string();
    assert!(text.contains("401") && text.contains("CORPUSCLE_GLO30"), "{text}");
    assert_eq!(bucket.requests().len(), 1);
}

#[test]
fn nobody_at_the_address_is_told() {
    let source = Source { attempts: 2, ..Bucket::empty().source() };
    let source = Source { base: "http://127.0.0.1:9".into(), pause: Duration::ZERO, ..source };
    let text = get(&source, SMALL).unwrap_err().to_string();
    assert!(text.contains("2 attempts") && text.contains("check the network"), "{text}");
    let source = Source { base: "not an address".into(), ..source };
    assert!(get(&source, SMALL).unwrap_err().to_string().contains("no web address"));
}

#[test]
fn a_server_without_ranges_gives_the_whole_file() {
    let bucket = Bucket::with(&[[85, 6]]);
    bucket.fail(Fault::NoRanges, usize::MAX);
    let fetched = get(&bucket.source(), SMALL).unwrap();
    assert_ground(&fetched, SMALL);
    let whole = bucket.file(&format!("{0}/{0}.tif", name(85, 6))).len() as u64;
    assert_eq!((fetched.bytes, bucket.requests().len()), (whole, 1));
}

#[test]
fn a_tile_that_the_list_does_not_name_is_sea() {
    let bucket = Bucket::with(&[[85, 6]]);
    let sides = [6.95, 85.5, 7.05, 85.51];
    let fetched = get(&bucket.source(), sides).unwrap();
    assert_eq!((&fetched.tiles, &fetched.sea), (&vec![name(85, 6)], &vec![name(85, 7)]));
    let raster = &fetched.raster;
    for column in 0..raster.columns {
        let [longitude, latitude] = raster.georeference.centre(column, 3);
        let expected = if longitude < 6.999 { ground(longitude, latitude) } else { 0.0 };
        assert!((raster.values[3 * raster.columns + column] - expected).abs() < 1e-3, "{column}");
    }
    assert!(raster.warnings[0].contains(&name(85, 7)) && raster.warnings[0].contains("sea"), "{:?}", raster.warnings);
    bucket.requests();
    assert_eq!(get(&bucket.source(), sides).unwrap().sea, [name(85, 7)]);
    assert_eq!(bucket.requests(), Vec::<String>::new());
}

#[test]
fn nothing_but_sea_is_refused() {
    let bucket = Bucket::with(&[[85, 6]]);
    let error = get(&bucket.source(), [20.1, 85.5, 20.2, 85.6]).unwrap_err();
    assert!(error.is_refusal() && error.to_string().contains(&name(85, 20)), "{error}");
}

#[test]
fn a_wrong_address_is_told_from_a_missing_tile() {
    let empty = Bucket::empty();
    let error = get(&empty.source(), SMALL).unwrap_err();
    assert!(matches!(error, FetchError::WrongBase { .. }) && error.is_refusal(), "{error}");
    assert!(error.to_string().contains(&empty.base), "{error}");
    let incomplete = Bucket::with(&[]);
    incomplete.put("tileList.txt", name(85, 6).into_bytes(), "");
    let error = get(&incomplete.source(), SMALL).unwrap_err();
    assert!(matches!(error, FetchError::Incomplete { .. }), "{error}");
}

#[test]
fn what_is_no_tile_is_told_and_not_kept() {
    let bucket = Bucket::with(&[[85, 6], [85, 7]]);
    bucket.fail(Fault::Page, usize::MAX);
    let text = get(&bucket.source(), SMALL).unwrap_err().to_string();
    assert!(text.contains("begins with \"<!DOCTYPE html>"), "{text}");
    bucket.fail(Fault::Page, 0);
    assert_ground(&get(&bucket.source(), SMALL).unwrap(), SMALL);
    // Another tile under this one's name.
    let other = bucket.file(&format!("{0}/{0}.tif", name(85, 6)));
    bucket.put(&format!("{0}/{0}.tif", name(85, 7)), other.clone(), "1");
    let text = get(&bucket.source(), [7.4, 85.5, 7.42, 85.51]).unwrap_err().to_string();
    assert!(text.contains("its corner is at 5.99"), "{text}");
    // A file that ends too early.
    bucket.put(&format!("{0}/{0}.tif", name(86, 7)), other[..2000].to_vec(), "1");
    let error = get(&bucket.source(), [7.4, 86.5, 7.42, 86.51]).unwrap_err();
    assert!(matches!(error, FetchError::NoTile { .. }), "{error}");
}

/// The files in the cache.
fn cached(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { cached(&path) } else { vec![path] }).collect()
}

#[test]
fn damaged_files_of_the_cache_are_fetched_anew() {
    let bucket = Bucket::with(&[[85, 6]]);
    let sound = get(&bucket.source(), SMALL).unwrap();
    let files = cached(bucket.cache.path());
    let mut renewed = 0;
    for file in files {
        let mut bytes = fs::read(&file).unwrap();
        let middle = bytes.len() / 2;
        bytes[middle] ^= 0x40;
        fs::write(&file, bytes).unwrap();
        let again = get(&bucket.source(), SMALL).unwrap();
        assert!(again.raster.values == sound.raster.values, "{}", file.display());
        // Some came along with others and are not read for this box.
        if again.renewed > 0 {
            assert!(again.bytes > 0 && again.raster.warnings[0].contains("damaged"), "{:?}", again.raster.warnings);
        }
        renewed += again.renewed;
        assert_eq!(get(&bucket.source(), SMALL).unwrap().bytes, 0);
        // One that is cut off.
        let length = fs::metadata(&file).unwrap().len();
        fs::File::options().write(true).open(&file).unwrap().set_len(length / 2).unwrap();
        assert!(get(&bucket.source(), SMALL).unwrap().raster.values == sound.raster.values);
    }
    assert!(renewed >= 3, "what is known of the file, its header and its blocks: {renewed}");
}

#[test]
fn a_file_that_changed_on_the_server_is_read_anew() {
    let bucket = Bucket::with(&[[85, 6]]);
    get(&bucket.source(), SMALL).unwrap();
    let path = format!("{0}/{0}.tif", name(85, 6));
    bucket.put(&path, bucket.file(&path), "2");
    bucket.requests();
    // Another part of the tile, for which the server is asked.
    let sides = [6.9, 85.05, 6.92, 85.06];
    assert_ground(&get(&bucket.source(), sides).unwrap(), sides);
    assert_ground(&get(&bucket.source(), SMALL).unwrap(), SMALL);
}

#[test]
fn what_was_stopped_goes_on_from_the_cache() {
    let bucket = Bucket::with(&[[85, 6], [86, 6]]);
    let part = MapBox::new([6.4, 85.99, 6.42, 86.01]).unwrap();
    let stop = Arc::new(AtomicBool::new(false));
    let (flag, came) = (stop.clone(), Arc::new(AtomicU64::new(0)));
    let bytes = came.clone();
    let show = move |progress: Progress| {
        bytes.store(progress.bytes, Ordering::Relaxed);
        flag.store(true, Ordering::Relaxed);
    };
    let error = fetch(&bucket.source(), &part, &FetchObserver { stop, show: Arc::new(show) }).unwrap_err();
    assert!(error == FetchError::Stopped && !error.is_refusal(), "{error}");
    assert!(
        cached(bucket.cache.path()).iter().all(|path| !path.file_name().unwrap().to_string_lossy().contains("tmp"))
    );
    let rest = fetch(&bucket.source(), &part, &FetchObserver::none()).unwrap();
    let all = Bucket::with(&[[85, 6], [86, 6]]);
    let at_once = fetch(&all.source(), &part, &FetchObserver::none()).unwrap();
    assert_eq!(rest.bytes + came.load(Ordering::Relaxed), at_once.bytes);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Whatever the server has under the name of a tile: heights or an error, no panic.
    #[test]
    fn any_file_is_heights_or_an_error(
        changes in prop::collection::vec((4usize..3000, any::<u8>()), 1..20), cut in 0.0..2.0f64
    ) {
        let bucket = Bucket::with(&[[85, 6]]);
        let path = format!("{0}/{0}.tif", name(85, 6));
        let mut bytes = bucket.file(&path);
        for (at, byte) in changes {
            bytes[at] = byte;
        }
        bytes.truncate((cut * bytes.len() as f64) as usize + 10);
        bucket.put(&path, bytes, "1");
        if let Err(error) = get(&bucket.source(), SMALL) {
            let text = error.to_string();
            prop_assert!(text.contains(&bucket.base) && !text.contains('\n'), "{}", text);
        }
    }
}

#[test]
fn a_cache_that_cannot_be_written_is_told() {
    let bucket = Bucket::with(&[[85, 6]]);
    let file = bucket.cache.path().join("file");
    fs::write(&file, "").unwrap();
    let text = get(&Source { cache: file, ..bucket.source() }, SMALL).unwrap_err().to_string();
    assert!(text.contains("cannot be written") && text.contains("CORPUSCLE_CACHE"), "{text}");
}

#[test]
fn boxes_that_cannot_be_are_refused_without_a_request() {
    let bucket = Bucket::with(&[[85, 6]]);
    for sides in [[512_300.0, 204_100.0, 512_400.0, 204_200.0], [0.0, 0.0, 20.0, 20.0], [6.4, 95.0, 6.5, 95.1]] {
        let error = get(&bucket.source(), sides).unwrap_err();
        assert!(matches!(error, FetchError::Box(_)) && error.is_refusal(), "{error}");
    }
    assert_eq!(bucket.requests(), Vec::<String>::new());
    let tiny = get(&bucket.source(), [6.4001, 85.5001, 6.4002, 85.5002]).unwrap_err();
    assert!(tiny.to_string().contains("at least 2 x 2"), "{tiny}");
}

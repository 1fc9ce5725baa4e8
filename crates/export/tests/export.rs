//! Exported files hold what the run's folder holds, to the bit.

use corpuscle_export::{ExportError, Format, export};
use corpuscle_model::{Column, Frame, GaugeColumn, Map, ParticleSet, Values};
use corpuscle_output::{FrameFormat, MapFiles, OutputError, RunFolder};
use corpuscle_scene::Scene;
use corpuscle_terrain::{Raster, Terrain, read_raster, write_raster};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use rust_hdf5::H5File;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Larger than a chunk, and no multiple of it.
const SIZE: [usize; 2] = [300, 270];

/// Times of the frames and of the rows of gauges, s.
const TIMES: [f64; 3] = [0.0, 10.0, 20.0];

/// A folder with a terrain in British National Grid, and a run on it.
struct Made {
    folder: TempDir,
    terrain: Terrain,
}

impl Made {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let grid = folder.path().join("plain.asc");
        let [columns, rows] = SIZE;
        let row = vec!["1.5"; columns].join(" ") + "\n";
        let head = format!("ncols {columns}\nnrows {rows}\nxllcorner 400000\nyllcorner 300000\ncellsize 5\n");
        fs::write(&grid, head + &row.repeat(rows)).unwrap();
        fs::write(folder.path().join("plain.prj"), "").unwrap();
        let scene = Scene::parse(&scene(&grid), "sample", &[]).unwrap();
        let terrain = Terrain::open(&scene.flood().unwrap().terrain, 1, Path::new(".")).unwrap();
        Self { folder, terrain }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Begins a run and writes all of it but what comes at the end.
    fn run(&self, name: &str, format: FrameFormat) -> RunFolder {
        let scene = scene(&self.path("plain.asc"));
        let gauge = |gauge: &str| GaugeColumn { gauge: gauge.into(), quantity: "depth", unit: "m" };
        let mut run = RunFolder::create(&self.path(name), &scene, &[gauge("P1"), gauge("mill, old")], format).unwrap();
        for (index, time) in TIMES.into_iter().enumerate() {
            run.append_gauges(time, &[0.1 + time, if index == 1 { f64::NAN } else { -0.3 }]).unwrap();
            run.write_frame(&frame(index, time), None).unwrap();
            run.write_snapshot(time, &[map("depth", index)], &self.terrain).unwrap();
        }
        run
    }
}

fn scene(terrain: &Path) -> String {
    format!(
        "title = \"Großer Regen\"\n[run]\nuntil_s = 20.0\nframe_every_s = 10.0\n[terrain.file]\npath = {:?}\ncrs = \"EPSG:27700\"\n\
         [flood]\nspacing_m = 5.0\n",
        terrain.display().to_string()
    )
}

/// A map with a value of its own in each cell, and cells without data.
fn map(name: &'static str, number: usize) -> Map {
    let [columns, rows] = SIZE;
    let value = |cell: usize| if cell.is_multiple_of(7) { f32::NAN } else { cell as f32 / 3.0 + 1e6 * number as f32 };
    Map { name, title: "", unit: "", columns, rows, values: (0..columns * rows).map(value).collect() }
}

/// Water whose number changes, and spray with columns of its own that comes later.
fn frame(index: usize, time: f64) -> Frame {
    let set = |name: &str, count: usize, first: u64| ParticleSet {
        name: name.into(),
        id: (0..count as u64).map(|i| first + i).collect(),
        position: (0..count).map(|i| [time + i as f64 / 3.0, 1.0, -2.0]).collect(),
        velocity: vec![[0.5, -0.25, time]; count],
        radius: vec![0.1; count],
        mass: (0..count).map(|i| 1.0 + i as f64).collect(),
        columns: Vec::new(),
    };
    let mut water = set("water", 5 + 20_000 * index, 1 << 60);
    let depth = (0..water.len()).map(|i| i as f64 / 7.0).collect();
    water.columns.push(Column { name: "depth", unit: "m", values: Values::Scalar(depth) });
    let mut sets = vec![water];
    if index > 0 {
        let mut spray = set("spray", 3, 7);
        spray.columns.push(Column { name: "spin", unit: "", values: Values::Vector(vec![[1.0, 2.0, 1.0 / 3.0]; 3]) });
        sets.push(spray);
    }
    Frame { time, sets }
}

fn same(a: &[f32], b: &[f32]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan())
}

fn text(file: &H5File, dataset: &str, attribute: &str) -> String {
    file.dataset(dataset).unwrap().attr(attribute).unwrap().read_string().unwrap()
}

#[test]
fn maps_keep_values_places_times_and_system() {
    let made = Made::new();
    let run = made.run("run", FrameFormat::None);
    run.write_final_maps(&[map("max_depth", 5), map("own_index", 6)], &made.terrain).unwrap();
    let out = made.path("maps.nc");
    assert_eq!(export(run.path(), &out).unwrap(), Format::NetCdf);

    let file = H5File::open(&out).unwrap();
    let maximum = file.dataset("max_depth").unwrap();
    assert!(maximum.shape() == [SIZE[1], SIZE[0]] && same(&maximum.read_raw().unwrap(), &map("", 5).values));
    let depth = file.dataset("depth").unwrap();
    assert_eq!(depth.shape(), [TIMES.len(), SIZE[1], SIZE[0]]);
    for index in 0..TIMES.len() {
        let read = depth.read_slice(&[index, 0, 0], &[1, SIZE[1], SIZE[0]]).unwrap();
        assert!(same(&read, &map("", index).values), "{index}");
    }
    assert_eq!(file.dataset("time").unwrap().read_raw::<f64>().unwrap(), TIMES);
    let [x, y] = ["x", "y"].map(|name| file.dataset(name).unwrap().read_raw::<f64>().unwrap());
    assert_eq!((x.len(), x[0], x[1]), (SIZE[0], 400_002.5, 400_007.5));
    assert_eq!((y.len(), y[0], y[1]), (SIZE[1], 301_347.5, 301_342.5));

    assert_eq!(file.attr_string("Conventions").unwrap(), "CF-1.8");
    assert_eq!(file.attr_string("title").unwrap(), "Großer Regen");
    assert_eq!([text(&file, "max_depth", "long_name"), text(&file, "max_depth", "units")], ["Maximum depth", "m"]);
    assert_eq!(text(&file, "own_index", "long_name"), "own index");
    assert_eq!(text(&file, "y", "standard_name"), "projection_y_coordinate");
    assert_eq!(text(&file, "depth", "grid_mapping"), "spatial_ref");
    assert!(text(&file, "spatial_ref", "crs_wkt").starts_with("PROJCS[\"OSGB 1936 / British National Grid\""));
    assert!(file.dataset("depth").unwrap().attr_names().unwrap().contains(&"DIMENSION_LIST".to_owned()));
}

#[test]
fn a_run_that_has_not_ended_gives_its_maps_so_far() {
    let made = Made::new();
    let run = made.run("run", FrameFormat::None);
    export(run.path(), &made.path("maps.nc")).unwrap();
    let names = H5File::open(made.path("maps.nc")).unwrap().dataset_names();
    assert!(names.contains(&"depth".to_owned()) && !names.contains(&"max_depth".to_owned()), "{names:?}");
}

#[test]
fn a_map_of_another_size_is_refused_by_name_and_nothing_is_written() {
    let made = Made::new();
    let run = made.run("run", FrameFormat::None);
    let raster = read_raster(made.path("plain.asc")).unwrap();
    let small = Raster { columns: SIZE[0], rows: 1, values: raster.values[..SIZE[0]].to_vec(), ..raster };
    write_raster(run.path().join("maps/depth_000001.tif"), &small, -9999.0).unwrap();
    let error = export(run.path(), &made.path("maps.nc")).unwrap_err();
    assert!(error.to_string().contains("depth_000001.tif") && error.to_string().contains("300 cells"), "{error}");
    let left = fs::read_dir(made.folder.path()).unwrap().map(|entry| entry.unwrap().file_name());
    assert!(
        !left.into_iter().any(|name| name.to_string_lossy().contains(".nc") || name.to_string_lossy().starts_with('.'))
    );
}

#[test]
fn gauges_keep_names_values_and_gaps() {
    let made = Made::new();
    let run = made.run("run", FrameFormat::None);
    let out = made.path("gauges.parquet");
    export(run.path(), &out).unwrap();
    let reader = SerializedFileReader::new(File::open(&out).unwrap()).unwrap();
    let rows: Vec<_> = reader.get_row_iter(None).unwrap().map(Result::unwrap).collect();
    let cells: Vec<Vec<(&str, &Field)>> =
        rows.iter().map(|row| row.get_column_iter().map(|(name, field)| (name.as_str(), field)).collect()).collect();
    assert_eq!(cells.len(), TIMES.len());
    let names: Vec<_> = cells[0].iter().map(|(name, _)| *name).collect();
    assert_eq!(names, ["time_s", "P1.depth_m", "mill, old.depth_m"]);
    for (row, time) in cells.iter().zip(TIMES) {
        let gap = time == TIMES[1];
        assert_eq!(row[0].1, &Field::Double(time));
        assert_eq!(row[1].1, &Field::Double(0.1 + time));
        assert_eq!(row[2].1, &if gap { Field::Null } else { Field::Double(-0.3) });
    }
    let metadata = reader.metadata().file_metadata().key_value_metadata().unwrap();
    assert!(metadata.iter().any(|pair| pair.value.as_deref() == Some("Großer Regen")));
}

#[test]
fn particles_of_all_frames_are_steps_of_one_file() {
    let made = Made::new();
    for format in [FrameFormat::Vtp, FrameFormat::Csv, FrameFormat::Xyz] {
        let run = made.run(&format!("run-{format:?}"), format);
        let out = made.path(&format!("{format:?}.vtkhdf"));
        export(run.path(), &out).unwrap();
        check_particles(&H5File::open(&out).unwrap());
    }
}

fn check_particles(file: &H5File) {
    let integers = |name: &str| file.dataset(&format!("VTKHDF/{name}")).unwrap().read_raw::<i64>().unwrap();
    let numbers = |name: &str| file.dataset(&format!("VTKHDF/{name}")).unwrap().read_raw::<f64>().unwrap();
    let frames: Vec<Frame> = TIMES.into_iter().enumerate().map(|(index, time)| frame(index, time)).collect();
    let counts: Vec<i64> = frames.iter().map(|frame| frame.sets.iter().map(|set| set.len() as i64).sum()).collect();
    assert_eq!((numbers("Steps/Values"), integers("NumberOfPoints")), (TIMES.to_vec(), counts.clone()));
    assert_eq!(integers("Steps/PointOffsets"), [0, counts[0], counts[0] + counts[1]]);
    assert_eq!(integers("Steps/PointDataOffsets/spin"), integers("Steps/PointOffsets"));
    assert_eq!(integers("Vertices/NumberOfCells"), counts);
    let most = *counts.iter().max().unwrap();
    assert_eq!(integers("Vertices/Offsets"), (0..=most).collect::<Vec<_>>());

    let sets: Vec<&ParticleSet> = frames.iter().flat_map(|frame| &frame.sets).collect();
    let points: Vec<f64> = sets.iter().flat_map(|set| set.position.as_flattened()).copied().collect();
    assert_eq!(numbers("Points"), points);
    let masses: Vec<f64> = sets.iter().flat_map(|set| &set.mass).copied().collect();
    assert_eq!(numbers("PointData/mass"), masses);
    let ids: Vec<u64> = sets.iter().flat_map(|set| &set.id).copied().collect();
    assert_eq!(file.dataset("VTKHDF/PointData/id").unwrap().read_raw::<u64>().unwrap(), ids);
    let kinds: Vec<i32> = sets.iter().flat_map(|set| vec![i32::from(set.name == "spray"); set.len()]).collect();
    assert_eq!(file.dataset("VTKHDF/PointData/set").unwrap().read_raw::<i32>().unwrap(), kinds);
    // A column that comes later, of one set: no number before and beside.
    let spin = numbers("PointData/spin");
    for (row, kind) in spin.chunks(3).zip(&kinds) {
        assert!(if *kind == 1 { row == [1.0, 2.0, 1.0 / 3.0] } else { row.iter().all(|value| value.is_nan()) });
    }
    let depth = numbers("PointData/depth");
    assert!(depth[3] == 3.0 / 7.0 && depth.iter().zip(&kinds).all(|(depth, kind)| depth.is_nan() == (*kind == 1)));
}

#[test]
fn extended_xyz_has_all_frames_and_the_same_from_any_format() {
    let made = Made::new();
    let texts = [FrameFormat::Vtp, FrameFormat::Xyz].map(|format| {
        let run = made.run(&format!("run-{format:?}"), format);
        let out = made.path(&format!("{format:?}.xyz"));
        export(run.path(), &out).unwrap();
        fs::read_to_string(out).unwrap()
    });
    assert!(texts[0] == texts[1]);
    let lines: Vec<&str> = texts[0].lines().collect();
    assert!(lines[0] == "5" && lines[1].ends_with(" Time=0") && lines[7] == "20008" && lines[8].ends_with(" Time=10"));
}

#[test]
fn what_a_run_lacks_is_an_error_that_says_what_to_do() {
    let made = Made::new();
    let mut run =
        RunFolder::create(&made.path("run"), &scene(&made.path("plain.asc")), &[], FrameFormat::None).unwrap();
    let told = |file: &str| export(&made.path("run"), &made.path(file)).unwrap_err();
    assert!(matches!(told("a.nc"), ExportError::Output(OutputError::NoMaps { .. })));
    assert!(matches!(told("a.parquet"), ExportError::NoGauges { .. }));
    assert!(told("a.vtkhdf").to_string().contains("--frames vtp"));
    assert!(told("a.tar").to_string().contains(".vtkhdf"));
    assert!(told("a.nc").is_refusal());
    run.append_gauges(0.0, &[]).unwrap();
    let error = export(&made.path("run"), &made.path("no/such/folder/a.parquet")).unwrap_err();
    assert!(!error.is_refusal() && error.to_string().contains("a.parquet"), "{error}");
    assert!(export(&made.path("nowhere"), &made.path("a.nc")).unwrap_err().to_string().contains("scene.toml"));
    assert!(MapFiles::list(&made.path("run")).is_err());
}

//! Files that are no terrain: each is an error of one paragraph that names the file, never a panic.

use corpuscle_scene::{NoData, TerrainFile};
use corpuscle_terrain::{MapBox, Terrain, TerrainError, read_raster, read_raster_part, read_rasters, summarize};
use geotiff_writer::{Compression, GeoTiffBuilder};
use ndarray::Array2;
use proptest::prelude::*;
use std::path::Path;
use std::sync::LazyLock;

/// What every reader says of these bytes in a file of this name: that of all of it, that of a part, that of several files as one, and
/// the summary.
fn read_by_all(name: &str, bytes: &[u8]) -> [Result<(), TerrainError>; 4] {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    let part = MapBox::new([50.0, 50.0, 150.0, 250.0]).unwrap();
    [
        read_raster(&path).map(|_| ()),
        read_raster_part(&path, &part).map(|_| ()),
        read_rasters(&[path.clone(), path.clone()], None, Some(&part)).map(|_| ()),
        summarize(&path, None).map(|_| ()),
    ]
}

/// What reading these bytes from a file of this name says.
fn read(name: &str, bytes: &[u8]) -> Result<(), TerrainError> {
    let [whole, ..] = read_by_all(name, bytes);
    whole
}

/// The one-paragraph message, which must hold `hint`.
fn refused(name: &str, bytes: &[u8], hint: &str) {
    let text = read(name, bytes).expect_err(hint).to_string();
    assert!(text.contains(name) && text.contains(hint) && !text.contains('\n'), "{text}");
}

/// A small sound GeoTIFF.
fn geotiff(compression: Compression) -> Vec<u8> {
    let samples = Array2::from_shape_fn((40, 30), |(row, column)| (row * column) as f32);
    let builder = GeoTiffBuilder::new(30, 40).pixel_scale(10.0, 10.0).origin(0.0, 400.0).epsg(27700).nodata("-9999");
    let mut bytes = std::io::Cursor::new(Vec::new());
    builder.compression(compression).tile_size(16, 16).write_2d_to(&mut bytes, samples.view()).unwrap();
    bytes.into_inner()
}

static PLAIN: LazyLock<Vec<u8>> = LazyLock::new(|| geotiff(Compression::None));
static DEFLATED: LazyLock<Vec<u8>> = LazyLock::new(|| geotiff(Compression::Deflate));
static LZW: LazyLock<Vec<u8>> = LazyLock::new(|| geotiff(Compression::Lzw));

#[test]
fn wrong_types_are_named() {
    refused("empty.tif", b"", "empty");
    refused("picture.tif", b"\x89PNG\r\n\x1a\n0000", "PNG");
    refused("notes.asc", b"Dear diary, today", "ncols");
    refused("archive.tif", b"PK\x03\x04rest", "ZIP");
    refused("noise.tif", &[7, 200, 0, 1, 99], "neither");
    refused("short.tif", b"II*\0", "damaged");
    refused("packed.asc.gz", &[0x1f, 0x8b, 8, 0, 1, 2, 3], "damaged");
    let missing = read_raster("no/such/dem.tif").unwrap_err();
    assert!(matches!(missing, TerrainError::Read { .. }), "{missing}");
    let folder = read_raster(std::env::temp_dir()).unwrap_err();
    assert!(matches!(folder, TerrainError::Read { .. }), "{folder}");
}

#[test]
fn broken_ascii_grids_are_refused_with_the_line() {
    let grid = |header: &str, values: &str| format!("{header}\nxllcorner 0\nyllcorner 0\ncellsize 1\n{values}\n");
    let refused = |text: String, hint: &str| refused("dem.asc", text.as_bytes(), hint);
    refused(grid("ncols 2\nnrows 2", "1 2 3"), "there are 3");
    refused(grid("ncols 2\nnrows 2", "1 2 3 4 5"), "there are 5");
    refused(grid("ncols 2\nnrows 2", "1 2\n3 x4"), "line 7: `x4` is not a number");
    refused(grid("ncols two\nnrows 2", "1 2 3 4"), "line 1: `ncols` is `two`");
    refused(grid("ncols 2\nnrows 2\ncolour 3", "1 2 3 4"), "`colour` is no key");
    refused(grid("ncols 2", "1 2 3 4"), "no `nrows`");
    refused("ncols 2\nnrows".into(), "line 2: `nrows` has no value");
    refused(grid("ncols 1000000\nnrows 1000000", "1 2 3 4"), "100 million");
    refused(grid("ncols 18446744073709551615\nnrows 4", "1 2 3 4"), "100 million");
    refused(grid("ncols 9000\nnrows 9000", "1 2 3 4"), "cannot hold");
    refused(grid("ncols 1\nnrows 4", "1 2 3 4"), "at least 2 x 2");
    refused(grid("ncols 2\nnrows 2", "1 2 inf 4"), "infinite");
    refused(grid("ncols 2\nnrows 2", "nan nan nan nan"), "none of its cells has data");
    refused(grid("ncols 2\nnrows 2\nnodata_value 7", "7 7 7 7"), "none of its cells has data");
    refused("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize -1\n1 2 3 4".into(), "makes no sense");
}

/// All of it was unpacked: two megabytes of a compressed file took two gigabytes of memory.
#[test]
fn a_small_file_that_unpacks_to_far_more_text_than_its_cells_need_is_refused() {
    use std::io::Write;
    let packed = |text: &str, spaces: usize| {
        let mut writer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        writer.write_all(text.as_bytes()).unwrap();
        let block = vec![b' '; 1 << 20];
        (0..spaces).for_each(|_| writer.write_all(&block).unwrap());
        writer.finish().unwrap()
    };
    let grid = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3 4\n";
    refused("bomb.asc.gz", &packed(grid, 64), "its text goes on beyond 4352 characters");
    refused("bomb.asc.gz", &packed("ncols 2\n", 64), "no `nrows`");
    read("small.asc.gz", &packed(grid, 0)).unwrap();
}

/// The same file with another number in a tag of the TIFF directory that holds one 32-bit value.
fn with_tag(bytes: &[u8], tag: u16, value: u32) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let start = u32::from_le_bytes(bytes[4..8].try_into().unwrap()) as usize;
    let count = u16::from_le_bytes(bytes[start..start + 2].try_into().unwrap()) as usize;
    let entry = (0..count)
        .map(|index| start + 2 + 12 * index)
        .find(|&entry| bytes[entry..entry + 2] == tag.to_le_bytes())
        .expect("the directory has the tag");
    bytes[entry + 2..entry + 4].copy_from_slice(&4_u16.to_le_bytes());
    bytes[entry + 8..entry + 12].copy_from_slice(&value.to_le_bytes());
    bytes
}

#[test]
fn a_header_that_claims_too_much_is_refused_before_anything_is_reserved() {
    let (width, length) = (256, 257);
    let huge = with_tag(&with_tag(&DEFLATED, width, 1_000_000), length, 1_000_000);
    refused("huge.tif", &huge, "1000000 x 1000000");
    let unlikely = with_tag(&with_tag(&DEFLATED, width, 9_999), length, 9_999);
    refused("unlikely.tif", &unlikely, "cannot hold");
    refused("thin.tif", &with_tag(&PLAIN, width, 1), "at least 2 x 2");
}

#[test]
fn a_raster_without_columns_or_rows_is_refused_by_every_reader() {
    let (width, length) = (256, 257);
    let grid =
        |columns: usize, rows: usize| format!("ncols {columns}\nnrows {rows}\nxllcorner 0\nyllcorner 0\ncellsize 10\n");
    let files = [
        ("flat.tif", with_tag(&PLAIN, width, 0), "0 columns and 40 rows"),
        ("flat.tif", with_tag(&DEFLATED, length, 0), "30 columns and 0 rows"),
        ("flat.tif", with_tag(&with_tag(&LZW, width, 0), length, 0), "0 columns and 0 rows"),
        ("flat.asc", grid(0, 40).into_bytes(), "0 columns and 40 rows"),
        ("flat.asc", grid(30, 0).into_bytes(), "30 columns and 0 rows"),
    ];
    for (name, bytes, hint) in files {
        for (reader, answer) in read_by_all(name, &bytes).into_iter().enumerate() {
            let text = answer.expect_err(hint).to_string();
            assert!(text.contains(name) && text.contains(hint) && text.contains("damaged"), "reader {reader}: {text}");
        }
    }
}

#[test]
fn doubtful_heights_are_refused_or_told() {
    let folder = tempfile::tempdir().unwrap();
    let open = |name: &str, lowest: f64, no_data| {
        let text = format!("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3 {lowest}\n");
        std::fs::write(folder.path().join(name), text).unwrap();
        let scene = TerrainFile { path: name.into(), crs: None, no_data };
        Terrain::open(&corpuscle_scene::Terrain::File(scene), 1, folder.path())
    };
    let error = open("lowest.asc", -3.4e38, NoData::Wall).unwrap_err().to_string();
    assert!(error.contains("lowest.asc") && error.contains("no ground"), "{error}");
    let terrain = open("mark.asc", -32768.0, NoData::Wall).unwrap();
    assert!(terrain.warnings().iter().any(|warning| warning.contains("-32768")), "{:?}", terrain.warnings());
}

#[test]
fn a_truncated_file_is_never_taken_for_a_whole_one() {
    for whole in [&*PLAIN, &*DEFLATED, &*LZW] {
        for length in (0..whole.len()).step_by(7) {
            let _ = read("cut.tif", &whole[..length]);
        }
        refused("cut.tif", &whole[..whole.len() / 2], "damaged");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Whatever bytes are changed, the answer is a raster or an error.
    #[test]
    fn changed_bytes_never_panic(
        which in 0..3_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
    ) {
        let mut bytes = [&*PLAIN, &*DEFLATED, &*LZW][which].clone();
        for (index, byte) in changes {
            // The header and the directory are where a change does most.
            let offset = index.index(bytes.len());
            bytes[offset] = byte;
        }
        let _ = read("changed.tif", &bytes);
    }

    /// The same for the directory alone.
    #[test]
    fn a_changed_directory_never_panics(
        which in 0..3_usize,
        changes in prop::collection::vec((0..400_usize, any::<u8>()), 1..4),
    ) {
        let mut bytes = [&*PLAIN, &*DEFLATED, &*LZW][which].clone();
        let start = u32::from_le_bytes(bytes[4..8].try_into().unwrap()) as usize;
        for (offset, byte) in changes {
            let offset = (start + offset) % bytes.len();
            bytes[offset] = byte;
        }
        let _ = read("changed.tif", &bytes);
    }

    /// The same for text.
    #[test]
    fn any_text_never_panics(rest in "\\PC{0,200}", header in "(ncols|nrows) [0-9]{1,20}\n(nrows|cellsize|dx) [0-9.e-]{1,8}\n") {
        let _ = read("text.asc", format!("{header}{rest}").as_bytes());
    }
}

#[test]
fn a_scene_that_names_no_reference_system_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("dem.tif"), &*PLAIN).unwrap();
    for crs in ["27700", "EPSG:", "EPSG:99999999", "+proj=nowhere", ""] {
        let scene = TerrainFile { path: "dem.tif".into(), crs: Some(crs.into()), no_data: NoData::Wall };
        let error = Terrain::open(&corpuscle_scene::Terrain::File(scene), 1, Path::new(folder.path())).unwrap_err();
        assert!(error.to_string().contains("crs = "), "{error}");
    }
}

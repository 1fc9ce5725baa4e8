//! Particle files read back exactly as they were.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use corpuscle_model::{Column, Container, Frame, ParticleSet, Values};
use corpuscle_output::{FrameFiles, FrameFormat, RunFolder};
use quick_xml::Reader;
use quick_xml::events::Event;
use std::collections::BTreeMap;
use std::fs;
use std::io::Read;

const BOX: Container = Container { from: [-1.0, 0.0, 0.5], to: [3.0, 1.5, 0.75] };

/// Two sets, one with columns that the other has not, and numbers that are hard to write.
fn frame() -> Frame {
    let hard = [0.1 + 0.2, -0.0, f64::MIN_POSITIVE, 1e300, 1.0 / 3.0, -1e-7, 123456789.125, f64::MAX];
    let count = 40_000;
    let number = |seed: usize| hard[seed % hard.len()] * if seed.is_multiple_of(3) { 0.7 } else { 1.0 };
    let set = |name: &str, first: usize, columns| ParticleSet {
        name: name.into(),
        id: (0..count).map(|i| u64::MAX - (first + i) as u64).collect(),
        position: (0..count).map(|i| [number(i), number(i + 1), number(i + 2)]).collect(),
        velocity: (0..count).map(|i| [number(i + 3), number(i + 5), number(i + 7)]).collect(),
        radius: vec![0.5; count],
        mass: (0..count).map(number).collect(),
        columns,
    };
    let depth =
        Column { name: "depth", unit: "m", values: Values::Scalar((0..count).map(|i| number(i + 4)).collect()) };
    let flow = Values::Vector((0..count).map(|i| [number(i + 6), 0.0, 1e-9]).collect());
    let flow = Column { name: "flow", unit: "m2/s", values: flow };
    Frame { time: 0.1 + 0.2, sets: vec![set("water", 0, vec![depth, flow]), set("spray", count, vec![])] }
}

fn written(format: FrameFormat, file: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let mut run = RunFolder::create(&folder.path().join("run"), "", &[], format).unwrap();
    run.write_frame(&frame(), Some(&BOX)).unwrap();
    fs::read_to_string(run.path().join("frames").join(file)).unwrap()
}

#[test]
fn csv_reads_back_to_the_bit() {
    let text = written(FrameFormat::Csv, "frame_000000.csv");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("set,id,x,y,z,vx,vy,vz,radius,mass,depth,flow_x,flow_y,flow_z"));
    let same = |text: &str, value: f64| text.parse::<f64>().unwrap().to_bits() == value.to_bits();
    for set in &frame().sets {
        for i in 0..set.len() {
            let cells: Vec<&str> = lines.next().unwrap().split(',').collect();
            assert_eq!((cells[0], cells[1].parse()), (set.name.as_str(), Ok(set.id[i])));
            let numbers = set.position[i].iter().chain(&set.velocity[i]).chain([&set.radius[i], &set.mass[i]]);
            assert!(numbers.zip(&cells[2..]).all(|(value, text)| same(text, *value)), "{cells:?}");
            match set.columns.first().map(|column| &column.values) {
                Some(Values::Scalar(depth)) => assert!(same(cells[10], depth[i])),
                _ => assert_eq!(cells[10..], ["NaN"; 4]),
            }
        }
    }
    assert_eq!(lines.next(), None);
}

#[test]
fn xyz_says_what_stands_in_its_columns() {
    let text = written(FrameFormat::Xyz, "frame_000000.xyz");
    let lines: Vec<&str> = text.lines().take(3).collect();
    assert_eq!(lines[0], "80000");
    assert_eq!(
        lines[1],
        "Lattice=\"4 0 0 0 1.5 0 0 0 0.25\" Origin=\"-1 0 0.5\" pbc=\"F F F\" \
         Properties=species:S:1:pos:R:3:id:I:1:velo:R:3:radius:R:1:mass:R:1:depth:R:1:flow:R:3 Time=0.30000000000000004"
    );
    // As many words as the columns say, with the position behind the species.
    assert_eq!(lines[2].split(' ').count(), 1 + 3 + 1 + 3 + 1 + 1 + 1 + 3);
    assert!(lines[2].starts_with("water 0.21000000000000002 "), "{}", lines[2]);
}

/// The arrays of a VTP by name, as bytes, and the texts of its ASCII arrays; panics where it is not well-formed XML.
fn vtp_arrays(text: &str) -> BTreeMap<String, Vec<u8>> {
    let mut reader = Reader::from_str(text);
    let (mut offsets, mut appended) = (BTreeMap::new(), String::new());
    let mut inside = Vec::new();
    loop {
        match reader.read_event().unwrap() {
            Event::Start(element) => inside.push(element.name().as_ref().to_vec()),
            Event::End(_) => drop(inside.pop()),
            Event::Empty(element) => {
                let attribute = |name: &str| {
                    let attribute = element.try_get_attribute(name).unwrap().unwrap();
                    String::from_utf8(attribute.value.to_vec()).unwrap()
                };
                if element.name().as_ref() == b"DataArray" {
                    offsets.insert(attribute("Name"), attribute("offset").parse::<usize>().unwrap());
                }
            }
            Event::Text(content) if inside.last().is_some_and(|name| name == b"AppendedData") => {
                appended = String::from_utf8(content.to_vec()).unwrap().trim().strip_prefix('_').unwrap().to_owned();
            }
            Event::Eof => break,
            _ => {}
        }
    }
    assert!(inside.is_empty());
    offsets.into_iter().map(|(name, offset)| (name, decode(&appended[offset..]))).collect()
}

/// Undoes base64 and zlib as the VTK file format says: number of blocks, block size, last block's size, sizes.
fn decode(encoded: &str) -> Vec<u8> {
    let number =
        |bytes: &[u8], index: usize| u64::from_le_bytes(bytes[8 * index..8 * index + 8].try_into().unwrap()) as usize;
    let blocks = number(&STANDARD.decode(&encoded[..12]).map(|bytes| bytes[..8].to_vec()).unwrap(), 0);
    let header_length = (8 * (3 + blocks)).div_ceil(3) * 4;
    let header = STANDARD.decode(&encoded[..header_length]).unwrap();
    let sizes: Vec<usize> = (0..blocks).map(|block| number(&header, 3 + block)).collect();
    let data_length = sizes.iter().sum::<usize>().div_ceil(3) * 4;
    let data = STANDARD.decode(&encoded[header_length..header_length + data_length]).unwrap();
    let (mut bytes, mut start) = (Vec::new(), 0);
    for size in sizes {
        flate2::read::ZlibDecoder::new(&data[start..start + size]).read_to_end(&mut bytes).unwrap();
        start += size;
    }
    let last = number(&header, 2);
    let expected = if last == 0 { blocks * number(&header, 1) } else { (blocks - 1) * number(&header, 1) + last };
    assert_eq!(bytes.len(), expected);
    bytes
}

fn same_numbers(bytes: &[u8], values: impl Iterator<Item = f64>) -> bool {
    let written: Vec<u64> = bytes.chunks_exact(8).map(|b| u64::from_le_bytes(b.try_into().unwrap())).collect();
    written == values.map(f64::to_bits).collect::<Vec<_>>()
}

#[test]
fn vtp_is_well_formed_and_reads_back_to_the_bit() {
    let arrays = vtp_arrays(&written(FrameFormat::Vtp, "frame_000000.vtp"));
    let frame = frame();
    let sets = || frame.sets.iter();
    assert!(same_numbers(&arrays["position"], sets().flat_map(|set| set.position.iter().flatten().copied())));
    assert!(same_numbers(&arrays["velocity"], sets().flat_map(|set| set.velocity.iter().flatten().copied())));
    assert!(same_numbers(&arrays["mass"], sets().flat_map(|set| set.mass.iter().copied())));
    assert!(same_numbers(&arrays["radius"], sets().flat_map(|set| set.radius.iter().copied())));
    let ids: Vec<u8> = sets().flat_map(|set| &set.id).flat_map(|id| id.to_le_bytes()).collect();
    assert_eq!(arrays["id"], ids);
    let Values::Vector(flow) = &frame.sets[0].columns[1].values else { panic!("flow is a vector") };
    let missing = std::iter::repeat_n(f64::NAN, 3 * frame.sets[1].len());
    assert!(same_numbers(&arrays["flow"], flow.iter().flatten().copied().chain(missing)));
    assert_eq!(arrays["offsets"].len(), 8 * 80_000);
}

#[test]
fn an_empty_frame_is_a_file_too() {
    let folder = tempfile::tempdir().unwrap();
    let mut run = RunFolder::create(&folder.path().join("run"), "", &[], FrameFormat::Vtp).unwrap();
    run.write_frame(&Frame { time: 0.0, sets: vec![] }, None).unwrap();
    let text = fs::read_to_string(run.path().join("frames/frame_000000.vtp")).unwrap();
    assert!(vtp_arrays(&text)["position"].is_empty());
}

#[test]
fn the_collection_lists_all_frames_with_their_times() {
    let folder = tempfile::tempdir().unwrap();
    let mut run = RunFolder::create(&folder.path().join("run"), "", &[], FrameFormat::Vtp).unwrap();
    for time in [0.0, 0.1 + 0.2] {
        run.write_frame(&Frame { time, sets: vec![] }, None).unwrap();
    }
    let text = fs::read_to_string(run.path().join("frames/frames.pvd")).unwrap();
    let mut reader = Reader::from_str(&text);
    let mut sets = Vec::new();
    loop {
        match reader.read_event().unwrap() {
            Event::Empty(element) => {
                let value = |name: &str| element.try_get_attribute(name).unwrap().unwrap().value.to_vec();
                sets.push([value("timestep"), value("file")].map(|bytes| String::from_utf8(bytes).unwrap()));
            }
            Event::Eof => break,
            _ => {}
        }
    }
    assert_eq!(sets, [["0", "frame_000000.vtp"], ["0.30000000000000004", "frame_000001.vtp"]]);
}

/// A run of one frame, written and listed.
fn listed(format: FrameFormat) -> (tempfile::TempDir, FrameFiles) {
    let folder = tempfile::tempdir().unwrap();
    let mut run = RunFolder::create(&folder.path().join("run"), "", &[], format).unwrap();
    run.write_frame(&frame(), Some(&BOX)).unwrap();
    let files = FrameFiles::list(run.path(), |_| frame().time).unwrap();
    (folder, files)
}

#[test]
fn frames_read_back_to_the_bit_from_all_formats() {
    let bits = |frame: &Frame| {
        let mut all = vec![frame.time.to_bits()];
        for set in &frame.sets {
            let vectors = [&set.position, &set.velocity].map(|column| column.as_flattened().to_vec());
            let scalars = [set.radius.clone(), set.mass.clone()];
            let own = set.columns.iter().map(|column| match &column.values {
                Values::Scalar(values) => values.clone(),
                Values::Vector(values) => values.as_flattened().to_vec(),
            });
            all.extend(vectors.into_iter().chain(scalars).chain(own).flatten().map(f64::to_bits));
            all.extend(&set.id);
        }
        all
    };
    for format in [FrameFormat::Vtp, FrameFormat::Csv, FrameFormat::Xyz] {
        let (_folder, files) = listed(format);
        assert_eq!(files.times().collect::<Vec<_>>(), [0.1 + 0.2]);
        let back = files.read(0).unwrap();
        let names = |frame: &Frame| -> Vec<(String, Vec<&'static str>)> {
            let columns = |set: &ParticleSet| set.columns.iter().map(|column| column.name).collect();
            frame.sets.iter().map(|set| (set.name.clone(), columns(set))).collect()
        };
        assert_eq!(names(&back), names(&frame()));
        assert!(bits(&back) == bits(&frame()), "{format:?}");
    }
}

#[test]
fn damaged_particle_files_are_errors_that_name_the_file() {
    let xyz = (FrameFormat::Xyz, "frame_000000.xyz");
    for (format, name) in [(FrameFormat::Vtp, "frame_000000.vtp"), (FrameFormat::Csv, "frame_000000.csv"), xyz] {
        let (folder, files) = listed(format);
        let path = folder.path().join("run/frames").join(name);
        let whole = fs::read_to_string(&path).unwrap();
        let bend = |from: &str, to: &str| whole.replacen(from, to, 1);
        let damaged = [
            String::new(),
            whole[..whole.len() / 2].to_owned(),
            bend("80000", "80001"),
            bend("80000", "99999999999999999"),
            bend("_", "_AAAA"),
            bend("offset=\"0\"", "offset=\"18446744073709551615\""),
            bend("water", "0x"),
            bend("set,id", "id,set"),
            bend("0.7", "seven"),
            bend("species:S", "pos:R"),
            bend("Time=", "time="),
            bend("R:3:depth", "I:3:depth"),
            bend(" 0.5 ", " "),
        ];
        for text in damaged.into_iter().filter(|text| *text != whole) {
            fs::write(&path, &text).unwrap();
            // A table cut at the end of a line is a shorter table, a new name is a set: neither may panic.
            if let Err(error) = files.read(0) {
                assert!(error.to_string().contains(name), "{error}");
            }
        }
        fs::write(&path, "").unwrap();
        assert!(files.read(0).is_err());
    }
}

/// A frame with many columns, all at the offset of the first: a small file that would unpack to far more than it holds.
#[test]
fn arrays_that_share_their_data_are_refused() {
    let (folder, files) = listed(FrameFormat::Vtp);
    let path = folder.path().join("run/frames/frame_000000.vtp");
    let whole = fs::read_to_string(&path).unwrap();
    let element = whole.lines().find(|line| line.contains("Name=\"depth\"")).unwrap();
    let with = |more: &str| {
        fs::write(&path, whole.replacen(element, &format!("{element}\n{more}"), 1)).unwrap();
        files.read(0).map(|frame| frame.sets.len()).map_err(|error| error.to_string())
    };
    assert_eq!(with(""), Ok(2));
    assert!(with(element).unwrap_err().contains("two arrays `depth`"));
    let many: Vec<String> = (0..700).map(|number| element.replace("depth", &format!("depth{number}"))).collect();
    let error = with(&many.join("\n")).unwrap_err();
    assert!(error.contains("frame_000000.vtp") && error.contains("is damaged"), "{error}");
}

/// A file of so many points, all numbers 0, packed as tightly as zlib can.
fn zeros(points: usize) -> String {
    let (mut elements, mut appended) = (String::new(), String::new());
    for (name, components, size) in
        [("set", 1, 4), ("id", 1, 8), ("velocity", 3, 24), ("radius", 1, 8), ("mass", 1, 8), ("position", 3, 24)]
    {
        let offset = appended.len();
        if name == "position" {
            elements += "</PointData><Points>";
        }
        elements += &format!("<DataArray Name=\"{name}\" NumberOfComponents=\"{components}\" offset=\"{offset}\"/>");
        let mut packed = Vec::new();
        let bytes = vec![0; points * size];
        flate2::read::ZlibEncoder::new(bytes.as_slice(), flate2::Compression::best()).read_to_end(&mut packed).unwrap();
        let head = [1, bytes.len() as u64, 0, packed.len() as u64].map(u64::to_le_bytes);
        appended += &STANDARD.encode(head.as_flattened());
        appended += &STANDARD.encode(&packed);
    }
    format!(
        "<VTKFile><FieldData><DataArray Name=\"TimeValue\">0</DataArray><Array Name=\"set_names\">97 0</Array></FieldData>\
         <Piece NumberOfPoints=\"{points}\"><PointData>{elements}</Points></Piece><AppendedData>_{appended}</AppendedData>\
         </VTKFile>"
    )
}

#[test]
fn points_that_unpack_from_next_to_nothing_are_refused() {
    let (folder, files) = listed(FrameFormat::Vtp);
    let path = folder.path().join("run/frames/frame_000000.vtp");
    let read = |points: usize| {
        fs::write(&path, zeros(points)).unwrap();
        files.read(0).map(|frame| frame.sets[0].len()).map_err(|error| error.to_string())
    };
    assert_eq!(read(10_000), Ok(10_000));
    let error = read(1_000_000).unwrap_err();
    assert!(error.contains("frame_000000.vtp") && error.contains("too short for as many points"), "{error}");
}

#[test]
fn a_collection_names_files_beside_it_only() {
    let (folder, _) = listed(FrameFormat::Vtp);
    let run = folder.path().join("run");
    let path = run.join("frames/frames.pvd");
    let whole = fs::read_to_string(&path).unwrap();
    for name in ["..", ".", "/", "../other.vtp", "/etc/passwd", "a/b.vtp", "./frame_000000.vtp", "frame_000000.vtp/"] {
        fs::write(&path, whole.replace("frame_000000.vtp", name)).unwrap();
        let error = FrameFiles::list(&run, |_| 0.0).unwrap_err().to_string();
        assert!(error.contains(&format!("the file `{name}` does not stand beside it")), "{error}");
    }
}

#[test]
fn many_sets_take_no_longer_than_their_points() {
    let folder = tempfile::tempdir().unwrap();
    let mut run = RunFolder::create(&folder.path().join("run"), "", &[], FrameFormat::Vtp).unwrap();
    let of = |number: usize| ParticleSet {
        name: format!("s{number}"),
        id: vec![number as u64],
        position: vec![[number as f64; 3]],
        velocity: vec![[0.0; 3]],
        radius: vec![1.0],
        mass: vec![1.0],
        columns: vec![],
    };
    let sets: Vec<ParticleSet> = (0..100_000).map(of).collect();
    run.write_frame(&Frame { time: 0.0, sets }, None).unwrap();
    let files = FrameFiles::list(run.path(), |_| 0.0).unwrap();
    let start = std::time::Instant::now();
    let frame = files.read(0).unwrap();
    assert!(frame.sets.iter().enumerate().all(|(number, set)| set.id == [number as u64]));
    assert!(start.elapsed().as_secs_f64() < 4.0, "{:?}", start.elapsed());
}

#[test]
fn a_run_without_particle_files_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let error = FrameFiles::list(folder.path(), |_| 0.0).unwrap_err().to_string();
    assert!(error.contains("no particle files"), "{error}");
}

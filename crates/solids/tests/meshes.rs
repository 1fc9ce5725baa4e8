//! Meshes: every format reads, distances are those of brute force, and what bounds no solid is refused with its reason.

mod common;

use base64::Engine;
use common::{Soup, ball, cube, torus};
use corpuscle_solids::{Depth, Mesh, Pose, Solid, SolidError};
use proptest::prelude::*;
use std::path::Path;

fn mesh(soup: &Soup) -> Mesh {
    made(soup).unwrap()
}

fn made(soup: &Soup) -> Result<Mesh, SolidError> {
    Mesh::new(Path::new("test"), soup.corners.clone(), soup.triangles.clone())
}

fn refused(soup: &Soup) -> String {
    made(soup).unwrap_err().to_string()
}

fn written(folder: &tempfile::TempDir, name: &str, content: impl AsRef<[u8]>) -> std::path::PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, content).unwrap();
    path
}

#[test]
fn every_format_gives_the_same_solid() {
    let folder = tempfile::tempdir().unwrap();
    let soup = ball(1.5, 1);
    let expected = mesh(&soup);
    for (name, content) in soup.in_all_formats() {
        let path = written(&folder, name, content);
        let is_in_metres = name.ends_with("gltf") || name.ends_with("glb");
        let read =
            Mesh::read(&path, (!is_in_metres).then_some(0.001)).unwrap_or_else(|error| panic!("{name}: {error}"));
        let scale: f64 = if is_in_metres { 1.0 } else { 0.001 };
        assert!((read.volume() / expected.volume() / scale.powi(3) - 1.0).abs() < 1e-6, "{name}");
        assert!((read.area() / expected.area() / scale.powi(2) - 1.0).abs() < 1e-6, "{name}");
        assert_eq!(read.notes(), [""; 0], "{name}");
    }
}

#[test]
fn gltf_stands_upright() {
    let folder = tempfile::tempdir().unwrap();
    let mut soup = cube([1.0, 2.0, 3.0]);
    soup.corners.iter_mut().for_each(|corner| corner[1] += 10.0);
    let (_, content) = soup.in_all_formats().into_iter().find(|(name, _)| *name == "mesh.gltf").unwrap();
    let read = Mesh::read(&written(&folder, "mesh.gltf", content), None).unwrap();
    assert_eq!(read.bounds(), [[0.0, -3.0, 10.0], [1.0, 0.0, 12.0]]);
}

#[test]
fn what_bounds_no_solid_is_refused() {
    let whole = ball(1.0, 2);
    let mut open = whole.clone();
    open.triangles.truncate(open.triangles.len() - 1);
    assert!(refused(&open).contains("not watertight: 3 open edges"), "{}", refused(&open));
    let mut twice = whole.clone();
    twice.triangles.push(twice.triangles[0]);
    assert!(refused(&twice).contains("3 edges have more than two triangles"), "{}", refused(&twice));
    let mut not_a_number = whole.clone();
    not_a_number.corners[3][1] = f64::NAN;
    assert!(refused(&not_a_number).contains("corner 3 (counted from 0) is at"), "{}", refused(&not_a_number));
    let mut unknown = whole.clone();
    unknown.triangles[5][1] = 9999;
    assert!(refused(&unknown).contains("triangle 5"), "{}", refused(&unknown));
    let flat = cube([1.0, 1.0, 1e-12]);
    assert!(refused(&flat).contains("no volume"), "{}", refused(&flat));
    assert!(refused(&Soup::default()).contains("no triangles"));
    let mut crossing = cube([1.0; 3]);
    let mut other = cube([1.0; 3]);
    other.corners.iter_mut().for_each(|corner| *corner = corner.map(|x| x + 0.3));
    crossing.add(&other);
    assert!(refused(&crossing).contains("crosses itself"), "{}", refused(&crossing));
    let mut apart = cube([1.0; 3]);
    other.corners.iter_mut().for_each(|corner| *corner = corner.map(|x| x + 3.0));
    apart.add(&other);
    assert!((mesh(&apart).volume() - 2.0).abs() < 1e-12);
}

#[test]
fn a_strip_with_one_side_is_refused() {
    // Five triangles round a ring with one twist, closed to a surface without edges by a second layer: a Klein bottle.
    let (around, across) = (8_u32, 5_u32);
    let at = |i: u32, j: u32| {
        // After one turn the small circle is passed the other way.
        let (i, j) = if i == around { (0, (across - j) % across) } else { (i, j % across) };
        i * across + j
    };
    let mut soup = Soup::default();
    for i in 0..around {
        for j in 0..across {
            let (u, v) = (f64::from(i), f64::from(j));
            soup.corners.push([u.sin() * (3.0 + v.cos()), u.cos() * (3.0 + v.cos()), v.sin()]);
            let next = (j + 1) % across;
            soup.triangles.push([at(i, j), at(i + 1, j), at(i + 1, next)]);
            soup.triangles.push([at(i, j), at(i + 1, next), at(i, next)]);
        }
    }
    assert!(refused(&soup).contains("only one side"), "{}", refused(&soup));
}

#[test]
fn winding_is_put_right_and_told() {
    let right = ball(1.0, 1);
    let mut some = right.clone();
    for at in [0, 7, 8, 20] {
        some.triangles[at].swap(0, 1);
    }
    let fixed = mesh(&some);
    assert!((fixed.volume() - mesh(&right).volume()).abs() < 1e-12);
    assert!(fixed.notes()[0].contains("4 triangles of 80 were wound against the others"), "{:?}", fixed.notes());
    let mut inward = right.clone();
    inward.triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
    let fixed = mesh(&inward);
    assert!(fixed.volume() > 0.0 && fixed.nearest([0.0; 3]).distance < 0.0);
    assert!(fixed.notes()[0].contains("seen from inside"), "{:?}", fixed.notes());
    let mut flat = right.clone();
    flat.triangles.push([3, 3, 5]);
    assert!(mesh(&flat).notes()[0].contains("1 triangles of 81"), "{:?}", mesh(&flat).notes());
}

#[test]
fn a_hollow_is_empty() {
    let mut shell = ball(1.0, 2);
    let mut hollow = ball(0.5, 2);
    hollow.triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
    shell.add(&hollow);
    let shell = mesh(&shell);
    assert!(shell.nearest([0.0, 0.0, 0.1]).distance > 0.0 && shell.nearest([0.0, 0.0, 0.75]).distance < 0.0);
}

#[test]
fn files_that_are_no_meshes_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let refused =
        |name: &str, content: &[u8]| Mesh::read(&written(&folder, name, content), Some(1.0)).unwrap_err().to_string();
    let text =
        b"Dear mesh,\nthis is a letter and no mesh. It is longer than the head of a binary file, which has 84 bytes.\n";
    for (name, words) in [
        ("letter.stl", "neither a binary STL"),
        ("letter.obj", "no triangles"),
        ("letter.ply", "not a PLY"),
        ("letter.gltf", "not a glTF"),
        ("letter.glb", "not a glTF"),
        ("letter.txt", "must end in .obj, .stl"),
        ("letter", "must end in .obj, .stl"),
    ] {
        let message = refused(name, text);
        assert!(message.contains(words) && message.contains(name), "{message}");
        assert!(!refused(name, b"").is_empty() && !refused(name, b"solid ").is_empty());
    }
    let solid = refused("solid.stl", b"solid as a rock\nfacet this is not\n");
    assert!(solid.contains("not an STL that can be read"), "{solid}");
    let missing = Mesh::read(&folder.path().join("none.stl"), Some(1.0)).unwrap_err().to_string();
    assert!(missing.contains("cannot read the mesh") && missing.contains("none.stl"), "{missing}");
    let unit = Mesh::read(&written(&folder, "a.obj", "v 0 0 0"), None).unwrap_err().to_string();
    assert!(unit.contains("unit of length"), "{unit}");
}

#[test]
fn ten_million_triangles_are_refused_before_they_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("huge.stl");
    let count = 10_000_000_u32;
    let mut head = vec![0; 80];
    head.extend(count.to_le_bytes());
    std::fs::write(&path, head).unwrap();
    std::fs::OpenOptions::new().write(true).open(&path).unwrap().set_len(84 + 50 * u64::from(count)).unwrap();
    let message = Mesh::read(&path, Some(1.0)).unwrap_err().to_string();
    assert!(message.contains("10000000 triangles or more; 2000000 are possible"), "{message}");
    let ply = "ply\nformat ascii 1.0\nelement face 10000000\nproperty list uchar int vertex_indices\nend_header\n";
    let message = Mesh::read(&written(&folder, "huge.ply", ply), Some(1.0)).unwrap_err().to_string();
    assert!(message.contains("2000000 are possible"), "{message}");
}

#[test]
fn files_cut_off_or_damaged_are_refused_without_a_panic() {
    let folder = tempfile::tempdir().unwrap();
    let mut refusals = 0;
    for (name, content) in ball(1.0, 0).in_all_formats() {
        for cut in (0..content.len()).step_by(content.len() / 97 + 1) {
            let path = written(&folder, name, &content[..cut]);
            refusals += usize::from(Mesh::read(&path, Some(1.0)).is_err());
            let mut damaged = content.clone();
            damaged[cut] ^= 0x15;
            // Whatever becomes of it, it does not panic.
            let _ = Mesh::read(&written(&folder, name, &damaged), Some(1.0));
        }
    }
    assert!(refusals > 300, "{refusals}");
}

#[test]
fn a_glb_cannot_reach_beyond_its_data() {
    let folder = tempfile::tempdir().unwrap();
    let (_, content) = cube([1.0; 3]).in_all_formats().into_iter().find(|(name, _)| *name == "mesh.gltf").unwrap();
    let text = String::from_utf8(content).unwrap();
    let short = base64::engine::general_purpose::STANDARD.encode([0_u8; 12]);
    let start = text.find("base64,").unwrap() + 7;
    let end = start + text[start..].find('"').unwrap();
    let cut = format!("{}{short}{}", &text[..start], &text[end..]);
    let message = Mesh::read(&written(&folder, "cut.gltf", cut), None).unwrap_err().to_string();
    assert!(message.contains("shorter than it says"), "{message}");
    for count in ["0", "4000000000", "18446744073709551615"] {
        let odd = text.replacen("\"count\":8", &format!("\"count\":{count}"), 1);
        assert!(Mesh::read(&written(&folder, "odd.gltf", odd), None).is_err(), "{count}");
    }
}

fn gltf_of(soup: &Soup) -> String {
    let (_, content) = soup.in_all_formats().into_iter().find(|(name, _)| *name == "mesh.gltf").unwrap();
    String::from_utf8(content).unwrap()
}

/// A glTF without its data, and these.
fn gltf_apart() -> (String, Vec<u8>) {
    let text = gltf_of(&cube([1.0; 3]));
    let uri = text.split('"').find(|word| word.starts_with("data:")).unwrap();
    let data = base64::engine::general_purpose::STANDARD.decode(uri.split_once(',').unwrap().1).unwrap();
    (text.replace(uri, "URI"), data)
}

#[test]
fn data_of_a_gltf_lie_in_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    let (text, data) = gltf_apart();
    std::fs::create_dir_all(folder.path().join("scene/data")).unwrap();
    for name in ["outside.bin", "scene/mesh.bin", "scene/data/mesh.bin"] {
        written(&folder, name, &data);
    }
    let read = |uri: &str| {
        let path = written(&folder, "scene/mesh.gltf", text.replace("URI", uri));
        Mesh::read(&path, None).map(|mesh| mesh.bounds()).map_err(|error| error.to_string())
    };
    for uri in ["mesh.bin", "./mesh.bin", "data/mesh.bin"] {
        assert_eq!(read(uri), Ok([[0.0, -1.0, 0.0], [1.0, 0.0, 1.0]]), "{uri}");
    }
    let absolute = folder.path().join("outside.bin").display().to_string();
    for uri in ["../outside.bin", "data/../../outside.bin", "/dev/zero", &absolute, ""] {
        let error = read(uri).unwrap_err();
        assert!(error.contains("mesh.gltf") && error.contains("does not lie in its folder"), "{error}");
    }
}

#[cfg(unix)]
#[test]
fn data_without_an_end_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let endless = |name: &str| std::os::unix::fs::symlink("/dev/zero", folder.path().join(name)).unwrap();
    endless("endless.bin");
    let text = gltf_apart().0.replace("URI", "endless.bin");
    let error = Mesh::read(&written(&folder, "mesh.gltf", text), None).unwrap_err().to_string();
    assert!(error.contains("its buffers have more than 536870912 bytes"), "{error}");
    endless("mesh.obj");
    let error = Mesh::read(&folder.path().join("mesh.obj"), Some(1.0)).unwrap_err().to_string();
    assert!(error.contains("too many bytes; 536870912 are possible"), "{error}");
}

#[test]
fn only_the_first_buffer_of_a_glb_may_be_its_binary_part() {
    let folder = tempfile::tempdir().unwrap();
    let (text, data) = gltf_apart();
    let read = |others: &str| {
        let mut json =
            text.replace("\"uri\":\"URI\",", "").replace("}],\"bufferViews\"", &format!("}}{others}],\"bufferViews\""));
        json += &" ".repeat(json.len().next_multiple_of(4) - json.len());
        let mut glb = [b"glTF".as_slice(), &2_u32.to_le_bytes(), &[0; 4]].concat();
        for (kind, chunk) in [(b"JSON", json.as_bytes()), (b"BIN\0", &data)] {
            glb.extend((chunk.len() as u32).to_le_bytes());
            glb.extend(kind);
            glb.extend(chunk);
        }
        let length = (glb.len() as u32).to_le_bytes();
        glb[8..12].copy_from_slice(&length);
        Mesh::read(&written(&folder, "mesh.glb", glb), None)
            .map(|mesh| mesh.bounds())
            .map_err(|error| error.to_string())
    };
    assert_eq!(read(""), Ok([[0.0, -1.0, 0.0], [1.0, 0.0, 1.0]]));
    let error = read(&",{\"byteLength\":4}".repeat(3)).unwrap_err();
    assert!(error.contains("its buffer 1 (counted from 0) has no uri"), "{error}");
}

/// A small file whose parts share one list of corners.
#[test]
fn corners_that_parts_share_are_limited() {
    let folder = tempfile::tempdir().unwrap();
    let part = "{\"attributes\":{\"POSITION\":0},\"indices\":1}";
    let text = gltf_of(&ball(1.0, 6));
    assert!(text.contains(part), "{part}");
    let parts = vec![part.replace("\"indices\":1", "\"indices\":2"); 200].join(",");
    let one = ",{\"bufferView\":1,\"componentType\":5125,\"count\":3,\"type\":\"SCALAR\"}]}";
    let many =
        text.replacen(part, &parts, 1).replacen("\"type\":\"SCALAR\"}]}", &format!("\"type\":\"SCALAR\"}}{one}"), 1);
    let error = Mesh::read(&written(&folder, "many.gltf", many), None).unwrap_err().to_string();
    assert!(error.contains("its parts have more than 6000000 corners"), "{error}");
}

/// Rows without properties take no bytes: a small file said to have any number of them.
#[test]
fn elements_of_a_ply_without_properties_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let head = |format: &str, elements: String| format!("ply\nformat {format} 1.0\n{elements}end_header\n");
    let read = |text: String| Mesh::read(&written(&folder, "many.ply", text), Some(1.0)).unwrap_err().to_string();
    for format in ["ascii", "binary_little_endian"] {
        let empty: String = (0..3000).map(|number| format!("element e{number} 2000000\n")).collect();
        let error = read(head(format, empty));
        assert!(error.contains("its 2000000 elements `e0` have no properties"), "{error}");
    }
    // With a property, all together.
    let many: String = (0..7).map(|number| format!("element e{number} 2000000\nproperty uchar a\n")).collect();
    let bytes = [head("binary_little_endian", many).into_bytes(), vec![0; 14_000_000]].concat();
    let error = Mesh::read(&written(&folder, "many.ply", bytes), Some(1.0)).unwrap_err().to_string();
    assert!(error.contains("14000000 rows or more"), "{error}");
}

/// The reader went round such nodes for ever.
#[test]
fn nodes_of_a_gltf_below_themselves_or_below_two_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (_, content) = cube([1.0; 3]).in_all_formats().into_iter().find(|(name, _)| *name == "mesh.gltf").unwrap();
    let text = String::from_utf8(content).unwrap();
    let node = "{\"mesh\":0}";
    assert!(text.contains(node), "{text}");
    for (nodes, number) in [
        ("{\"mesh\":0,\"children\":[0]}", 0),
        ("{\"children\":[1]},{\"children\":[0]}", 0),
        ("{\"children\":[1,1]},{\"mesh\":0}", 1),
    ] {
        let odd = text.replacen(node, nodes, 1);
        let message = Mesh::read(&written(&folder, "odd.gltf", odd), None).unwrap_err().to_string();
        assert!(message.contains(&format!("its node {number} ")) && message.contains("below itself"), "{message}");
    }
}

#[test]
fn a_sampled_mesh_sums_to_its_volume() {
    for soup in [ball(0.5, 3), torus(0.5, 0.2, 40, 20), cube([0.5, 0.4, 0.3])] {
        let solid = Solid::of_mesh(mesh(&soup), Pose::new([1.0, 2.0, 3.0], [10.0, 20.0, 30.0]));
        let samples = solid.sample(0.03, Depth::Full).unwrap();
        assert!((samples.volumes.iter().sum::<f64>() / solid.volume() - 1.0).abs() < 1e-10);
        assert!((samples.areas.iter().sum::<f64>() / solid.area() - 1.0).abs() < 1e-10);
        assert!(samples.positions.iter().all(|&at| solid.signed_distance(at) < 0.0));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn distances_are_those_of_brute_force(point in [-1.2..1.2, -1.2..1.2, -1.2..1.2]) {
        for soup in [ball(1.0, 1), torus(0.7, 0.3, 12, 8), cube([0.9, 0.5, 0.7])] {
            let mesh = mesh(&soup);
            let nearest = mesh.nearest(point);
            let (distance, is_inside) = (soup.distance(point), soup.winding(point) > 0.5);
            prop_assert!((nearest.distance.abs() - distance).abs() < 1e-9);
            prop_assert!(distance < 1e-9 || (nearest.distance < 0.0) == is_inside, "{nearest:?} {is_inside}");
            let foot = std::array::from_fn(|axis| point[axis] - nearest.distance * nearest.normal[axis]);
            prop_assert!(soup.distance(foot) < 1e-9);
        }
    }
}

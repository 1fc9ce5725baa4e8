//! Solids of scenes: made as told, or refused with the reason.

use corpuscle_dew::bodies::{Body, open};
use corpuscle_scene::Scene;
use std::path::Path;

fn made(solids: &str) -> Result<Vec<Body>, String> {
    made_in(Path::new("."), solids)
}

fn made_in(folder: &Path, solids: &str) -> Result<Vec<Body>, String> {
    let text = format!(
        "run.until_s = 1\n[dew]\nsize_m = [0.2, 0.1, 0.2]\nspacing_m = 0.005\nair = {{ temperature_c = 25, \
         relative_humidity = 0.5 }}\nsolid = [{solids}]"
    );
    let scene = Scene::parse(&text, "test.toml", &[]).unwrap();
    open(scene.dew().unwrap(), folder).map_err(|error| error.to_string())
}

const PANE: &str = "{ name = \"pane\", shape = { box = { size_m = [0.005, 0.1, 0.1] } }, position_m = [0.1, 0.05, 0.1], \
                    temperature_c = 5 }";

#[test]
fn a_scene_becomes_solids_with_particles() {
    let glass = "{ name = \"glass\", shape = { wine-glass = { height_m = 0.15, wall_m = 0.005 } }, position_m = [0.05, 0.05, 0], \
                 material = { conductivity_w_per_m_k = 1.0, heat_capacity_j_per_kg_k = 800, density_kg_per_m3 = 2400 }, \
                 temperature_c = [[0, 5], [10, 25]], held = true, layers = 2 }";
    let bodies = made(&format!("{PANE}, {glass}")).unwrap();
    assert_eq!(bodies[0].samples.positions.len(), 20 * 20);
    assert_eq!((bodies[0].material.name, bodies[1].material.density), ("glass", 2400.0));
    assert_eq!((bodies[1].temperature.at(5.0), bodies[1].held), (15.0, true));
    assert!(bodies[1].solid.signed_distance([0.05, 0.05, 0.05]) < 0.0);
}

#[test]
fn every_material_that_the_guide_names_is_one() {
    let guide =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/src/scene-dew.md")).unwrap();
    let row = guide.lines().find(|line| line.starts_with("| `material` |")).unwrap();
    let meaning = row.split('|').nth(4).unwrap();
    let named: Vec<_> = meaning.split("`\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    let known: Vec<_> = corpuscle_solids::MATERIALS.iter().map(|material| material.name).collect();
    assert_eq!(named, known);
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    let refused = |solids: &str| made(solids).unwrap_err();
    let butter = refused(&PANE.replace("temperature_c", "material = \"butter\", temperature_c"));
    assert!(butter.contains("pane") && butter.contains("no material \"butter\"; there are glass, steel"), "{butter}");
    let outside = refused(&PANE.replace("[0.1, 0.05, 0.1]", "[10, 0.05, 0.1]"));
    assert!(outside.contains("outside the box"), "{outside}");
    let full = refused(&PANE.replace("[0.005, 0.1, 0.1]", "[0.2, 0.1, 0.2]"));
    assert!(full.contains("the solids fill the box"), "{full}");
    let other = PANE.replace("\"pane\"", "\"other\"").replace("[0.1, 0.05, 0.1]", "[0.102, 0.05, 0.1]");
    let overlap = refused(&format!("{PANE}, {other}"));
    assert!(overlap.contains("\"pane\" and \"other\" overlap"), "{overlap}");
    let profile = refused(
        "{ name = \"a\", temperature_c = 5, shape = { revolution = { profile_m = [[0, 0], [1, 1], [1, 0], [0, 1]] } } }",
    );
    assert!(profile.contains("the solid \"a\" (dew.solid.0)") && profile.contains("cross"), "{profile}");
}

#[test]
fn a_solid_too_thin_for_its_particles_is_noted() {
    assert_eq!(made(PANE).unwrap()[0].notes, [""; 0]);
    let thin = made(&PANE.replace("[0.005, 0.1, 0.1]", "[0.002, 0.1, 0.1]")).unwrap();
    assert!(thin[0].notes[0].contains("\"pane\" is thinner than"), "{:?}", thin[0].notes);
}

#[test]
fn a_file_of_temperatures_below_absolute_zero_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("t.csv"), "time_s,temperature_c\n0,5\n10,-300\n").unwrap();
    let pane = PANE.replace("temperature_c = 5", "temperature_c = { csv = \"t.csv\" }, held = true");
    let refused = made_in(folder.path(), &pane).unwrap_err();
    assert!(refused.contains("\"pane\"") && refused.contains("-300") && refused.contains("absolute zero"), "{refused}");
}

#[test]
fn solids_may_touch() {
    let beside = PANE.replace("\"pane\"", "\"other\"").replace("[0.1, 0.05, 0.1]", "[0.105, 0.05, 0.1]");
    assert_eq!(made(&format!("{PANE}, {beside}")).unwrap().len(), 2);
}

#[test]
fn meshes_are_read_and_refused() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("letter.stl"), "Dear mesh").unwrap();
    let mesh = "{ name = \"a\", temperature_c = 5, shape = { mesh = { path = \"letter.stl\", unit = \"mm\" } } }";
    let refused = made_in(folder.path(), mesh).unwrap_err();
    assert!(refused.contains("(dew.solid.0)") && refused.contains("letter.stl: this is neither"), "{refused}");
    let corners = [[0, 0, 0], [50, 0, 0], [0, 50, 0], [0, 0, 50]].map(|[x, y, z]| format!("v {x} {y} {z}\n")).concat();
    // One face is wound the wrong way.
    std::fs::write(folder.path().join("a.obj"), corners + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 4 3\n").unwrap();
    let bodies = made_in(folder.path(), &mesh.replace("letter.stl", "a.obj")).unwrap();
    assert!((bodies[0].solid.volume() - 0.05_f64.powi(3) / 6.0).abs() < 1e-15);
    assert!(bodies[0].notes[0].contains("a.obj: 1 triangles of 4 were wound"), "{:?}", bodies[0].notes);
}

#[test]
fn a_solid_with_something_outside_reaches_there() {
    let pane = |x: f64| {
        format!(
            "{{ name = \"pane\", shape = {{ box = {{ size_m = [0.02, 0.1, 0.1] }} }}, position_m = [{x}, 0.05, 0.1], temperature_c = 5, \
             outside = {{ side = \"x_min\", temperature_c = 0, h_w_per_m2_k = 10 }} }}"
        )
    };
    assert!(made(&pane(0.01)).is_ok() && made(&pane(0.010_000_001)).is_ok());
    // By far, and by a fiftieth of a spacing, where half of the area would be missing.
    for x in [0.05, 0.0101] {
        let error = made(&pane(x)).unwrap_err();
        assert!(["pane", "dew.solid.0.outside", "x_min"].iter().all(|word| error.contains(word)), "{error}");
    }
}

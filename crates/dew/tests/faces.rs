//! Faces of solids: parts of a surface that gauges measure by themselves.

use corpuscle_dew::{Dew, open};
use corpuscle_model::{Model, Surface};
use corpuscle_scene::Scene;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// A cold ball, turned about z, and a warm ball in humid air.
const SCENE: &str = r#"
run.until_s = 1
[dew]
size_m = [0.03, 0.02, 0.02]
spacing_m = 0.002
time_factor = 20
buoyancy = false
air = { temperature_c = 25, relative_humidity = 0.9 }
drops.smallest_radius_m = 2e-4
[[dew.solid]]
name = "ball"
shape = { sphere = { radius_m = 0.0047 } }
position_m = [0.0093, 0.0101, 0.0098]
rotation_deg = [0, 0, 30]
temperature_c = 5
held = true
face = [{ name = "front", side = "x_max" }, { name = "top", side = "z_max" }]
[[dew.solid]]
name = "warm"
shape = { sphere = { radius_m = 0.004 } }
position_m = [0.0232, 0.0101, 0.0098]
temperature_c = 40
held = true
face = [{ name = "left", side = "x_min" }]
"#;

fn dew(text: &str) -> Result<Dew, String> {
    let scene = Scene::parse(text, "test.toml", &[]).map_err(|error| error.to_string())?;
    open(scene.dew().unwrap(), 7, Path::new(".")).map_err(|error| error.to_string())
}

fn gauge(dew: &Dew, header: &str) -> f64 {
    let columns = dew.gauge_columns();
    let at = columns.iter().position(|column| format!("{}.{}", column.gauge, column.quantity) == header);
    dew.gauge_row()[at.unwrap_or_else(|| panic!("{header}: {columns:?}"))]
}

/// Mean of an array of a solid's patches, by area, where the normal is nearer to the first of these directions than to all others.
fn mean(surface: &Surface, array: &str, directions: [[f64; 3]; 6]) -> f64 {
    let values = surface.scalar(array).unwrap();
    let along = |at: usize, way: [f64; 3]| (0..3).map(|axis| surface.normal[at][axis] * way[axis]).sum::<f64>();
    let is_of_it = |at: &usize| {
        let [first, others @ ..] = directions.map(|way| along(*at, way));
        let most = others.into_iter().fold(0.0, f64::max);
        assert!((first - most).abs() > 1e-9, "none of the patches is just between two");
        first > most
    };
    let (sum, area) = (0..values.len()).filter(is_of_it).fold((0.0, 0.0), |(sum, all), at| {
        let area = surface.half_width[at].powi(2);
        (sum + area * values[at], all + area)
    });
    sum / area
}

#[test]
fn faces_are_measured_by_the_solids_own_axes() {
    let mut dew = dew(SCENE).unwrap();
    dew.advance_to(0.3, &AtomicBool::new(false)).unwrap();
    let (sine, cosine) = 30_f64.to_radians().sin_cos();
    let (x, y, z) = ([cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]);
    let back = |way: [f64; 3]| way.map(|along| -along);
    for (face, directions) in
        [("front", [x, y, z, back(x), back(y), back(z)]), ("top", [z, x, y, back(x), back(y), back(z)])]
    {
        for (quantity, array) in [
            ("water_per_area", "water_kg_per_m2"),
            ("covered_part", "covered_part"),
            ("mean_temperature", "temperature_k"),
        ] {
            let found = gauge(&dew, &format!("ball.{face}.{quantity}"));
            let expected = mean(&dew.surfaces()[0], array, directions);
            assert!(expected > 0.0 && (found / expected - 1.0).abs() < 1e-12, "{face} {quantity}: {found} {expected}");
        }
    }
    let [front, whole] = ["ball.front.fogged_at", "ball.fogged_at"].map(|header| gauge(&dew, header));
    assert!(front > 0.0 && front < 0.3 && whole > 0.0 && whole < 0.3, "{front} {whole}");
    assert!(gauge(&dew, "warm.left.fogged_at").is_nan() && gauge(&dew, "warm.left.clear_at").is_nan());
    assert_eq!(gauge(&dew, "warm.left.covered_part"), 0.0);
}

/// Where the ball warms it clears; patch by patch as a whole.
#[test]
fn times_to_fog_and_to_clear_are_told_patch_by_patch() {
    let warming = SCENE.replacen("temperature_c = 5", "temperature_c = [[0, 5], [0.2, 5], [0.3, 60]]", 1);
    let mut dew = dew(&warming).unwrap();
    dew.advance_to(0.6, &AtomicBool::new(false)).unwrap();
    let surface = &dew.surfaces()[0];
    let [fogged, clear] = ["fogged_at_s", "clear_at_s"].map(|array| surface.scalar(array).unwrap());
    let is_in = |from: f64, to: f64| move |time: &f64| (from..to).contains(time);
    assert!(fogged.iter().all(is_in(0.0, 0.25)), "{fogged:?}");
    assert!(clear.iter().all(is_in(0.25, 0.6)), "{clear:?}");
    let [front, took] = ["ball.front.clear_at", "ball.front.time_to_clear"].map(|header| gauge(&dew, header));
    assert!(is_in(0.25, 0.6)(&front) && is_in(0.01, front)(&took), "{front} {took}");
}

#[test]
fn a_saved_state_has_what_was_seen_of_faces() {
    let mut first = dew(SCENE).unwrap();
    first.advance_to(0.2, &AtomicBool::new(false)).unwrap();
    let mut second = dew(SCENE).unwrap();
    second.restore(&first.save()).unwrap();
    let fogged = gauge(&first, "ball.front.fogged_at");
    assert!(fogged > 0.0 && fogged.to_bits() == gauge(&second, "ball.front.fogged_at").to_bits());
    let mut fewer = dew(&SCENE.replace(", { name = \"top\", side = \"z_max\" }", "")).unwrap();
    assert!(fewer.restore(&first.save()).is_err());
}

#[test]
fn faces_that_cannot_be_are_refused_by_name() {
    let refused = |face: &str| dew(&SCENE.replace("name = \"left\", side = \"x_min\"", face)).err().unwrap();
    let words = |message: String, words: &[&str]| {
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
    };
    words(refused("name = \"left\""), &["side"]);
    words(refused("name = \"le.ft\", side = \"x_min\""), &["dew.solid.1.face.0.name", "letters"]);
    words(refused("name = \"a\", side = \"left\""), &["left", "x_min"]);
    let twice = "name = \"a\", side = \"x_min\" }, { name = \"a\", side = \"x_max\"";
    words(refused(twice), &["dew.solid.1.face.1.name", "another face"]);
    words(
        refused(&twice.replace("\"a\", side = \"x_max\"", "\"b\", side = \"x_min\"")),
        &["face.1.side", "each side once"],
    );
    let ball = "name = \"ball\"\nshape = { sphere = { radius_m = 0.0047 } }\nposition_m = [0.0093, 0.0101, 0.0098]\nrotation_deg = [0, 0, 30]";
    let pane =
        "name = \"pane\"\nshape = { box = { size_m = [0.008, 0.008, 0.008] } }\nposition_m = [0.004, 0.0101, 0.0098]";
    assert!(SCENE.contains(ball));
    let hidden = dew(&SCENE.replace(ball, pane).replace("\"x_max\"", "\"x_min\"")).err().unwrap();
    words(hidden, &["\"front\" of the solid \"pane\"", "dew.solid.0.face.0", "x_min"]);
}

//! Dew scenes: every form reads and round-trips, and every way to be wrong is refused with its reason.

use corpuscle_scene::dew::{Face, HumidityTransport, LengthUnit, Material, Mean, Shape, Treatment};
use corpuscle_scene::*;
use std::path::Path;

/// A scene with every kind of thing in it; each test spoils one line of it.
const GOOD: &str = r##"
[run]
until_s = 60.0

[dew]
size_m = [0.2, 0.1, 0.2]
spacing_m = 0.005
scheme = "physical"
gravity_m_per_s2 = [0.0, 0.0, -9.81]
time_factor = 10.0
air = { temperature_c = 25.0, relative_humidity = 0.6 }
boundary = { treatment = "ghost", colour_threshold = 0.2 }
transport = { latent_heat = false }
drops = { contact_angle_deg = 60.0, friction = 1.3e-4 }
low_utility = { distance = 5.0, after_s = 2.0 }
output = { air = false }

[dew.faces]
x_min = { inflow = { velocity_m_per_s = [0.1, 0.0, 0.0], dew_point_c = 15.0 } }
x_max = "outflow"
y_min = "periodic"
y_max = "periodic"
z_max = "open"

[[dew.solid]]
name = "pane"
shape = { box = { size_m = [0.004, 0.1, 0.1] } }
position_m = [0.1, 0.05, 0.1]
temperature_c = [[0.0, 5.0], [30.0, 5.0], [60.0, 25.0]]
held = true

[[dew.solid]]
name = "glass"
shape = { wine-glass = { height_m = 0.15 } }
rotation_deg = [0.0, 0.0, 90.0]
temperature_c = 5.0
layers = 3

[[dew.solid]]
name = "bolt"
shape = { mesh = { path = "bolt.stl", unit = "mm" } }
material = { conductivity_w_per_m_k = 60.0, heat_capacity_j_per_kg_k = 430.0, density_kg_per_m3 = 7850.0 }
temperature_c = 5.0

[[dew.solid]]
name = "ring"
shape = { revolution = { profile_m = [[0.02, 0.0], [0.03, 0.0], [0.025, 0.01]] } }
material = "copper"
temperature_c = 4.0
"##;

fn parse(text: &str) -> Scene {
    Scene::parse(text, "test.toml", &[]).unwrap()
}

fn refuse(text: &str) -> String {
    match Scene::parse(text, "test.toml", &[]) {
        Ok(scene) => panic!("accepted:\n{text}\n{scene:?}"),
        Err(error) => error.to_string(),
    }
}

/// Replaces one line by another and asserts that the message has the line's number and holds all the words.
fn assert_refused(line: &str, by: &str, words: &[&str]) {
    let number = 1 + GOOD.lines().position(|found| found == line).unwrap_or_else(|| panic!("no line {line}"));
    let message = refuse(&GOOD.replacen(&format!("\n{line}\n"), &format!("\n{by}\n"), 1));
    for word in words.iter().copied().chain([format!("test.toml:{number}:").as_str()]) {
        assert!(message.contains(word), "{by}: {word:?} is not in:\n{message}");
    }
}

#[test]
fn every_form_reads_and_round_trips_with_its_defaults() {
    let mut scene = parse(GOOD);
    assert_eq!(parse(&scene.to_toml().unwrap()), scene);
    scene.resolve_defaults();
    let written = scene.to_toml().unwrap();
    assert_eq!(parse(&written), scene);
    let dew = scene.dew().unwrap();
    assert_eq!(dew.boundary.treatment, Treatment::Ghost);
    assert_eq!(dew.transport.conductivity_mean, Some(Mean::Harmonic));
    assert_eq!(
        (dew.transport.humidity, dew.transport.latent_heat),
        (Some(HumidityTransport::MassFraction), Some(false))
    );
    assert_eq!(dew.faces.along(Axis::Z), [&Face::Wall, &Face::Open]);
    assert!(matches!(dew.faces.x_min, Face::Inflow(_)));
    assert_eq!(dew.solid[0].material, Material::Named("glass".into()));
    assert!(matches!(&dew.solid[2].shape, Shape::Mesh(mesh) if mesh.unit == Some(LengthUnit::Mm)));
    assert!(scene.flood().is_none() && scene.gas().is_none());
    for key in ["colour_threshold", "pressure_pa", "sites_per_m2", "foot_radius_m", "latent_heat", "rotation_deg"] {
        assert!(written.contains(&format!("{key} = ")), "{key}:\n{written}");
    }
}

#[test]
fn scheme_particle_condensation_fills_in_what_was_patented() {
    let mut scene = parse(
        &GOOD.replace("\"physical\"", "\"particle-condensation\"").replace("transport = { latent_heat = false }\n", ""),
    );
    scene.resolve_defaults();
    let transport = &scene.dew().unwrap().transport;
    assert_eq!(transport.conductivity_mean, Some(Mean::Arithmetic));
    assert_eq!(transport.humidity, Some(HumidityTransport::RelativeHumidity));
    assert_eq!(transport.latent_heat, Some(false));
}

#[test]
fn paths_become_absolute() {
    let mut scene = parse(&GOOD.replace("[[0.0, 5.0], [30.0, 5.0], [60.0, 25.0]]", "{ csv = \"pane.csv\" }"));
    scene.resolve_paths(Path::new("/data"));
    let solids = &scene.dew().unwrap().solid;
    assert_eq!(solids[0].temperature_c, Series::File { csv: "/data/pane.csv".into(), factor: 1.0 });
    assert!(matches!(&solids[2].shape, Shape::Mesh(mesh) if mesh.path == Path::new("/data/bolt.stl")));
}

#[test]
fn the_box_and_the_air() {
    let air = "air = { temperature_c = 25.0, relative_humidity = 0.6 }";
    let with = |air: &str| format!("air = {{ {air} }}");
    assert_refused("size_m = [0.2, 0.1, 0.2]", "size_m = [0.2, 0.1]", &["dew.size_m", "three numbers"]);
    assert_refused("size_m = [0.2, 0.1, 0.2]", "size_m = [0.2, 0.1, 0]", &["dew.size_m.2", "larger than 0"]);
    assert_refused("spacing_m = 0.005", "spacing_m = 0.15", &["dew.spacing_m = 0.15", "wider than the box"]);
    assert_refused("spacing_m = 0.005", "spacing_m = 1e-5", &["dew.spacing_m", "4.0e12 particles of air"]);
    assert_refused("time_factor = 10.0", "time_factor = 0.5", &["dew.time_factor", "at least 1"]);
    assert_refused(air, &with("temperature_c = -300, relative_humidity = 0.5"), &["below absolute zero", "not in K"]);
    assert_refused(air, &with("temperature_c = 298, relative_humidity = 0.5"), &["dew.air.temperature_c", "to 100"]);
    assert_refused(air, &with("temperature_c = 25, relative_humidity = 60"), &["60", "from 0 to 1", "percent"]);
    assert_refused(air, &with("temperature_c = 25, relative_humidity = -0.1"), &["= -0.1", "from 0 to 1"]);
    assert_refused(air, &with("temperature_c = 25, dew_point_c = 26"), &["dew.air.dew_point_c", "fog already"]);
    for name in ["wine glass", "air"] {
        let text = GOOD.replace("name = \"glass\"", "name = \"wine_glass\"");
        let text = text.replace("name = \"ring\"", &format!("name = \"{name}\""));
        let told = refuse(&text);
        assert!(told.contains(".name") && (told.contains("spaces as `_`") || told.contains("other gauges")), "{told}");
    }
    assert_refused(air, &with("temperature_c = 25, mixing_ratio = 10"), &["dew.air.mixing_ratio", "kg of dry air"]);
    assert_refused(air, &with("temperature_c = 25"), &["dew.air", "exactly one of relative_humidity, dew_point_c"]);
    let two = with("temperature_c = 25, relative_humidity = 0.5, dew_point_c = 10");
    assert_refused(air, &two, &["not relative_humidity and dew_point_c together"]);
    let missing = refuse(&GOOD.replace(&format!("{air}\n"), ""));
    assert!(missing.contains("dew.air is missing: give the air, as in air = {"), "{missing}");
}

#[test]
fn faces() {
    let alone = refuse(&GOOD.replace("y_min = \"periodic\"\n", ""));
    assert!(alone.contains("dew.faces.y_max") && alone.contains("give y_min = \"periodic\""), "{alone}");
    let inflow = "x_min = { inflow = { velocity_m_per_s = [0.1, 0.0, 0.0], dew_point_c = 15.0 } }";
    let out = "x_min = { inflow = { velocity_m_per_s = [-0.1, 0.0, 0.0] } }";
    assert_refused(inflow, out, &["dew.faces.x_min.inflow.velocity_m_per_s", "into the box"]);
    let humid = "x_min = { inflow = { velocity_m_per_s = [0.1, 0.0, 0.0], dew_point_c = 30.0 } }";
    assert_refused(inflow, humid, &["dew.faces.x_min.inflow.dew_point_c", "fog already"]);
    assert_refused("x_max = \"outflow\"", "x_max = \"outflw\"", &["did you mean `outflow`"]);
}

#[test]
fn drops_transport_and_low_utility() {
    let drops = "drops = { contact_angle_deg = 60.0, friction = 1.3e-4 }";
    assert_refused(drops, "drops = { contact_angle_deg = 180 }", &["contact_angle_deg = 180", "between 0 and 180"]);
    assert_refused(drops, "drops = { friction = -1 }", &["dew.drops.friction", "at least 0"]);
    let transport = "transport = { latent_heat = false }";
    assert_refused(transport, "transport = { conductivity_mean = \"mean\" }", &["harmonic", "arithmetic"]);
    assert_refused(transport, "transport = { vapour_diffusivity_m2_per_s = 0 }", &["larger than 0"]);
    assert_refused(
        "low_utility = { distance = 5.0, after_s = 2.0 }",
        "low_utility = { distance = 0 }",
        &["at least 1"],
    );
}

#[test]
fn solids() {
    assert_refused("name = \"glass\"", "name = \"pane\"", &["dew.solid.1.name", "another solid"]);
    let pane = "shape = { box = { size_m = [0.004, 0.1, 0.1] } }";
    assert_refused(pane, "shape = { box = { size_m = [0.0, 0.1, 0.1] } }", &["dew.solid.0.shape.box.size_m.0"]);
    assert_refused(pane, "shape = { spere = { radius_m = 0.1 } }", &["did you mean `sphere`"]);
    assert_refused(pane, "shape = { sphere = { radius_m = -1 } }", &["dew.solid.0.shape.sphere.radius_m"]);
    let bolt = "shape = { mesh = { path = \"bolt.stl\", unit = \"mm\" } }";
    assert_refused(bolt, "shape = { mesh = { path = \"bolt.stl\" } }", &["mesh.unit is missing", "\"mm\""]);
    let glb = "shape = { mesh = { path = \"bolt.glb\", unit = \"mm\" } }";
    assert_refused(bolt, glb, &["dew.solid.2.shape.mesh.unit", "glTF is in metres"]);
    assert_refused("material = \"copper\"", "material = 5", &["dew.solid.3.material", "the name of a material"]);
    let ring = "shape = { revolution = { profile_m = [[0.02, 0.0], [0.03, 0.0], [0.025, 0.01]] } }";
    let beyond = "shape = { revolution = { profile_m = [[-0.02, 0.0], [0.03, 0.0], [0.025, 0.01]] } }";
    assert_refused(ring, beyond, &["dew.solid.3.shape.revolution.profile_m.0", "beyond the axis"]);
    assert_refused("temperature_c = 4.0", "temperature_c = -280.0", &["dew.solid.3.temperature_c", "absolute zero"]);
    assert_refused("temperature_c = 4.0", "temperature_c = 2000.0", &["at most 1000", "radiates"]);
    assert_refused("temperature_c = 4.0", "temperature_c = [[0.0, 4.0], [9.0, 5.0]]", &["held = true"]);
    assert_refused("layers = 3", "layers = 0", &["dew.solid.1.layers = 0", "leave it out"]);
}

#[test]
fn a_scene_has_one_model() {
    let both = refuse(&format!("{GOOD}\n[gas]\nsize = [1, 1]"));
    assert!(both.contains("take out [gas], or [dew]"), "{both}");
    let flood = refuse(&format!("{GOOD}\n[flood]"));
    assert!(flood.contains("take out [flood], or [dew]"), "{flood}");
    let ground = refuse(&format!("{GOOD}\n[terrain.plane]"));
    assert!(ground.contains("take out [terrain], or [dew]"), "{ground}");
}

#[test]
fn what_holds_drops_is_told_once_and_in_order() {
    let drops = "drops = { contact_angle_deg = 60.0, friction = 1.3e-4 }";
    for (with, key) in [
        ("drops = { contact_angle_deg = 60, receding_angle_deg = 61 }", "receding_angle_deg = 61"),
        ("drops = { contact_angle_deg = 60, receding_angle_deg = 0 }", "receding_angle_deg = 0"),
        ("drops = { contact_angle_deg = 60, advancing_angle_deg = 59 }", "advancing_angle_deg = 59"),
        ("drops = { contact_angle_deg = 60, advancing_angle_deg = 180 }", "advancing_angle_deg = 180"),
        ("drops = { friction = 1e-4, advancing_angle_deg = 120 }", "leave one out"),
        ("drops = { viscosity_pa_s = -1 }", "viscosity_pa_s = -1"),
    ] {
        assert_refused(drops, with, &["dew.drops.", key]);
    }
}

#[test]
fn angles_that_are_left_out_are_about_the_contact_angle() {
    for contact_angle_deg in [1.0, 60.0, 90.0, 179.0] {
        let [receding, advancing] =
            corpuscle_scene::dew::Drops { contact_angle_deg, ..Default::default() }.angles_deg();
        assert!(0.0 < receding && receding < contact_angle_deg && contact_angle_deg < advancing && advancing < 180.0);
    }
}

#[test]
fn pressures_are_in_pascals() {
    let air = "air = { temperature_c = 25.0, relative_humidity = 0.6 }";
    let in_hpa = "air = { temperature_c = 25.0, relative_humidity = 0.6, pressure_pa = 1013 }";
    assert_refused(air, in_hpa, &["dew.air.pressure_pa = 1013", "hPa"]);
}

#[test]
fn sources_of_heat_that_cannot_be_are_refused_by_name() {
    let copper = "material = \"copper\"";
    let with = |source: &str, words: &[&str]| assert_refused(copper, source, words);
    let key = |name: &str| format!("dew.solid.3.{name}");
    with("heater = {}", &[&key("heater"), "exactly one of power_w, power_w_per_m2"]);
    with("heater = { power_w = -2 }", &[&key("heater.power_w = -2"), "at least 0"]);
    with("heater = { power_w_per_m2 = [[0, 1], [2, -1]] }", &[&key("heater.power_w_per_m2.1"), "at least 0"]);
    with("radiation = { emissivity = 1.2, surroundings_c = 20 }", &[&key("radiation.emissivity = 1.2"), "from 0 to 1"]);
    with(
        "radiation = { emissivity = 0.9, surroundings_c = -300 }",
        &[&key("radiation.surroundings_c"), "absolute zero"],
    );
    with(
        "outside = { side = \"z_min\", temperature_c = 5, h_w_per_m2_k = -1 }",
        &[&key("outside.h_w_per_m2_k = -1"), "at least 0"],
    );
    with(
        "outside = { side = \"z_max\", temperature_c = 5, h_w_per_m2_k = 1 }",
        &[&key("outside.side"), "is no wall", "faces.z_max"],
    );
    let layer = |layer: &str, words: &[&str]| {
        let key = key("outside.layers.1");
        let words: Vec<String> = words.iter().map(|word| word.replace("KEY", &key)).collect();
        let wall = format!(
            "outside = {{ side = \"z_min\", temperature_c = 5, h_w_per_m2_k = 1, layers = [{{ resistance_m2_k_per_w = 0.17 }}, {layer}] }}"
        );
        with(&wall, &words.iter().map(String::as_str).collect::<Vec<_>>());
    };
    layer("{ material = \"glass\" }", &["KEY", "thickness_m"]);
    layer("{ thickness_m = 0.004 }", &["KEY", "material"]);
    layer("{}", &["KEY", "resistance_m2_k_per_w"]);
    layer("{ material = \"glass\", thickness_m = 0.004, resistance_m2_k_per_w = 1 }", &["KEY", "either"]);
    layer("{ material = \"glass\", thickness_m = -0.004 }", &["KEY.thickness_m = -0.004", "larger than 0"]);
    layer("{ resistance_m2_k_per_w = 0 }", &["KEY.resistance_m2_k_per_w = 0", "larger than 0"]);
    layer(
        "{ material = { conductivity_w_per_m_k = 0, heat_capacity_j_per_kg_k = 1, density_kg_per_m3 = 1 }, thickness_m = 1 }",
        &["KEY.material.conductivity_w_per_m_k = 0"],
    );
    let held = "heater = { power_w = 1 }\nheld = true";
    assert_refused("held = true", held, &["dew.solid.0.heater", "prescribed"]);
    with("outside = { side = \"left\", temperature_c = 5, h_w_per_m2_k = 1 }", &["left", "x_min"]);
}

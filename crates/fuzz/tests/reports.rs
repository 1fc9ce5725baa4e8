//! Reports show what scenes say as text, whatever it is, and load nothing.

use corpuscle::{Recorder, Simulation};
use corpuscle_output::FrameFormat;
use corpuscle_scene::Scene;
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

const SCRIPT: &str = "<script>alert(1)</script>";
const PICTURE: &str = "\\\"><img src=x onerror=alert(2)>";
const STYLE: &str = "'}</style><link rel=stylesheet href=//example.org>&";

const GAS: &str = "title = \"SCRIPT\"\ndescription = \"PICTURE STYLE\"\nrun = { until_s = 0.5, frame_every_s = 0.25, gauge_every_s = 0.1 }\n\
    [gas]\nsize = [20.0, 20.0]\nfollow = 0\nball = [{ name = \"heavy\", position = [10.0, 10.0], radius = 2.0, mass = 8.0 }]\n\
    species = [{ name = \"light\", count = 9, radius = 0.5, mass = 1.0, temperature = 1.0 }]\n\
    measure = { region = [{ name = \"SCRIPT\", from = [1.0, 1.0], to = [9.0, 9.0] }] }\n";

const FLOOD: &str = "title = \"SCRIPT\"\ndescription = \"PICTURE STYLE\"\nrun = { until_s = 0.5, frame_every_s = 0.25, gauge_every_s = 0.1 }\n\
    terrain.bump = { extent = { length_m = 40.0, width_m = 40.0, cell_m = 2.0 }, height_m = 1.0, width_m = 5.0 }\n\
    [flood]\nspacing_m = 5.0\nwater = [{ level_m = 0.8 }]\ngauge = [{ name = \"mill\", at = [3.0, 3.0] }]\n\
    section = [{ name = \"bridge\", line = [[0.0, 5.0], [40.0, 5.0]] }]\n";

const DEW: &str = "title = \"SCRIPT\"\ndescription = \"PICTURE STYLE\"\nrun = { until_s = 0.01, frame_every_s = 0.005, gauge_every_s = 0.002 }\n\
    [dew]\nsize_m = [0.03, 0.02, 0.02]\nspacing_m = 0.005\nair = { temperature_c = 25.0, relative_humidity = 0.9 }\ndrops = { sites_per_m2 = 1e6 }\n\
    solid = [{ name = \"pane\", shape = { box = { size_m = [0.005, 0.02, 0.02] } }, position_m = [0.0025, 0.01, 0.01], temperature_c = 5.0, held = true }]\n";

/// Runs a scene of which names and words are made to break out of a page; its report.
fn report(scene: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let text = scene.replace("SCRIPT", SCRIPT).replace("PICTURE", PICTURE).replace("STYLE", STYLE);
    let scene = Scene::parse(&text, "scene.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::open(scene, Path::new("")).unwrap_or_else(|error| panic!("{error}"));
    let path = folder.path().join("a <b>run</b>");
    let mut recorder = Recorder::create(&path, &simulation, FrameFormat::Csv).unwrap();
    simulation.run(&mut [&mut recorder], &AtomicBool::new(false), &mut |_| {}).unwrap();
    fs::read_to_string(path.join("report.html")).unwrap()
}

/// The tags of a page, each from its name to its end.
fn tags(page: &str) -> Vec<&str> {
    let mut tags = Vec::new();
    let mut rest = page;
    while let Some(at) = rest.find('<') {
        rest = &rest[at + 1..];
        tags.push(&rest[..rest.find('>').unwrap_or(rest.len())]);
    }
    tags
}

fn assert_harmless(page: &str) {
    assert!(page.contains("&lt;script&gt;alert(1)&lt;/script&gt;"), "the title is not shown as it is");
    for word in ["@import", "url(", "<script", "<link", "<iframe", "<object", "<embed", "<base", "<b>run"] {
        assert!(!page.contains(word), "`{word}` is in the page");
    }
    for tag in tags(page) {
        for attribute in ["href=", "src=", "srcset=", "action="] {
            let Some(at) = tag.find(&format!(" {attribute}")) else { continue };
            let address = tag[at + 1 + attribute.len()..].trim_start_matches(['"', '\'']);
            assert!(
                address.starts_with('#') || address.starts_with("data:image/"),
                "`{}` is loaded",
                &tag[..tag.len().min(200)]
            );
        }
        // Values in quotes may have any text, which is escaped.
        let outside: String = tag.split('"').step_by(2).collect();
        assert!(!outside.contains(" on"), "`{}` runs a script", &tag[..tag.len().min(200)]);
    }
}

#[test]
fn a_report_of_a_gas_shows_hostile_names_as_text() {
    assert_harmless(&report(GAS));
}

#[test]
fn a_report_of_a_flood_shows_hostile_names_as_text() {
    assert_harmless(&report(FLOOD));
}

#[test]
fn a_report_of_dew_shows_hostile_names_as_text() {
    assert_harmless(&report(DEW));
}

#[test]
fn what_would_be_loaded_or_run_is_noticed() {
    let sound = "<p>&lt;script&gt;alert(1)&lt;/script&gt;</p><a href=\"#top\">";
    assert_harmless(sound);
    for bad in [
        "<img src=x>",
        "<a href=\"https://example.org\">",
        "<p onclick=alert(1)>",
        "<script>",
        "<style>a{b:url(x)}</style>",
    ] {
        let page = format!("{sound}{bad}");
        assert!(std::panic::catch_unwind(|| assert_harmless(&page)).is_err(), "{bad}");
    }
}

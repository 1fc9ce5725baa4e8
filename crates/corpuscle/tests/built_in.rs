//! The built-in scenes open, and their places are where their comments say.

use corpuscle::Simulation;
use corpuscle::scene::{BUILTIN, FloodScene, Scene, Terrain, builtin};
use corpuscle::terrain::valley_centre;
use std::path::Path;

/// A thousandth of the million balls: the same in a blink.
fn smaller(name: &str) -> Vec<(String, String)> {
    let changes: &[(&str, &str)] = match name {
        "gas/million" => &[("gas.species.0.count", "1000"), ("gas.size", "[12.04, 12.04, 12.04]")],
        _ => &[],
    };
    changes.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect()
}

#[test]
fn every_built_in_scene_opens_and_its_written_form_opens_alike() {
    for builtin in BUILTIN {
        let scene = Scene::parse(builtin.text, builtin.name, &smaller(builtin.name)).unwrap();
        let simulation = Simulation::open(scene, Path::new("")).unwrap();
        let written = simulation.scene().to_toml().unwrap();
        let again = Simulation::open(Scene::parse(&written, "scene.toml", &[]).unwrap(), Path::new("/")).unwrap();
        assert_eq!(again.scene(), simulation.scene());
        assert_eq!(again.model().frame(), simulation.model().frame());
        let default = if simulation.scene().gas().is_some() { "pair_distance" } else { "spacing_depth_m" };
        assert!(written.contains(default), "{written}");
    }
}

#[test]
fn the_valleys_gauges_and_inflow_are_in_the_channel() {
    let scene = Scene::parse(builtin("flood/valley").unwrap().text, "flood/valley", &[]).unwrap();
    let FloodScene { terrain, flood } = scene.flood().unwrap();
    let Terrain::Valley(valley) = terrain else { panic!("{terrain:?}") };
    let gauges = flood.gauge.iter().map(|gauge| gauge.at.unwrap());
    // The inflow's line goes across the channel, from bank to bank.
    let ends = flood.inflow[0].line.clone().unwrap();
    let middle = [0, 1].map(|axis| 0.5 * (ends[0][axis] + ends[1][axis]));
    for [x, y] in gauges.chain([middle]) {
        let centre = valley_centre(valley, scene.seed, x);
        assert!(
            (y - centre).abs() < 0.5 * valley.channel_width_m,
            "at x = {x} the channel's middle is at y = {centre}"
        );
    }
}

#[test]
fn the_rough_terrain_has_the_papers_12000_particles() {
    let scene = Scene::parse(builtin("flood/rough-terrain").unwrap().text, "flood/rough-terrain", &[]).unwrap();
    assert_eq!(Simulation::open(scene, Path::new("")).unwrap().model().particles(), 12_000);
}

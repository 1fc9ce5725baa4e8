//! The built-in scenes open, and their places are where their comments say.

use corpuscle::Simulation;
use corpuscle::scene::{BUILTIN, FloodScene, Scene, Terrain, builtin};
use corpuscle::terrain::valley_centre;
use std::path::Path;

#[test]
fn every_built_in_scene_opens_and_its_written_form_opens_alike() {
    for builtin in BUILTIN {
        let scene = Scene::parse(builtin.text, builtin.name, &[]).unwrap();
        let simulation = Simulation::open(scene, Path::new("")).unwrap();
        let written = simulation.scene().to_toml().unwrap();
        let again = Simulation::open(Scene::parse(&written, "scene.toml", &[]).unwrap(), Path::new("/")).unwrap();
        assert_eq!(again.scene(), simulation.scene());
        assert_eq!(again.model().frame(), simulation.model().frame());
        assert!(written.contains("spacing_depth_m"), "{written}");
    }
}

#[test]
fn the_valleys_gauges_and_inflow_are_in_the_channel() {
    let scene = Scene::parse(builtin("flood/valley").unwrap().text, "flood/valley", &[]).unwrap();
    let FloodScene { terrain, flood } = scene.flood().unwrap();
    let Terrain::Valley(valley) = terrain else { panic!("{terrain:?}") };
    let gauges = flood.gauge.iter().map(|gauge| gauge.at.unwrap());
    let ends = flood.inflow[0].line.clone().unwrap();
    for [x, y] in gauges.chain(ends) {
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

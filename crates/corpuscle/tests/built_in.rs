//! The built-in scenes open, and their positions are where their comments say.

use corpuscle::Simulation;
use corpuscle::scene::{FloodScene, Scene, Terrain, builtin, scenes};
use corpuscle::terrain::valley_centre;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// A thousandth of the million balls, glasses of coarser particles: the same in a blink.
fn smaller(name: &str) -> Vec<(String, String)> {
    let changes: &[(&str, &str)] = match name {
        "gas/million" => &[("gas.species.0.count", "1000"), ("gas.size", "[12.04, 12.04, 12.04]")],
        "dew/glassware" => &[("dew.spacing_m", "0.008")],
        _ => &[],
    };
    changes.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect()
}

/// False for a scene whose terrain comes over the network: `cli/tests/terrain.rs` runs those, from a stand-in.
fn is_at_hand(scene: &Scene) -> bool {
    !matches!(scene.flood(), Some(FloodScene { terrain: Terrain::Fetch(_), .. }))
}

#[test]
fn every_built_in_scene_opens_and_its_written_form_opens_alike() {
    for builtin in scenes() {
        let scene = Scene::parse(builtin.text, builtin.name, &smaller(builtin.name)).unwrap();
        if !is_at_hand(&scene) {
            continue;
        }
        let simulation = Simulation::open(scene, Path::new("")).unwrap();
        let written = simulation.scene().to_toml().unwrap();
        let again = Simulation::open(Scene::parse(&written, "scene.toml", &[]).unwrap(), Path::new("/")).unwrap();
        assert_eq!(again.scene(), simulation.scene());
        assert_eq!(again.model().frame(), simulation.model().frame());
        let default = match simulation.model().name() {
            "gas" => "pair_distance",
            "dew" => "colour_threshold",
            _ => "map_every_s",
        };
        assert!(written.contains(default), "{written}");
    }
}

#[test]
fn every_dew_scene_fogs_and_keeps_its_water_and_energy() {
    for builtin in scenes().filter(|scene| scene.name.starts_with("dew/")) {
        let scene = Scene::parse(builtin.text, builtin.name, &smaller(builtin.name)).unwrap();
        let mut simulation = Simulation::open(scene, Path::new("")).unwrap();
        // Breath takes a while to the pane; other air is there from the start.
        let part = if builtin.name == "dew/breath" { 0.08 } else { 0.01 };
        let until = part * simulation.scene().run.until_s;
        let model = simulation.model_mut();
        model.advance_to(until, &AtomicBool::new(false)).unwrap();
        let columns = model.gauge_columns();
        let at = columns.iter().position(|column| column.header() == "water.on_solids_kg").unwrap();
        assert!(model.gauge_row()[at] > 0.0, "{}", builtin.name);
        for balance in model.ledger().balances {
            assert!(balance.relative_error().abs() < 1e-10, "{}: {balance:?}", builtin.name);
        }
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

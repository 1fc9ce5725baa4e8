//! Layers of the wall between a solid and the air outside.

mod common;

use common::{advance, gauge};
use corpuscle_dew::Dew;
use corpuscle_dew::humid_air::ZERO_CELSIUS;
use corpuscle_model::{Model, ModelError};
use corpuscle_scene::Scene;
use std::path::Path;

/// A pane in a side of a box of air as warm as it, with layers behind it.
fn made(layers: &str) -> Result<Dew, ModelError> {
    let behind = if layers.is_empty() { String::new() } else { format!(", layers = [{layers}]") };
    let text = format!(
        "run.until_s = 1\n[dew]\nsize_m = [0.016, 0.012, 0.012]\nspacing_m = 0.002\nbuoyancy = false\n\
         air = {{ temperature_c = 20, relative_humidity = 0.3 }}\ndrops.smallest_radius_m = 5e-4\n[[dew.solid]]\nname = \"pane\"\n\
         shape = {{ box = {{ size_m = [0.006, 0.012, 0.012] }} }}\nposition_m = [0.003, 0.006, 0.006]\ntemperature_c = 20\n\
         outside = {{ side = \"x_min\", temperature_c = 0, h_w_per_m2_k = 25{behind} }}\n"
    );
    let scene = Scene::parse(&text, "test", &[]).unwrap();
    corpuscle_dew::open(scene.dew().unwrap(), 1, Path::new(""))
}

const AREA: f64 = 0.012 * 0.012;

/// A second pane behind a gap with air, and a coat of insulation.
const DOUBLE: &str = "{ resistance_m2_k_per_w = 0.17 }, { material = \"glass\", thickness_m = 0.004 }, \
                      { material = { conductivity_w_per_m_k = 0.04, heat_capacity_j_per_kg_k = 1000, density_kg_per_m3 = 50 }, thickness_m = 0.01 }";

#[test]
fn heat_goes_through_a_wall_as_if_it_had_done_so_for_long() {
    let mut dew = made(DOUBLE).unwrap();
    let headers: Vec<String> = dew.gauge_columns().iter().map(|column| column.header()).collect();
    let of_layers: Vec<&String> = headers.iter().filter(|header| header.contains("pane.outside")).collect();
    assert_eq!(of_layers, ["pane.outside.1.mean_temperature_K", "pane.outside.2.mean_temperature_K"]);
    let glass = corpuscle_solids::material("glass").unwrap().conductivity;
    // From the middles of the pane's outermost particles to the air outside.
    let resistance = 0.001 / glass + 0.17 + 0.004 / glass + 0.01 / 0.04 + 1.0 / 25.0;
    let flux = 20.0 / resistance;
    let coat = flux * (0.005 / 0.04 + 1.0 / 25.0) + ZERO_CELSIUS;
    assert!((gauge(&dew, "pane.outside.2.mean_temperature_K") - coat).abs() < 1e-9);
    advance(&mut dew, 0.2);
    let lost = -gauge(&dew, "pane.heat_from_outside_J") / (AREA * dew.stepped_until());
    assert!((lost / flux - 1.0).abs() < 1e-3, "{lost} W/m2 for {flux}");
    assert!((gauge(&dew, "pane.outside.2.mean_temperature_K") - coat).abs() < 1e-3);
    assert!(dew.ledger().balances.iter().all(|balance| balance.relative_error().abs() < 1e-12));
}

#[test]
fn a_wall_of_gaps_resists_as_one_of_a_layer_that_holds_next_to_no_heat() {
    let lost = |layers: &str| {
        let mut dew = made(layers).unwrap();
        advance(&mut dew, 0.3);
        -gauge(&dew, "pane.heat_from_outside_J")
    };
    let [none, gap] = [lost(""), lost("{ resistance_m2_k_per_w = 0.1 }, { resistance_m2_k_per_w = 0.07 }")];
    let light = lost(
        "{ material = { conductivity_w_per_m_k = 0.05, heat_capacity_j_per_kg_k = 100, density_kg_per_m3 = 1 }, thickness_m = 0.0085 }",
    );
    assert!((light / gap - 1.0).abs() < 1e-4 && gap < 0.25 * none, "{none} {gap} {light}");
}

#[test]
fn a_foil_does_not_shorten_the_step() {
    let foil = "{ material = \"aluminium\", thickness_m = 2e-5 }, ";
    let steps = |layers: &str| {
        let mut dew = made(layers).unwrap();
        advance(&mut dew, 0.2);
        dew.steps()
    };
    assert_eq!(steps(&format!("{foil}{DOUBLE}, {foil}")), steps(DOUBLE));
}

#[test]
fn a_run_with_a_wall_goes_on_from_its_checkpoint() {
    let mut whole = made(DOUBLE).unwrap();
    advance(&mut whole, 0.1);
    let saved = whole.save();
    advance(&mut whole, 0.2);
    let mut resumed = made(DOUBLE).unwrap();
    resumed.restore(&saved).unwrap();
    advance(&mut resumed, 0.2);
    assert_eq!(whole.save(), resumed.save());
    let other = made("").unwrap().restore(&saved).unwrap_err().to_string();
    assert!(other.contains("another scene"), "{other}");
}

#[test]
fn water_on_a_pane_that_has_become_colder_than_ice_is_told() {
    let frosts = |outside: f64| {
        let text = format!(
            "run.until_s = 1\n[dew]\nsize_m = [0.016, 0.012, 0.012]\nspacing_m = 0.002\nbuoyancy = false\ntime_factor = 200\n\
             air = {{ temperature_c = 20, relative_humidity = 0.9 }}\ndrops.smallest_radius_m = 5e-5\n[dew.faces]\nx_max = \"open\"\n[[dew.solid]]\n\
             name = \"pane\"\nshape = {{ box = {{ size_m = [0.006, 0.012, 0.012] }} }}\nposition_m = [0.003, 0.006, 0.006]\ntemperature_c = 5\n\
             outside = {{ side = \"x_min\", temperature_c = {outside}, h_w_per_m2_k = 500 }}\n"
        );
        let scene = Scene::parse(&text, "test", &[]).unwrap();
        let mut dew = corpuscle_dew::open(scene.dew().unwrap(), 1, Path::new("")).unwrap();
        let is_told = |dew: &Dew| {
            dew.warnings().iter().any(|warning| warning.contains("\"pane\"") && warning.contains("below 0 °C"))
        };
        assert!(!is_told(&dew), "{:?}", dew.warnings());
        advance(&mut dew, 0.5);
        is_told(&dew)
    };
    assert!(frosts(-30.0) && !frosts(3.0));
}

/// A spike that touches the side with its tip: nothing of it lies in the side, and its wall has no cells.
#[test]
fn a_wall_of_no_area_does_nothing() {
    let text = "run.until_s = 1\n[dew]\nsize_m = [0.016, 0.012, 0.012]\nspacing_m = 0.002\nair = { temperature_c = 20, relative_humidity = 0.3 }\n\
                drops.smallest_radius_m = 5e-4\n[[dew.solid]]\nname = \"spike\"\n\
                shape = { revolution = { profile_m = [[0, 0], [0.0004, 0.003], [0.003, 0.004], [0.003, 0.008], [0, 0.008]] } }\n\
                position_m = [0.006, 0.006, 0]\ntemperature_c = 20\n\
                outside = { side = \"z_min\", temperature_c = 0, h_w_per_m2_k = 25, layers = [{ material = \"glass\", thickness_m = 0.004 }] }\n";
    let scene = Scene::parse(text, "test", &[]).unwrap();
    let mut dew = corpuscle_dew::open(scene.dew().unwrap(), 1, Path::new("")).unwrap();
    advance(&mut dew, 0.05);
    assert_eq!(dew.heat_supplied(0), [0.0; 3]);
    assert_eq!(dew.gauge_columns().len(), dew.gauge_row().len());
}

#[test]
fn a_material_of_a_layer_that_is_not_known_is_named() {
    let error = made(&DOUBLE.replace("\"glass\"", "\"glas\"")).err().unwrap().to_string();
    assert!(
        ["pane", "dew.solid.0.outside.layers.1", "glas", "polycarbonate"].iter().all(|word| error.contains(word)),
        "{error}"
    );
}

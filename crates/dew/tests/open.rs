//! From a scene to drops: water and energy are kept, what is saved goes on to the same bits, and what cannot be is refused.

mod common;

use common::{advance, gauge};
use corpuscle_dew::air::Role;
use corpuscle_dew::humid_air::HumidAir;
use corpuscle_dew::{Dew, LiveChange, open};
use corpuscle_model::{Model, Values};
use corpuscle_scene::Scene;
use std::path::Path;

/// A small pane at 5 °C over which humid air flows down, time going 100 times faster.
const PANE: &str = r#"
run.until_s = 1
[dew]
size_m = [0.010, 0.012, 0.016]
spacing_m = 0.002
time_factor = 100
air = { temperature_c = 25, relative_humidity = 0.8 }
drops = { smallest_radius_m = 1e-5, sites_per_m2 = 1e8, friction = 1e-7, viscosity_pa_s = 0 }
[dew.faces]
y_min = "periodic"
y_max = "periodic"
z_max = { inflow = { velocity_m_per_s = [0, 0, -0.05] } }
z_min = "outflow"
[[dew.solid]]
name = "pane"
shape = { box = { size_m = [0.004, 0.012, 0.012] } }
position_m = [0.002, 0.006, 0.006]
temperature_c = 5
held = true
"#;

fn parsed(text: &str) -> corpuscle_scene::Dew {
    Scene::parse(text, "test", &[]).unwrap().dew().unwrap().clone()
}

fn dew(text: &str) -> Dew {
    open(&parsed(text), 1, Path::new("")).unwrap()
}

fn refused(text: &str) -> String {
    open(&parsed(text), 1, Path::new("")).err().expect("refused").to_string()
}

#[test]
fn drops_form_and_run_off_and_no_water_is_lost() {
    let mut dew = dew(PANE);
    advance(&mut dew, 0.15);
    assert!(gauge(&dew, "drops.number") > 10.0 && gauge(&dew, "drops.left_kg") > 0.0);
    assert!(gauge(&dew, "drops.first_at_s") > 0.0 && gauge(&dew, "pane.heat_given_J") < 0.0);
    let on_pane = gauge(&dew, "pane.water_kg");
    assert!((on_pane / gauge(&dew, "water.on_solids_kg") - 1.0).abs() < 1e-12 && on_pane > 0.0);
    for balance in dew.ledger().balances {
        assert!(balance.relative_error().abs() < 1e-10, "{balance:?}: {:e}", balance.relative_error());
    }
}

/// The same pane where water wets it.
fn with_film() -> String {
    let viscous = PANE.replace(", friction = 1e-7, viscosity_pa_s = 0", "");
    viscous.replace("held = true", "held = true\nwetting = \"film\"")
}

#[test]
fn a_film_forms_runs_off_and_dries_and_no_water_is_lost() {
    let drying = with_film().replace("temperature_c = 5", "temperature_c = [[0, 5], [0.15, 5], [0.16, 60]]");
    let mut dew = dew(&drying);
    advance(&mut dew, 0.15);
    assert_eq!(gauge(&dew, "drops.number"), 0.0);
    assert_eq!(gauge(&dew, "pane.covered_part"), 0.0);
    assert!(gauge(&dew, "pane.fogged_at_s").is_nan() && gauge(&dew, "pane.first_drop_at_s").is_nan());
    let (wet, left) = (gauge(&dew, "pane.water_kg"), gauge(&dew, "drops.left_kg"));
    assert!(wet > 0.0 && left > 0.0);
    advance(&mut dew, 0.6);
    assert!(gauge(&dew, "pane.water_kg") < 0.5 * wet, "{wet} to {}", gauge(&dew, "pane.water_kg"));
    for balance in dew.ledger().balances {
        assert!(balance.relative_error().abs() < 1e-10, "{balance:?}: {:e}", balance.relative_error());
    }
}

#[test]
fn as_much_lies_on_a_wetted_pane_in_accelerated_time() {
    let film = |factor: f64, until: f64| {
        let mut dew = dew(&with_film().replace("time_factor = 100", &format!("time_factor = {factor}")));
        advance(&mut dew, until);
        [gauge(&dew, "pane.water_kg"), gauge(&dew, "drops.left_kg")]
    };
    // Once the air has settled, as much has run off of a film that flows as much faster as it grows.
    let [slow, fast] = [film(50.0, 1.2), film(100.0, 0.6)];
    for (slow, fast) in slow.into_iter().zip(fast) {
        assert!((slow / fast - 1.0).abs() < 0.2, "{slow} {fast}");
    }
}

#[test]
fn a_film_where_it_cannot_be_is_refused() {
    let refused = |text: String| Scene::parse(&text, "test", &[]).unwrap_err().to_string();
    let sites = refused(with_film().replace("\"film\"", "\"film\"\nsites_per_m2 = 1e8"));
    assert!(sites.contains("dew.solid.0.sites_per_m2") && sites.contains("leave it out"), "{sites}");
    let scheme = refused(with_film().replace("[dew]\n", "[dew]\nscheme = \"particle-condensation\"\n"));
    assert!(scheme.contains("dew.solid.0.wetting") && scheme.contains("physical"), "{scheme}");
    let inviscid = refused(with_film().replace("drops = {", "drops = { viscosity_pa_s = 0,"));
    assert!(inviscid.contains("viscosity_pa_s"), "{inviscid}");
}

/// However a plate is turned, its surface is as large.
#[test]
fn patches_of_a_turned_plate_are_as_large_as_the_plate() {
    let area = |degrees: f64| {
        let text = format!(
            "run.until_s = 1\n[dew]\nsize_m = [0.03, 0.03, 0.03]\nspacing_m = 0.001\nair = {{ temperature_c = 25, relative_humidity = 0.8 }}\n\
             [[dew.solid]]\nname = \"plate\"\nshape = {{ box = {{ size_m = [0.016, 0.016, 0.004] }} }}\nposition_m = [0.015, 0.015, 0.015]\n\
             rotation_deg = [0, {degrees}, 0]\ntemperature_c = 5\nheld = true"
        );
        let patches = dew(&text).surfaces().remove(0).half_width;
        patches.iter().map(|half| 4.0 * half * half).sum::<f64>()
    };
    let (level, turned) = (area(0.0), area(35.0));
    assert!((turned / level - 1.0).abs() < 0.02, "{level} {turned}");
}

#[test]
fn air_with_more_vapour_than_saturated_air_is_refused() {
    let start = refused(&PANE.replace("relative_humidity = 0.8", "mixing_ratio = 0.5"));
    assert!(
        start.contains("dew.air.mixing_ratio = 0.5") && start.contains("0.0200") && start.contains("25.0 °C"),
        "{start}"
    );
    let inflow = |keys: &str| {
        PANE.replace("velocity_m_per_s = [0, 0, -0.05]", &format!("velocity_m_per_s = [0, 0, -0.05], {keys}"))
    };
    let told = refused(&inflow("mixing_ratio = 0.01, temperature_c = 5"));
    assert!(told.contains("dew.faces.z_max.inflow.mixing_ratio") && told.contains("5.0 °C"), "{told}");
    dew(&inflow("mixing_ratio = 0.005, temperature_c = 5"));
}

#[test]
fn frames_show_air_solids_and_drops() {
    let mut dew = dew(PANE);
    advance(&mut dew, 0.1);
    let frame = dew.frame();
    let names: Vec<_> = frame.sets.iter().map(|set| set.name.as_str()).collect();
    assert_eq!(names, ["air", "solid", "drops", "unseen"]);
    for set in &frame.sets {
        for column in &set.columns {
            let length = match &column.values {
                Values::Scalar(values) => values.len(),
                Values::Vector(values) => values.len(),
            };
            assert_eq!(length, set.len(), "{} of {}", column.name, set.name);
        }
    }
    let shown = "output = { air = false, solids = false }\n[dew.faces]";
    let shown = self::dew(&PANE.replace("[dew.faces]", shown)).frame();
    assert_eq!(shown.sets.iter().map(|set| set.name.as_str()).collect::<Vec<_>>(), ["drops", "unseen"]);
}

#[test]
fn no_drop_is_on_a_cut_at_a_periodic_side() {
    let mut dew = dew(PANE);
    advance(&mut dew, 0.05);
    let frame = dew.frame();
    let drops = &frame.sets[2];
    assert!(!drops.is_empty());
    let normals = drops.columns.iter().find_map(|column| match &column.values {
        Values::Vector(normals) => Some(normals),
        Values::Scalar(_) => None,
    });
    for normal in normals.unwrap() {
        assert!(normal[1].abs() < 0.5, "{normal:?}");
    }
}

#[test]
fn saved_and_restored_it_goes_on_to_the_same_bits() {
    let mut through = dew(PANE);
    advance(&mut through, 0.06);
    let mut first = dew(PANE);
    // Between two turns of the drops.
    let between = 0.03 + 1.5 * first.time_step();
    advance(&mut first, between);
    let mut resumed = dew(PANE);
    resumed.restore(&first.save()).unwrap();
    advance(&mut resumed, 0.06);
    assert_eq!(resumed.save(), through.save());
    let other = dew(&PANE.replace("spacing_m = 0.002", "spacing_m = 0.001")).save();
    assert!(resumed.restore(&other).is_err());
}

#[test]
fn a_pane_above_the_dew_point_stays_dry() {
    let mut dew = dew(&PANE.replace("temperature_c = 5", "temperature_c = 22"));
    advance(&mut dew, 0.1);
    assert_eq!(gauge(&dew, "water.on_solids_kg"), 0.0);
    assert!(gauge(&dew, "drops.first_at_s").is_nan());
}

#[test]
fn a_fogged_pane_clears_when_it_is_warmed() {
    let text = PANE.replace("temperature_c = 5", "temperature_c = [[0, 5], [0.1, 5], [0.15, 60]]");
    // In a closed box, where warm air stays slow.
    let text = text
        .replace("{ inflow = { velocity_m_per_s = [0, 0, -0.05] } }", "\"wall\"")
        .replace("\"outflow\"", "\"wall\"");
    let mut dew = dew(&text.replace("friction = 1e-7", "friction = 1e-3"));
    advance(&mut dew, 0.1);
    assert!(gauge(&dew, "water.on_solids_kg") > 0.0);
    advance(&mut dew, 0.4);
    assert_eq!((gauge(&dew, "water.on_solids_kg"), gauge(&dew, "drops.number")), (0.0, 0.0));
    let water = &dew.ledger().balances[0];
    assert!(water.relative_error().abs() < 1e-10, "{water:?}");
}

#[test]
fn what_this_version_cannot_do_is_refused_by_its_key() {
    let with = |key: &str| refused(&PANE.replace("[dew.faces]", &format!("{key}\n[dew.faces]")));
    assert!(with("transport = { humidity = \"relative-humidity\" }").contains("dew.transport.humidity"));
    let closed = PANE
        .replace("{ inflow = { velocity_m_per_s = [0, 0, -0.05] } }", "\"wall\"")
        .replace("\"outflow\"", "\"wall\"");
    assert!(refused(&closed.replace("[dew.faces]", "low_utility = {}\n[dew.faces]")).contains("dew.low_utility"));
    assert!(refused(&PANE.replace("\"outflow\"", "\"wall\"")).contains("can leave nowhere"));
    assert!(refused(&PANE.replace("[0.002, 0.006, 0.006]", "[0.002, 0.006, 0.009]")).contains("dew.faces.z_max"));
}

#[test]
fn the_published_scheme_condenses_too_and_hardly_loses_water() {
    let mut dew = dew(&PANE.replace("[dew.faces]", "scheme = \"particle-condensation\"\n[dew.faces]"));
    advance(&mut dew, 0.1);
    assert!(gauge(&dew, "water.on_solids_kg") > 0.0);
    // Relative humidity is what is conserved: the water of the ledger is off by the bend of the mass fraction over it.
    let water = dew.ledger().balances[0].relative_error().abs();
    assert!(water < 1e-2, "{water:e}");
}

#[test]
fn frost_and_accelerated_time_are_said() {
    let warnings = dew(&PANE.replace("temperature_c = 5", "temperature_c = -5")).warnings();
    assert!(warnings.iter().any(|warning| warning.contains("frost")), "{warnings:?}");
    let cold = dew(&PANE.replace("{ temperature_c = 25,", "{ temperature_c = -3,")).warnings();
    assert!(cold.iter().any(|warning| warning.contains("the air is at -3 °C")), "{cold:?}");
    assert!(warnings.iter().any(|warning| warning.contains("100 times faster")), "{warnings:?}");
}

#[test]
fn a_solid_that_nothing_keeps_air_out_of_is_named() {
    let open = dew(&PANE.replace("held = true", "held = true\ntreatment = \"none\"")).warnings();
    assert!(open.iter().any(|warning| warning.contains("keeps the air out of the solid \"pane\"")), "{open:?}");
    let kept = dew(PANE).warnings();
    assert!(!kept.iter().any(|warning| warning.contains("keeps the air out")), "{kept:?}");
}

#[test]
fn drops_too_small_for_the_surface_are_refused_with_a_radius_that_works() {
    let text = |radius: &str| PANE.replace("smallest_radius_m = 1e-5, sites_per_m2 = 1e8", radius);
    let said = refused(&text("smallest_radius_m = 1e-6"));
    assert!(said.contains("dew.drops.smallest_radius_m") && !said.contains("  "), "{said}");
    let radius = said.split("give ").nth(1).unwrap().split(' ').next().unwrap();
    let works: f64 = radius.parse().unwrap();
    assert!(works > 1e-6 && works < 1e-4, "{said}");
    dew(&text(&format!("smallest_radius_m = {}", 4.0 * works)));
    // Left out, it is as large as the surface needs.
    dew(&text("friction = 1e-6").replace(", friction = 1e-7", ""));
}

/// A pulse of vapour that comes in by a side, strongest 0.3 s after the start: as much comes in as its integral says, half of it by then, and it passes
/// through the box as fast as the air.
#[test]
fn air_that_comes_in_changes_with_time() {
    let text = |keys: &str| {
        format!(
            "run.until_s = 1\n[dew]\nsize_m = [0.06, 0.012, 0.012]\nspacing_m = 0.003\nbuoyancy = false\n\
             air = {{ temperature_c = 20, relative_humidity = 0.0, velocity_m_per_s = [0.1, 0, 0] }}\n\
             [dew.faces]\ny_min = \"periodic\"\ny_max = \"periodic\"\nz_min = \"periodic\"\nz_max = \"periodic\"\nx_max = \"outflow\"\n\
             x_min = {{ inflow = {{ velocity_m_per_s = [0.1, 0, 0], {keys} }} }}\n"
        )
    };
    let pulse = "relative_humidity = [[0, 0], [0.2, 0], [0.3, 0.8], [0.4, 0]]";
    let mut channel = dew(&text(pulse));
    let saturated = HumidAir::with_relative_humidity(293.15, 101_325.0, 0.8);
    // Mean of the pulse over 0.2 s is half of its peak.
    let whole = HumidAir::with_relative_humidity(293.15, 101_325.0, 0.0).density()
        * 0.1
        * 0.012_f64.powi(2)
        * (0.5 * 0.2 * saturated.mass_fraction());
    let mut came = |time: f64| {
        advance(&mut channel, time);
        channel.ledger().balances[0].inflow / whole
    };
    let parts = [came(0.19), came(0.3), came(0.45)];
    assert!(parts[0] < 0.02 && (parts[1] - 0.5).abs() < 0.25 && (parts[2] - 1.0).abs() < 0.05, "{parts:?}");
    // Where it is then: the peak has gone 0.015 m a 0.15 s.
    let air = channel.air().iter().filter(|particle| particle.role == Role::Inside);
    let (water, moment) = air.fold((0.0, 0.0), |(water, moment), particle| {
        (water + particle.vapour, moment + particle.vapour * particle.position[0])
    });
    assert!((moment / water / 0.015 - 1.0).abs() < 0.15, "{} m", moment / water);

    // As warm as it comes in, whatever it is at the start; and what cannot be is refused with its time.
    let mut warm = dew(&text("temperature_c = [[0, 20], [0.1, 20], [0.1, 30]]"));
    advance(&mut warm, 0.6);
    let first = warm.air().iter().filter(|particle| particle.role == Role::Inside && particle.position[0] < 0.02);
    let celsius: Vec<f64> = first.map(|particle| particle.temperature - 273.15).collect();
    assert!(celsius.len() > 50 && celsius.iter().all(|celsius| (celsius - 30.0).abs() < 0.1), "{celsius:?}");
    let told = refused(&text("temperature_c = [[0, 30], [5, 5]], mixing_ratio = 0.01"));
    assert!(
        told.contains("dew.faces.x_min.inflow.mixing_ratio: at") && told.contains("relative humidity of"),
        "{told}"
    );
    let told = refused(&text("relative_humidity = { csv = \"missing.csv\" }"));
    assert!(told.contains("dew.faces.x_min.inflow.relative_humidity") && told.contains("missing.csv"), "{told}");
}

/// What comes in over time stays so when the wind changes; what is changed live takes its place, also in a state that is taken up.
#[test]
fn a_live_change_ends_what_comes_in_over_time() {
    let text = PANE.replace(
        "{ inflow = { velocity_m_per_s = [0, 0, -0.05] } }",
        "{ inflow = { velocity_m_per_s = [0, 0, -0.05], temperature_c = [[0, 25], [1, 45]] } }",
    );
    let text = text.replace("sites_per_m2 = 1e8", "sites_per_m2 = 1e5");
    let coming = |dew: &Dew| {
        let newest = dew.air().iter().max_by_key(|particle| particle.id).unwrap();
        newest.temperature - 273.15
    };
    let mut pane = dew(&text);
    LiveChange::Wind { face: [2, 1], axis: 2, velocity: -0.1 }.change(&mut pane).unwrap();
    advance(&mut pane, 0.04);
    assert!((25.5..28.5).contains(&coming(&pane)), "{}", coming(&pane));
    LiveChange::InletTemperature { face: [2, 1], celsius: 15.0 }.change(&mut pane).unwrap();
    advance(&mut pane, 0.08);
    assert!((coming(&pane) - 15.0).abs() < 1e-9, "{}", coming(&pane));
    let mut again = dew(&text);
    again.restore(&pane.save()).unwrap();
    advance(&mut again, 0.1);
    assert!((coming(&again) - 15.0).abs() < 1e-9, "{}", coming(&again));
}

//! Cases whose floods and dew the graphics card computes.

use corpuscle_gpu::require_gpu;
use corpuscle_validate::{Options, Row, cases};

fn rows(name: &str, options: &Options) -> Vec<Row> {
    cases().iter().find(|case| case.name == name).unwrap().rows(options)
}

/// Some two minutes on software in place of a card.
#[test]
#[ignore = "long on software in place of a card"]
fn structures_keep_their_bounds_on_the_card() {
    let Some(gpu) = require_gpu("cases on the card") else { return };
    let mut options = Options::new(None, false);
    options.gpu = Some(gpu);
    let rows = rows("flood/structures", &options);
    assert!(rows.len() == 2 && rows.iter().all(|row| row.pass == Some(true)), "{rows:?}");
}

/// Bores, rarefactions and dry fronts in single precision, against the exact solutions and with the bounds of the processor.
#[test]
fn dam_breaks_keep_their_bounds_on_the_card() {
    let Some(gpu) = require_gpu("cases on the card") else { return };
    let mut options = Options::new(None, false);
    options.gpu = Some(gpu);
    for case in ["flood/stoker", "flood/ritter"] {
        let rows = rows(case, &options);
        assert!(rows.len() == 3 && rows.iter().all(|row| row.pass == Some(true)), "{rows:?}");
    }
}

fn assert_kept(cases: &[(&str, usize)]) {
    let Some(gpu) = require_gpu("cases of dew on the card") else { return };
    let mut options = Options::new(None, false);
    options.gpu = Some(gpu);
    for (name, measures) in cases {
        let rows = rows(name, &options);
        assert!(rows.len() == *measures && rows.iter().all(|row| row.pass == Some(true)), "{rows:?}");
    }
}

#[test]
fn dew_keeps_its_bounds_on_the_card() {
    assert_kept(&[("dew/fick", 3), ("dew/film", 2), ("dew/ledger", 7), ("dew/pane", 4)]);
}

#[test]
fn what_of_dew_takes_no_steps_of_air_is_skipped_and_named() {
    let Some(gpu) = require_gpu("cases of dew on the card") else { return };
    let mut options = Options::new(None, false);
    options.gpu = Some(gpu);
    for (name, what) in [("dew/dew-point", "formula"), ("dew/slide", "drops")] {
        let [row] = &rows(name, &options)[..] else { panic!("{name}") };
        assert!(row.pass.is_none() && row.reason.as_deref().is_some_and(|reason| reason.contains(what)), "{row:?}");
    }
}

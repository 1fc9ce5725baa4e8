//! Cases whose floods the graphics card computes.

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

#[test]
fn what_the_card_cannot_compute_is_skipped_and_named() {
    let Some(gpu) = require_gpu("cases on the card") else { return };
    let mut options = Options::new(None, false);
    options.gpu = Some(gpu);
    for row in rows("flood/ledger", &options) {
        let reason = row.reason.unwrap_or_default();
        assert!(row.pass.is_none() && reason.contains("[flood.refinement]"), "{reason}");
    }
}

//! Cases whose floods and dew the GPU computes, at their reduced size.

use corpuscle_gpu::{Gpu, require_gpu};
use corpuscle_validate::{Options, Row, cases};
use std::time::Instant;

/// Cases of scheme sph-swe, and how far what the GPU finds may be from what the CPU does, over the larger of that and its bound: more where water falls, so that
/// one particle here or there decides.
const SPH_SWE: [(&str, f64); 1] = [("flood/cuboid", 0.05)];

/// Cases of scheme voronoi with lakes at rest and exact solutions: both come to the same within rounding, but where a lake is stirred more than single precision
/// itself stirs it.
const VORONOI: [(&str, f64); 14] = [
    ("flood/voronoi/lake-blocks", 0.1),
    ("flood/voronoi/lake-islands", 0.1),
    ("flood/voronoi/lake-jacksboro", 0.1),
    ("flood/voronoi/lake-long", 0.1),
    ("flood/voronoi/stoker", 0.01),
    ("flood/voronoi/ritter", 0.01),
    ("flood/voronoi/thacker-planar", 0.01),
    ("flood/voronoi/thacker-radial", 0.01),
    ("flood/voronoi/smooth-wave", 0.01),
    ("flood/voronoi/vortex", 0.01),
    ("flood/voronoi/sheets", 0.01),
    ("flood/voronoi/rain-plane", 0.01),
    ("flood/voronoi/infiltration", 0.01),
    ("flood/voronoi/cylinder-force", 0.01),
];

/// Other cases of scheme voronoi, where thin fronts may decide.
const MORE_VORONOI: [(&str, f64); 9] = [
    ("flood/voronoi/momentum", 0.01),
    ("flood/voronoi/ledger", 0.01),
    ("flood/voronoi/energy", 0.01),
    ("flood/voronoi/invariance", 0.01),
    ("flood/voronoi/tide", 0.01),
    ("flood/voronoi/finer", 0.01),
    ("flood/voronoi/adaptive", 0.02),
    ("flood/voronoi/run-up", 0.05),
    ("flood/voronoi/sent-wave", 0.01),
];

/// Of dew those that have a reduced size, but for `SLOW`. Air along a plate is rough, and every rounding makes another run of it: eight seeds on the CPU differ by a
/// standard deviation of 1.58 % of the Sherwood number, so two runs by at most 6.7 %, three standard deviations of their difference; 0.13 of the bound.
const DEW: [(&str, f64); 5] = [
    ("dew/plate", 0.13),
    ("dew/packings", 0.05),
    ("dew/properties", 0.05),
    ("dew/adiabatic", 0.05),
    ("dew/evaporation", 0.05),
];

/// Cases that take longest where software stands in for a GPU, whatever their model.
const SLOW: [(&str, f64); 15] = [
    ("flood/rough-terrain", 0.1),
    ("flood/cylinder", 0.05),
    ("flood/voronoi/structures", 0.01),
    ("flood/voronoi/storage", 0.01),
    ("flood/voronoi/malpasset", 0.05),
    ("flood/voronoi/beach", 0.05),
    ("flood/voronoi/swashes", 0.01),
    ("flood/voronoi/triangular-obstacle", 0.05),
    ("flood/voronoi/isolated-building", 0.05),
    ("flood/voronoi/ea-test5", 0.05),
    ("dew/two-slabs", 0.05),
    ("dew/boundaries", 0.1),
    ("dew/cavity", 0.02),
    ("dew/heat-sources", 0.05),
    ("dew/walls", 0.05),
];

/// Of dew those that are small, with as many measures that have bounds.
const SMALL_DEW: [(&str, usize); 5] =
    [("dew/fick", 5), ("dew/film", 2), ("dew/ledger", 7), ("dew/low-utility", 3), ("dew/pane", 6)];

/// Of dew those in which no air takes a step, and what does.
const WITHOUT_AIR: [(&str, &str); 4] = [
    ("dew/dew-point", "formula"),
    ("dew/slide", "drops"),
    ("dew/breath-figures", "drops"),
    ("dew/falling-film", "films"),
];

/// Below this a bound is of what rounding leaves, of which the GPU leaves more and has bounds of its own.
const ROUNDING: f64 = 1e-5;

fn options() -> Options {
    let data = std::env::var_os("CORPUSCLE_DATA").filter(|path| !path.is_empty()).map(Into::into);
    let mut options = Options::new(data, std::env::var_os("CORPUSCLE_REQUIRE_DATA").is_some_and(|value| value == "1"));
    options.reduced = true;
    options
}

fn rows(name: &str, options: &Options) -> Vec<Row> {
    cases().iter().find(|case| case.name == name).unwrap().rows(options)
}

fn on_gpu(gpu: Gpu) -> Options {
    let mut options = options();
    options.gpu = Some(gpu);
    options
}

/// Whether the GPU's row says what the CPU's does.
fn agree(host: &Row, device: &Row, share: f64) -> bool {
    let (Some(found), Some(on_gpu)) = (host.value, device.value) else {
        return host.pass == device.pass && host.reason == device.reason;
    };
    // A row that is only shown beside another has no bound.
    let Some(kept) = host.pass else { return true };
    if host.relation == ">=" || host.bound < ROUNDING {
        return device.pass == Some(true) || !kept;
    }
    (found - on_gpu).abs() <= share * host.bound.max(found)
}

/// Compares cases, by names and shares, on the GPU and on the CPU.
fn compare(gpu: Gpu, cases: &[(&str, f64)]) {
    let (host, device) = (options(), on_gpu(gpu));
    let mut apart = Vec::new();
    for (name, share) in cases {
        let start = Instant::now();
        let on_cpu = rows(name, &host);
        let between = Instant::now();
        let both = [on_cpu, rows(name, &device)];
        eprintln!(
            "{name}: {:.1} s on the CPU, {:.1} s on the GPU",
            (between - start).as_secs_f64(),
            between.elapsed().as_secs_f64()
        );
        assert!(!both[0].is_empty() && both[0].len() == both[1].len(), "{both:?}");
        let [host, device] = both;
        let pairs = host.into_iter().zip(device);
        apart.extend(pairs.filter(|(host, device)| host.measure != device.measure || !agree(host, device, *share)));
    }
    assert!(apart.is_empty(), "{apart:#?}");
}

#[test]
fn floods_of_scheme_sph_swe_are_on_the_gpu_what_they_are_on_the_cpu() {
    let Some(gpu) = require_gpu("cases of scheme sph-swe on the GPU") else { return };
    compare(gpu, &SPH_SWE);
}

#[test]
fn floods_of_scheme_voronoi_are_on_the_gpu_what_they_are_on_the_cpu() {
    let Some(gpu) = require_gpu("cases of scheme voronoi on the GPU") else { return };
    compare(gpu, &VORONOI);
}

/// In a test of its own, so that both run beside each other.
#[test]
#[ignore = "takes minutes without a GPU; cargo test --release --workspace --test gpu -- --ignored"]
fn more_floods_of_scheme_voronoi_are_on_the_gpu_what_they_are_on_the_cpu() {
    let Some(gpu) = require_gpu("more cases of scheme voronoi on the GPU") else { return };
    compare(gpu, &MORE_VORONOI);
}

#[test]
fn dew_of_cases_is_on_the_gpu_what_it_is_on_the_cpu() {
    let Some(gpu) = require_gpu("cases of dew on the GPU") else { return };
    compare(gpu, &DEW);
}

#[test]
#[ignore = "takes minutes without a GPU; cargo test --release --workspace --test gpu -- --ignored"]
fn what_takes_longest_is_on_the_gpu_what_it_is_on_the_cpu() {
    let Some(gpu) = require_gpu("cases that take longest on the GPU") else { return };
    compare(gpu, &SLOW);
}

/// At full size, which is small.
#[test]
#[ignore = "takes minutes without a GPU; cargo test --release --workspace --test gpu -- --ignored"]
fn dew_keeps_its_bounds_on_the_gpu() {
    let Some(gpu) = require_gpu("cases of dew on the GPU") else { return };
    let options = on_gpu(gpu);
    for (name, measures) in SMALL_DEW {
        let rows = rows(name, &options);
        let kept = rows.iter().filter(|row| row.pass == Some(true)).count();
        assert!(kept == measures && rows.iter().all(|row| row.pass != Some(false)), "{rows:?}");
    }
}

#[test]
fn what_of_dew_takes_no_steps_of_air_is_skipped_and_named() {
    let Some(gpu) = require_gpu("cases of dew on the GPU") else { return };
    let options = on_gpu(gpu);
    for (name, what) in WITHOUT_AIR {
        let [row] = &rows(name, &options)[..] else { panic!("{name}") };
        assert!(row.pass.is_none() && row.reason.as_deref().is_some_and(|reason| reason.contains(what)), "{row:?}");
    }
}

fn on_the_cpu_only(name: &str) -> bool {
    name.starts_with("gas/")
}

#[test]
fn no_case_of_floods_and_dew_is_left_out() {
    let compared = SPH_SWE.iter().chain(&VORONOI).chain(&MORE_VORONOI).chain(&DEW).chain(&SLOW).map(|(name, _)| *name);
    let all: Vec<&str> =
        compared.chain(SMALL_DEW.map(|(name, _)| name)).chain(WITHOUT_AIR.map(|(name, _)| name)).collect();
    let missing: Vec<_> =
        cases().iter().map(|case| case.name).filter(|name| !on_the_cpu_only(name) && !all.contains(name)).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

//! The report of a gas: what must be in it, from a model made for the test.

use corpuscle_model::*;
use corpuscle_output::{FrameFormat, GasReport, RunFolder, Status, Summary, ledger_entries};
use corpuscle_scene::Scene;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path as FilePath;
use std::sync::atomic::AtomicBool;

/// Balls on a lattice, as many sets as the scene names, with speeds that rise from ball to ball.
struct Balls {
    scene: Scene,
    time: f64,
}

impl Balls {
    fn sets(&self) -> Vec<ParticleSet> {
        let gas = self.scene.gas().unwrap();
        let mut id = 0;
        let set = |species: &corpuscle_scene::Species| {
            let mut set = ParticleSet { name: species.name.clone(), ..ParticleSet::default() };
            let (from, to) = match &species.region {
                Some(region) => (region.from.clone(), region.to.clone()),
                None => (vec![0.0; gas.dimensions()], gas.size.clone()),
            };
            let count = species.count.unwrap();
            let side = (count as f64).powf(1.0 / gas.dimensions() as f64).ceil() as u64;
            for k in 0..count {
                let index = [k % side, k / side % side, k / side / side];
                let mut position = [0.0; 3];
                for axis in 0..gas.dimensions() {
                    let part = (index[axis] as f64 + 0.5) / side as f64;
                    position[axis] = from[axis] + part * (to[axis] - from[axis]);
                }
                set.id.push(id);
                set.position.push(position);
                let speed = 2.5 * (k as f64 + 0.5) / count as f64 * (species.temperature / species.mass).sqrt();
                set.velocity.push([speed, 0.0, 0.0]);
                set.radius.push(species.radius);
                set.mass.push(species.mass);
                id += 1;
            }
            set
        };
        gas.species.iter().map(set).collect()
    }
}

impl Model for Balls {
    fn name(&self) -> &'static str {
        "gas"
    }
    fn time(&self) -> f64 {
        self.time
    }
    fn steps(&self) -> u64 {
        12_345
    }
    fn particle_steps(&self) -> u64 {
        12_345
    }
    fn particles(&self) -> usize {
        self.sets().iter().map(ParticleSet::len).sum()
    }
    fn advance_to(&mut self, time: f64, _: &AtomicBool) -> Result<(), ModelError> {
        self.time = time;
        Ok(())
    }
    fn frame(&self) -> Frame {
        Frame { time: self.time, sets: self.sets() }
    }
    fn gauge_columns(&self) -> Vec<GaugeColumn> {
        let column = |quantity| GaugeColumn { gauge: "gas".into(), quantity, unit: "" };
        vec![column("temperature"), column("pressure_virial"), column("pressure_walls")]
    }
    fn gauge_row(&self) -> Vec<f64> {
        vec![1.0, 0.02 + 0.001 * (self.time * 9.0).sin(), 0.02 + 0.001 * (self.time * 7.0).cos()]
    }
    fn maps(&self) -> Vec<Map> {
        Vec::new()
    }
    fn charts(&self) -> Vec<Chart> {
        let bars = (0..40)
            .map(|k| 0.1 * (f64::from(k) + 0.5))
            .map(|v| [v, v * (-0.5 * v * v).exp() + 0.02 * (31.0 * v).sin()]);
        let theory = (0..400).map(|k| 0.01 * f64::from(k)).map(|v| [v, v * (-0.5 * v * v).exp()]);
        let measured = ChartSeries {
            name: "balls".into(),
            style: ChartStyle::Bars,
            points: bars.collect(),
            ..ChartSeries::default()
        };
        let maxwell = ChartSeries { name: "Maxwell".into(), points: theory.collect(), ..ChartSeries::default() };
        let axis = |label: &str| ChartAxis { label: label.into(), ..ChartAxis::default() };
        let points: Vec<[f64; 2]> = (1..30).map(|k| [f64::from(k), 0.4 * f64::from(k).powf(1.02)]).collect();
        let msd = ChartSeries {
            name: "light".into(),
            style: ChartStyle::Points,
            errors: points.iter().map(|p| 0.1 * p[1]).collect(),
            points,
            ..ChartSeries::default()
        };
        vec![
            Chart {
                name: "speeds".into(),
                title: "Speeds".into(),
                x: axis("Speed"),
                y: axis("Part for each unit of speed"),
                series: vec![measured, maxwell],
                note: "chi-square p = 0.43".into(),
            },
            Chart {
                name: "displacement".into(),
                title: "Mean square displacement".into(),
                x: ChartAxis { logarithmic: true, ..axis("Time") },
                y: ChartAxis { logarithmic: true, ..axis("Mean square displacement") },
                series: vec![msd],
                note: String::new(),
            },
        ]
    }
    fn paths(&self) -> Vec<Path> {
        if self.scene.gas().unwrap().follow.is_none() {
            return Vec::new();
        }
        let points: Vec<[f64; 3]> = (0..60)
            .map(|k| [f64::from(k * 37 % 71) / 71.0, f64::from(k * 53 % 67) / 67.0, f64::from(k * 29 % 61) / 61.0])
            .collect();
        let size = corpuscle_scene::padded(&self.scene.gas().unwrap().size);
        let points: Vec<[f64; 3]> = points.iter().map(|p| std::array::from_fn(|k| p[k] * size[k])).collect();
        vec![Path { name: "ball 0".into(), times: (0..60).map(f64::from).collect(), points }]
    }
    fn ledger(&self) -> Ledger {
        Ledger {
            balances: vec![Balance {
                quantity: "energy",
                initial: 800.0,
                inflow: 0.0,
                outflow: 0.0,
                now: 800.0,
                least: 0.0,
            }],
        }
    }
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }
    fn save(&self) -> Vec<u8> {
        Vec::new()
    }
    fn restore(&mut self, _: &[u8]) -> Result<(), ModelError> {
        Ok(())
    }
}

fn run(folder: &FilePath, text: &str) -> String {
    let mut scene = Scene::parse(text, "test", &[]).unwrap();
    scene.resolve_defaults();
    let mut model = Balls { scene: scene.clone(), time: 0.0 };
    let mut run =
        RunFolder::create(folder, &scene.to_toml().unwrap(), &model.gauge_columns(), FrameFormat::None).unwrap();
    for step in 0..=20 {
        model.time = f64::from(step) * 0.5;
        run.append_gauges(model.time, &model.gauge_row()).unwrap();
        GasReport::new(folder, &scene, &model).unwrap().write_moment().unwrap();
    }
    run.write_charts(&model.charts(), &model.paths()).unwrap();
    run.finish(&summary(&model)).unwrap();
    GasReport::new(folder, &scene, &model).unwrap().write().unwrap();
    fs::read_to_string(folder.join("report.html")).unwrap()
}

fn summary(model: &Balls) -> Summary {
    Summary {
        model: "gas".into(),
        backend: "cpu".into(),
        version: "0.1.0".into(),
        status: Status::Done,
        particles: model.particles(),
        steps: 12_345,
        simulated_time_s: 10.0,
        wall_time_s: 2.0,
        particle_steps_per_s: None,
        collisions: Some(12_345),
        collisions_per_s: Some(6172.5),
        warnings: Vec::new(),
        ledger: ledger_entries(&model.ledger()),
        extent: None,
    }
}

const FLAT: &str = "title = 'Eight hundred balls'\ndescription = 'A box of balls.'\n[run]\nuntil_s = 10\n[gas]\nsize = [800, 600]\nfollow = 7\n\
[gas.walls]\nx_max = { piston = { mass = 9.0, pressure = 1.0 } }\ny_min = { thermal = { temperature = 1.0 } }\n\
[[gas.species]]\nname = 'balls'\ncount = 800\nradius = 4\nmass = 1\ntemperature = 1\n";

const DEEP: &str = "title = 'Two gases'\n[run]\nuntil_s = 10\n[gas]\nsize = [20, 10, 12]\npartition = { axis = 'x', at = 10.0 }\n\
[[gas.species]]\nname = 'light'\ncount = 400\nradius = 0.3\nmass = 1\ntemperature = 1\nregion = { from = [0, 0, 0], to = [10, 10, 12] }\n\
[[gas.species]]\nname = 'heavy'\ncount = 120\nradius = 0.6\nmass = 4\ntemperature = 1\nregion = { from = [10, 0, 0], to = [20, 10, 12] }\n";

#[test]
fn it_has_the_balls_the_charts_and_the_ledger_and_needs_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    let html = run(&path, FLAT);
    for text in [
        "Eight hundred balls",
        "A box of balls.",
        "12\u{2009}345",
        "chi-square p = 0.43",
        "Maxwell",
        "Pressure",
        "on the walls",
        "energy",
        "trajectory of one ball",
        "wall at a temperature",
        "corpuscle run run/scene.toml",
        "Speed",
        "data:image/svg+xml",
    ] {
        assert!(html.contains(text), "`{text}` is not in the report");
    }
    assert!(!html.contains("NaN") && !html.contains("src=\"http") && !html.contains("<script"));
    for file in [
        "balls.svg",
        "balls.png",
        "speeds.png",
        "pressure_virial_over_time.png",
        "frame_000000.svg",
        "frame_000020.svg",
    ] {
        assert!(path.join("pictures").join(file).is_file(), "{file}");
    }
    assert!(path.join("charts/speeds.csv").is_file() && path.join("path.csv").is_file());
    let svg = fs::read_to_string(path.join("pictures/balls.svg")).unwrap();
    assert_eq!(svg.matches("<circle").count(), 800 + 2, "the balls, the start of the trajectory and its ball");
}

#[test]
fn three_dimensions_and_two_kinds() {
    let folder = tempfile::tempdir().unwrap();
    let html = run(&folder.path().join("run"), DEEP);
    assert!(html.contains("light: 400") && html.contains("heavy: 120") && html.contains("data:image/png"));
}

#[test]
fn the_same_run_gives_the_same_report() {
    let folder = tempfile::tempdir().unwrap();
    let [one, other] = ["a/run", "b/run"].map(|name| folder.path().join(name));
    assert!(run(&one, FLAT) == run(&other, FLAT));
    let names = |path: &FilePath| -> BTreeMap<_, _> {
        let read = |entry: fs::DirEntry| (entry.file_name(), fs::read(entry.path()).unwrap());
        fs::read_dir(path.join("pictures")).unwrap().map(|entry| read(entry.unwrap())).collect()
    };
    assert!(names(&one) == names(&other));
}

#[test]
fn another_models_scene_is_refused() {
    let scene = Scene::parse("run.until_s = 1\nterrain.plane = {}\nflood = {}", "test", &[]).unwrap();
    let model = Balls { scene: Scene::parse(FLAT, "test", &[]).unwrap(), time: 0.0 };
    let error = GasReport::new(FilePath::new("runs/x"), &scene, &model).err().unwrap().to_string();
    assert!(error.contains("not the scene of a gas"), "{error}");
}

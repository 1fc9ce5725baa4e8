//! A model that is registered: its tables are read, checked and written as those of the others.

use corpuscle_scene::{Check, Checked, ModelScene, Run, Scene, SceneKind, register};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The `[springs]` table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Springs {
    count: usize,
    stiffness_n_per_m: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    start: Option<PathBuf>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    look_every_s: Option<f64>,
}

impl ModelScene for Springs {
    const NAME: &'static str = "springs";

    fn check(&self, check: &Check) -> Checked {
        check.above("springs.stiffness_n_per_m", self.stiffness_n_per_m, 0.0)
    }

    fn resolve_defaults(&mut self, run: &Run) {
        self.look_every_s.get_or_insert(run.gauge_period_s());
    }

    fn paths(&mut self) -> Vec<&mut PathBuf> {
        self.start.iter_mut().collect()
    }
}

const TEXT: &str = "[run]\nuntil_s = 2\n[springs]\ncount = 3\nstiffness_n_per_m = 4.5\nstart = \"a.csv\"\n";

fn parse(text: &str, overrides: &[(&str, &str)]) -> Result<Scene, String> {
    register(SceneKind::of::<Springs>(&[]));
    let overrides: Vec<_> = overrides.iter().map(|(path, value)| ((*path).to_owned(), (*value).to_owned())).collect();
    Scene::parse(text, "test.toml", &overrides).map_err(|error| error.to_string())
}

#[test]
fn its_tables_are_read_and_written() {
    let mut scene = parse(TEXT, &[("springs.count", "5")]).unwrap();
    assert_eq!(scene.model.name(), "springs");
    assert!(scene.gas().is_none() && scene.flood().is_none() && scene.dew().is_none());
    scene.resolve_paths(Path::new("/folder"));
    scene.resolve_defaults();
    let springs =
        Springs { count: 5, stiffness_n_per_m: 4.5, start: Some("/folder/a.csv".into()), look_every_s: Some(0.01) };
    assert_eq!(scene.model.get(), Some(&springs));
    let again = parse(&scene.to_toml().unwrap(), &[]).unwrap();
    assert_eq!(again, scene);
    let other = parse(TEXT, &[]).unwrap();
    assert!(
        other != scene && other.model != parse("[run]\nuntil_s = 2\n[terrain.plane]\n[flood]\n", &[]).unwrap().model
    );
}

#[test]
fn what_is_wrong_in_them_is_told_with_its_line() {
    for (from, to, words) in [
        ("count = 3", "count = -3", ["test.toml:4:9: springs.count", "whole number"]),
        ("count = 3\n", "", ["test.toml:3:1: springs.count is missing", "count"]),
        ("4.5", "-4.5", ["test.toml:5:21: springs.stiffness_n_per_m = -4.5", "larger than 0"]),
        ("4.5", "nan", ["springs.stiffness_n_per_m = nan", "finite"]),
        ("count = 3", "count = 3\ncuont = 4", ["test.toml:5:1: springs.cuont", "did you mean `count`?"]),
        ("[springs]", "[sprnigs]", ["test.toml:3:1: sprnigs", "did you mean `springs`?"]),
        (
            "[run]",
            "[gas]\nsize = [1, 1]\n[run]",
            ["test.toml:5:1: springs: a scene has one model", "take out [springs], or [gas]"],
        ),
    ] {
        let error = parse(&TEXT.replacen(from, to, 1), &[]).unwrap_err();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    }
}

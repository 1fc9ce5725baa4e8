//! `corpuscle ensemble`: members, results, resumption, job arrays, and what is refused.

mod tool;

use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};
use tool::{BALLS, Ended, LAKE, Place};

/// Six lakes of different levels.
const PLAN: &str = "scene = \"lake.toml\"
sample = \"grid\"
[set]
run.until_s = 1.0
[change]
flood.water.0.level_m = [0.5, 0.8, 1.1, 1.4, 1.7, 2.0]
[statistics]
above = { max_depth = [0.6] }
percentiles = [20, 50]
";

/// A folder with the lake and the plan.
fn lakes() -> Place {
    let place = Place::new();
    place.write("lake.toml", LAKE);
    place.write("plan.toml", PLAN);
    place
}

/// Content of the members' results, by path: maps and gauges, and records without the times that they took.
fn members(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for member in fs::read_dir(folder.join("members")).unwrap().flatten() {
        for file in fs::read_dir(member.path()).unwrap().flatten() {
            let name = file.path().strip_prefix(folder).unwrap().to_string_lossy().into_owned();
            if name.ends_with("member.json") {
                let mut record: Value = serde_json::from_slice(&fs::read(file.path()).unwrap()).unwrap();
                for timed in ["wall_time_s", "summary", "attempts"] {
                    record.as_object_mut().unwrap().remove(timed);
                }
                found.insert(name, record.to_string().into_bytes());
            } else {
                found.insert(name, fs::read(file.path()).unwrap());
            }
        }
    }
    found
}

fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let files = fs::read_dir(folder).unwrap().flatten();
    files.map(|file| (file.file_name().to_string_lossy().into_owned(), fs::read(file.path()).unwrap())).collect()
}

/// The values of a row of a table by its headings.
fn row(text: &str, number: usize) -> BTreeMap<&str, &str> {
    let mut lines = text.lines();
    let head = lines.next().unwrap();
    head.split(',').zip(lines.nth(number).unwrap().split(',')).collect()
}

#[test]
fn members_run_and_statistics_are_those_of_their_maps() {
    let place = lakes();
    let ended = place.run(&["ensemble", "plan.toml", "-o", "out", "--json"]).expect_status(0);
    let report = ended.json();
    assert_eq!([&report["members"], &report["finished"], &report["failed"]], [6, 6, 0].map(Value::from).each_ref());
    let results = files(&place.path("out/results"));
    for name in [
        "max_depth_probability_above_0.6.tif",
        "max_depth_mean.tif",
        "max_depth_p20.tif",
        "arrival_s_p50.tif",
        "max_level_standard_error.tif",
    ] {
        assert!(results.contains_key(name), "{name} is not in {:?}", results.keys());
    }
    let last = String::from_utf8(results["last_gauges.csv"].clone()).unwrap();
    let depths: Vec<f64> = (0..6)
        .map(|member| {
            let gauges = fs::read_to_string(place.path(format!("out/members/{member:06}/gauges.csv"))).unwrap();
            let last = gauges.lines().count() - 2;
            row(&gauges, last)["P1.depth_m"].parse().unwrap()
        })
        .collect();
    assert!(depths.windows(2).all(|pair| (pair[1] - pair[0] - 0.3).abs() < 0.05), "{depths:?}");
    let line = last.lines().find(|line| line.starts_with("P1.depth_m,")).unwrap();
    let numbers: Vec<f64> = line.split(',').skip(1).map(|cell| cell.parse().unwrap()).collect();
    let mean = depths.iter().sum::<f64>() / 6.0;
    let variance = depths.iter().map(|depth| (depth - mean).powi(2)).sum::<f64>() / 5.0;
    assert!((numbers[0] - mean).abs() < 1e-12 && (numbers[1] - (variance / 6.0).sqrt()).abs() < 1e-12, "{line}");
    assert_eq!(numbers[2], 6.0);
    let members = String::from_utf8(results["members.csv"].clone()).unwrap();
    assert_eq!((row(&members, 5)["flood.water.0.level_m"], row(&members, 5)["status"]), ("2.0", "finished"));
    // Away from the bump the ground is at 0, so the depth is the level: above 0.6 m in five of six.
    let probability = "out/results/max_depth_probability_above_0.6.tif";
    let info = place.run(&["terrain", "info", probability, "--json"]).expect_status(0).json();
    assert!((info[0]["highest_m"].as_f64().unwrap() - 5.0 / 6.0).abs() < 1e-6, "{info}");
    let page = fs::read_to_string(place.path("out/report.html")).unwrap();
    for words in [
        "6 of 6 members are finished",
        "Probability of a maximum depth above 0.6 m",
        "Percentile 20",
        "flood.water.0.level_m",
        "P1.depth_m",
    ] {
        assert!(page.contains(words), "{words}");
    }
}

#[test]
fn any_order_of_members_and_threads_gives_the_same_bytes() {
    let place = lakes();
    place.run(&["ensemble", "plan.toml", "-o", "a"]).expect_status(0);
    // As a job array: members by themselves, then the results.
    for member in ["4", "0", "2"] {
        let ended =
            place.run(&["ensemble", "plan.toml", "-o", "b", "--member", member, "--threads", "3"]).expect_status(0);
        assert!(ended.stderr.contains("1 of 1 members are finished"), "{}", ended.stderr);
        assert!(!place.path("b/results").exists());
    }
    place.run(&["ensemble", "plan.toml", "-o", "b", "--at-once", "2", "--threads", "2"]).expect_status(0);
    assert_eq!(members(&place.path("a")), members(&place.path("b")));
    let [a, b] = ["a/results", "b/results"].map(|folder| files(&place.path(folder)));
    let same = |name: &&String| *name != "members.csv" && a[*name] != b[*name];
    assert_eq!(a.keys().collect::<Vec<_>>(), b.keys().collect::<Vec<_>>());
    assert_eq!(a.keys().filter(same).collect::<Vec<_>>(), Vec::<&String>::new());
}

#[test]
fn killed_and_interrupted_it_goes_on_with_what_is_missing() {
    let place = lakes();
    let long = PLAN.replace("until_s = 1.0", "until_s = 60.0");
    place.write("plan.toml", &long);
    place.run(&["ensemble", "plan.toml", "-o", "whole"]).expect_status(0);
    for signal in ["-KILL", "-INT"] {
        let mut child = place.command(&["ensemble", "plan.toml", "-o", "cut"]).spawn().unwrap();
        let start = Instant::now();
        let finished = |number: usize| place.path(format!("cut/members/{number:06}/member.json")).exists();
        let wanted = if signal == "-KILL" { 1 } else { 2 };
        while (0..6).filter(|number| finished(*number)).count() < wanted && start.elapsed() < Duration::from_secs(60) {
            sleep(Duration::from_millis(2));
        }
        std::process::Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
        child.wait().unwrap();
        assert!((0..6).any(|number| !finished(number)), "it ended before it could be interrupted");
    }
    assert!(!place.path("cut/report.html").exists());
    place.run(&["ensemble", "plan.toml", "-o", "cut"]).expect_status(0);
    assert_eq!(members(&place.path("whole")), members(&place.path("cut")));
    let attempts = |number: usize| -> Value {
        let record = fs::read(place.path(format!("cut/members/{number:06}/member.json"))).unwrap();
        serde_json::from_slice::<Value>(&record).unwrap()["attempts"].clone()
    };
    assert!((0..6).all(|number| attempts(number) == 1), "what was finished did not run again");
}

#[test]
fn a_member_that_fails_is_told_and_the_others_go_on() {
    let place = lakes();
    place.write("table.csv", "flood.manning\n0.03\n-1\n0.05\n");
    place.write("plan.toml", "scene = \"lake.toml\"\ntable = \"table.csv\"\n");
    let ended = place.run(&["ensemble", "plan.toml", "-o", "out"]).expect_status(1);
    assert!(ended.stderr.contains("member 1 failed") && ended.stderr.contains("flood.manning"), "{}", ended.stderr);
    assert!(ended.stderr.contains("2 of 3 members are finished, 1 failed"), "{}", ended.stderr);
    let page = fs::read_to_string(place.path("out/report.html")).unwrap();
    assert!(page.contains("Members that failed") && page.contains("flood.manning = -1"));
    // The next call tries it again.
    place.run(&["ensemble", "plan.toml", "-o", "out"]).expect_status(1);
    let record: Value = serde_json::from_slice(&place.read("out/members/000001/member.json")).unwrap();
    assert_eq!((&record["attempts"], &record["error"]["key"]), (&2.into(), &"flood.manning".into()));
}

#[test]
fn a_gas_has_means_with_standard_errors() {
    let place = Place::new();
    place.write("balls.toml", BALLS);
    place.write("plan.toml", "scene = \"balls.toml\"\nsample = \"latin-hypercube\"\nmembers = 4\n[change]\nseed = { from = 1, to = 1000, whole = true }\n");
    place.run(&["ensemble", "plan.toml", "-o", "out"]).expect_status(0);
    let last = String::from_utf8(place.read("out/results/last_gauges.csv")).unwrap();
    let line = last.lines().find(|line| line.contains("pressure") && !line.contains("error")).unwrap();
    let numbers: Vec<f64> = line.split(',').skip(1).map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
    assert!(numbers[0] > 0.0 && numbers[1] > 0.0 && numbers[2] == 4.0, "{line}");
    let page = fs::read_to_string(place.path("out/report.html")).unwrap();
    assert!(page.contains("4 of 4 members are finished") && !page.contains("Percentile 50"));
}

#[test]
fn what_does_not_fit_is_refused() {
    let place = lakes();
    let refused = |arguments: &[&str], words: &str| {
        let ended: Ended = place.run(arguments).expect_status(2);
        assert!(ended.stderr.contains(words), "{words}: {}", ended.stderr);
    };
    refused(&["ensemble", "none.toml"], "none.toml");
    refused(&["ensemble", "plan.toml", "-o", "out", "--member", "6"], "numbered from 0 to 5");
    assert!(!place.path("out").exists(), "what is refused leaves no folder");
    place.write("other/file.txt", "mine");
    refused(&["ensemble", "plan.toml", "-o", "other"], "it holds file.txt");
    place.write("a-file", "");
    refused(&["ensemble", "plan.toml", "-o", "a-file"], "is a file");
    place.run(&["ensemble", "plan.toml", "-o", "out", "--member", "0", "--member", "1"]).expect_status(0);
    place.write("plan.toml", &PLAN.replace("1.7", "1.8"));
    refused(
        &["ensemble", "plan.toml", "-o", "out"],
        "flood.water.0.level_m of member 4 is 1.7 in the stored plan, 1.8 in the given one",
    );
    place.write("plan.toml", &PLAN.replace("[change]", "flood.manning = 0.05\n[change]"));
    refused(&["ensemble", "plan.toml", "-o", "out"], "of another scene");
    place.write("plan.toml", &PLAN.replace("max_depth", "maxdepth"));
    refused(&["ensemble", "plan.toml", "-o", "out"], "no map maxdepth; it has");
    place.write("plan.toml", PLAN);
    place.write("out/members/000000/gauges.csv", "time_s,P1.depth_m\n0,zero\n");
    refused(&["ensemble", "plan.toml", "-o", "out"], "remove out/members/000000 and run the plan again");
    let record = String::from_utf8(place.read("out/members/000001/member.json")).unwrap();
    place.write("out/members/000000/member.json", &record);
    refused(&["ensemble", "plan.toml", "-o", "out"], "holds another member");
    // A plan without a finished member has no results.
    place.write("plan.toml", "scene = \"lake.toml\"\nsample = \"grid\"\n[change]\nflood.manning = [-1]\n");
    refused(&["ensemble", "plan.toml", "-o", "none"], "no member of the ensemble");
}

//! `charts/`: charts as tables; `path.csv`: trajectories of followed particles.

use crate::OutputError;
use crate::number::Shortest;
use crate::whole::write_bytes;
use corpuscle_model::{Chart, ChartSeries, Path as Trajectory};
use std::path::Path;

/// Writes a chart: one row for each point, `series,x,y,error`; the last is empty where there is none.
pub(crate) fn write_chart(folder: &Path, chart: &Chart) -> Result<(), OutputError> {
    let rows = |series: &ChartSeries| {
        let error =
            |index: usize| series.errors.get(index).map_or_else(String::new, |error| Shortest(*error).to_string());
        let row = |(index, [x, y]): (usize, &[f64; 2])| {
            [series.name.clone(), Shortest(*x).to_string(), Shortest(*y).to_string(), error(index)]
        };
        series.points.iter().enumerate().map(row).collect::<Vec<_>>()
    };
    let path = folder.join(format!("{}.csv", chart.name));
    write_table(&path, ["series", "x", "y", "error"], chart.series.iter().flat_map(rows))
}

/// Writes `path.csv`: `path,time_s,x,y,z`, one row for each point.
pub(crate) fn write_paths(folder: &Path, trajectories: &[Trajectory]) -> Result<(), OutputError> {
    let rows = |trajectory: &Trajectory| {
        let row = |(time, [x, y, z]): (&f64, &[f64; 3])| {
            let [time, x, y, z] = [time, x, y, z].map(|value| Shortest(*value).to_string());
            [trajectory.name.clone(), time, x, y, z]
        };
        trajectory.times.iter().zip(&trajectory.points).map(row).collect::<Vec<_>>()
    };
    write_table(&folder.join("path.csv"), ["path", "time_s", "x", "y", "z"], trajectories.iter().flat_map(rows))
}

fn write_table<const N: usize>(
    path: &Path,
    head: [&str; N],
    rows: impl Iterator<Item = [String; N]>,
) -> Result<(), OutputError> {
    let table = || {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(head)?;
        for row in rows {
            writer.write_record(row)?;
        }
        writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))
    };
    write_bytes(path, &table().map_err(|error| OutputError::content(path, error))?)
}

/// Reads the trajectories of a run, `path.csv`; none where there is no such file.
pub(crate) fn read_paths(folder: &Path) -> Result<Vec<Trajectory>, OutputError> {
    let path = folder.join("path.csv");
    if !path.exists() {
        return Ok(Vec::new());
    }
    let wrong = |what: String| OutputError::content(&path, what);
    let mut reader = csv::Reader::from_path(&path).map_err(|error| wrong(error.to_string()))?;
    let mut trajectories: Vec<Trajectory> = Vec::new();
    for row in reader.deserialize::<(String, f64, f64, f64, f64)>() {
        let (name, time, x, y, z) = row.map_err(|error| wrong(error.to_string()))?;
        if trajectories.last().is_none_or(|trajectory| trajectory.name != name) {
            trajectories.push(Trajectory { name, ..Trajectory::default() });
        }
        if let Some(trajectory) = trajectories.last_mut() {
            trajectory.times.push(time);
            trajectory.points.push([x, y, z]);
        }
    }
    Ok(trajectories)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn charts_and_paths_are_tables() {
        let folder = tempfile::tempdir().unwrap();
        let series = |name: &str, errors| ChartSeries {
            name: name.into(),
            points: vec![[0.5, 1e-7], [1.5, f64::NAN]],
            errors,
            ..ChartSeries::default()
        };
        let series = vec![series("measured, all", vec![0.1, 0.2]), series("Maxwell", vec![])];
        write_chart(folder.path(), &Chart { name: "speeds".into(), series, ..Chart::default() }).unwrap();
        let text = fs::read_to_string(folder.path().join("speeds.csv")).unwrap();
        assert_eq!(
            text,
            "series,x,y,error\n\"measured, all\",0.5,1e-7,0.1\n\"measured, all\",1.5,NaN,0.2\n\
             Maxwell,0.5,1e-7,\nMaxwell,1.5,NaN,\n"
        );
        let trajectory = Trajectory { name: "ball 0".into(), times: vec![0.25], points: vec![[1.0, 2.0, 0.0]] };
        write_paths(folder.path(), std::slice::from_ref(&trajectory)).unwrap();
        let text = fs::read_to_string(folder.path().join("path.csv")).unwrap();
        assert_eq!(text, "path,time_s,x,y,z\nball 0,0.25,1,2,0\n");
        assert_eq!(read_paths(folder.path()).unwrap(), [trajectory]);
        fs::write(folder.path().join("path.csv"), "path,time_s,x,y,z\nball 0,soon,1,2,0\n").unwrap();
        assert!(read_paths(folder.path()).unwrap_err().to_string().contains("path.csv"));
    }
}

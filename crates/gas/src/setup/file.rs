//! Balls from a file: extended XYZ, as OVITO and ASE write it, or a table as CSV; so a run can go on from a frame of another.

use super::Ball;
use corpuscle_model::ModelError;
use corpuscle_scene::{is_name, read_text};
use std::path::Path;

/// Names of columns that say the same: those of `corpuscle run --frames csv` first.
const POSITION: [&[&str]; 3] = [&["x", "pos_0"], &["y", "pos_1"], &["z", "pos_2"]];
const VELOCITY: [&[&str]; 3] = [&["vx", "velo_0", "vel_0"], &["vy", "velo_1", "vel_1"], &["vz", "velo_2", "vel_2"]];
const NAME: &[&str] = &["set", "species", "name"];
/// Longest name of balls: names of charts' files have it in them.
const LONGEST_NAME: usize = 100;

/// Reads the balls of a file, whose name ends in `.xyz`, `.extxyz` or `.csv`. Needed are positions, radius and mass; velocities that are not there are 0, names
/// that are not there `balls`.
///
/// # Errors
/// [`ModelError::Setup`] with file and line.
pub(crate) fn read<const D: usize>(path: &Path) -> Result<Vec<Ball<D>>, ModelError> {
    let wrong = |what: String| ModelError::Setup(format!("{}{what}", path.display()));
    let text = read_text(path).map_err(|error| wrong(format!(": gas.start_file cannot be read: {error}")))?;
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    let table = match ending.as_str() {
        "xyz" | "extxyz" => Table::of_xyz(&text),
        "csv" => Table::of_csv(&text),
        _ => Err(": gas.start_file must end in .xyz, .extxyz or .csv".into()),
    };
    table.and_then(|table| table.balls()).map_err(wrong)
}

/// Rows of words, with the names of their columns.
struct Table<'a> {
    names: Vec<String>,
    /// Each with the number of its line.
    rows: Vec<(usize, Vec<&'a str>)>,
}

impl<'a> Table<'a> {
    /// A row for each ball, below a row of names.
    fn of_csv(text: &'a str) -> Result<Self, String> {
        let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
        let cells = |line: &'a str| line.split(',').map(str::trim).collect::<Vec<_>>();
        let (_, head) = lines.next().ok_or(": it is empty")?;
        let names = cells(head).into_iter().map(str::to_owned).collect();
        Ok(Self { names, rows: lines.map(|(number, line)| (number + 1, cells(line))).collect() })
    }

    /// The first frame of a file in extended XYZ (github.com/libAtoms/extxyz): `pos:R:3` is the columns `pos_0`, `pos_1` and `pos_2`.
    fn of_xyz(text: &'a str) -> Result<Self, String> {
        let mut lines = text.lines().enumerate();
        let count = lines.next().and_then(|(_, line)| line.trim().parse::<usize>().ok());
        let count = count.ok_or(":1: here must be the number of balls")?;
        let about = lines.next().map_or("", |(_, line)| line);
        let properties = about.split_whitespace().find_map(|word| word.strip_prefix("Properties="));
        let properties = properties.ok_or(
            ":2: here must be what stands in the columns, as in Properties=species:S:1:pos:R:3:velo:R:3:radius:R:1:mass:R:1",
        )?;
        let mut names = Vec::new();
        let words: Vec<&str> = properties.split(':').collect();
        for of in words.chunks(3) {
            match of {
                [name, _, "1"] => names.push((*name).to_owned()),
                [name, _, width] if width.parse::<usize>().is_ok_and(|width| width <= 100) => {
                    names.extend((0..width.parse().unwrap_or(0)).map(|k: usize| format!("{name}_{k}")));
                }
                _ => return Err(format!(":2: Properties have a column `{}` without a kind and a width", of.join(":"))),
            }
        }
        let rows: Vec<_> =
            lines.take(count).map(|(number, line)| (number + 1, line.split_whitespace().collect())).collect();
        if rows.len() < count {
            return Err(format!(": it has {} balls where its first line says {count}", rows.len()));
        }
        Ok(Self { names, rows })
    }

    fn column(&self, names: &[&str]) -> Option<usize> {
        names.iter().find_map(|wanted| self.names.iter().position(|name| name == wanted))
    }

    fn needed(&self, names: &[&str]) -> Result<usize, String> {
        let missing = || format!(": it has no column `{}` (there are: {})", names[0], self.names.join(", "));
        self.column(names).ok_or_else(missing)
    }

    fn balls<const D: usize>(&self) -> Result<Vec<Ball<D>>, String> {
        let position = POSITION[..D].iter().map(|names| self.needed(names)).collect::<Result<Vec<_>, _>>()?;
        let (radius, mass) = (self.needed(&["radius"])?, self.needed(&["mass"])?);
        let (velocity, name) = (VELOCITY.map(|names| self.column(names)), self.column(NAME));
        let above = if D == 2 { self.column(POSITION[2]) } else { None };
        let ball = |(line, words): &(usize, Vec<&str>)| {
            if words.len() != self.names.len() {
                return Err(format!(":{line}: {} values stand here, and {} columns", words.len(), self.names.len()));
            }
            let number = |column: usize| {
                let value = words[column].parse::<f64>().ok().filter(|value| value.is_finite());
                value.ok_or_else(|| {
                    format!(":{line}: `{}` ({}) is not a finite number", words[column], self.names[column])
                })
            };
            if above.map(number).transpose()?.is_some_and(|z| z != 0.0) {
                return Err(format!(":{line}: z is not 0, and the gas has two dimensions"));
            }
            let name = name.map_or("balls", |column| words[column]);
            if !is_name(name) || name.len() > LONGEST_NAME {
                return Err(format!(
                    ":{line}: the name `{}` must be of letters, digits, spaces, `_` and `-`, {LONGEST_NAME} bytes at most",
                    name.escape_debug()
                ));
            }
            let mut ball = Ball {
                name: name.to_owned(),
                position: [0.0; D],
                velocity: [0.0; D],
                radius: number(radius)?,
                mass: number(mass)?,
            };
            for axis in 0..D {
                ball.position[axis] = number(position[axis])?;
                ball.velocity[axis] = velocity[axis].map(number).transpose()?.unwrap_or(0.0);
            }
            Ok(ball)
        };
        self.rows.iter().map(ball).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn balls<const D: usize>(name: &str, text: &str) -> Result<Vec<Ball<D>>, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        read(&path).map_err(|error| error.to_string())
    }

    #[test]
    fn both_forms_say_the_same() {
        let xyz = "2\nLattice=\"4 0 0 0 4 0 0 0 4\" Properties=species:S:1:pos:R:3:id:I:1:velo:R:3:radius:R:1:mass:R:1 Time=0\n\
                   light 1 2 3 0 0.5 0 -1e-3 0.25 2\nheavy 3 2 1 1 0 0 0 0.5 7\nnot read";
        let csv = "set,id,x,y,z,vx,vy,vz,radius,mass\nlight,0,1,2,3,0.5,0,-1e-3,0.25,2\n\nheavy,1,3,2,1,0,0,0,0.5,7\n";
        let [one, other] = [balls::<3>("a.xyz", xyz).unwrap(), balls::<3>("a.csv", csv).unwrap()];
        assert_eq!(one, other);
        assert_eq!((one[0].name.as_str(), one[0].velocity, one[1].mass), ("light", [0.5, 0.0, -1e-3], 7.0));
        let least = balls::<2>("a.csv", "x,y,radius,mass\n1,2,0.5,1\n").unwrap();
        assert_eq!((least[0].name.as_str(), least[0].position, least[0].velocity), ("balls", [1.0, 2.0], [0.0; 2]));
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        for (name, text, words) in [
            ("a.txt", "", "must end in .xyz"),
            ("a.csv", "", "it is empty"),
            ("a.csv", "x,y,mass\n", "no column `radius` (there are: x, y, mass)"),
            ("a.csv", "x,y,radius,mass\n1,2,0.5\n", "a.csv:2: 3 values stand here, and 4 columns"),
            ("a.csv", "x,y,radius,mass\n1,2,0.5,1\n1,two,0.5,1\n", "a.csv:3: `two` (y) is not a finite number"),
            ("a.csv", "x,y,radius,mass\n1,nan,0.5,1\n", "`nan` (y) is not a finite number"),
            ("a.csv", "x,y,z,radius,mass\n1,2,3,0.5,1\n", "z is not 0"),
            (
                "a.csv",
                "set,x,y,radius,mass\na,1,2,0.5,1\na/b,2,2,0.5,1\n",
                "a.csv:3: the name `a/b` must be of letters",
            ),
            ("a.csv", "set,x,y,radius,mass\n,1,2,0.5,1\n", "a.csv:2: the name `` must be of letters"),
            (
                "a.xyz",
                "1\nProperties=species:S:1:pos:R:3:radius:R:1:mass:R:1\n../x 1 1 0 1 1\n",
                "a.xyz:3: the name `../x`",
            ),
            ("a.xyz", "two\n", "a.xyz:1: here must be the number"),
            ("a.xyz", "1\nnothing\nC 0 0 0\n", "a.xyz:2: here must be what stands in the columns"),
            ("a.xyz", "1\nProperties=pos:R\n", "column `pos:R`"),
            ("a.xyz", "2\nProperties=pos:R:3:radius:R:1:mass:R:1\n1 1 0 1 1\n", "1 balls where its first line says 2"),
        ] {
            let error = balls::<2>(name, text).unwrap_err();
            assert!(error.contains(words), "{error}");
        }
    }
}

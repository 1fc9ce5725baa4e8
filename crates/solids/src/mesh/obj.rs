//! Wavefront OBJ: corners (`v`) and faces (`f`). Everything else in such a file does not bound the solid and is passed over.

use super::Triangles;
use super::read::{add_polygon, refuse_too_many};

pub(super) fn read(content: &[u8]) -> Result<Triangles, String> {
    let text = String::from_utf8_lossy(content);
    let mut found = Triangles::default();
    // A face may name corners that stand below it: faces are checked at the end.
    let mut last_line = 0;
    let mut highest = 0;
    for (number, line) in (1..).zip(text.lines()) {
        let wrong = |what: String| format!("this is not an OBJ that can be read: line {number}: {what}");
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => found.corners.push(corner(words).ok_or_else(|| wrong("`v` must have three numbers".into()))?),
            Some("f") => {
                let corners = words.map(|word| index(word, found.corners.len())).collect::<Result<Vec<_>, _>>();
                let corners = corners.map_err(wrong)?;
                let largest = corners.iter().copied().max().unwrap_or(0);
                if largest >= highest {
                    (highest, last_line) = (largest, number);
                }
                refuse_too_many(found.triangles.len() + corners.len().saturating_sub(2))?;
                add_polygon(&corners, &mut found.triangles);
            }
            _ => {}
        }
    }
    if !found.triangles.is_empty() && highest as usize >= found.corners.len() {
        return Err(format!(
            "this is not an OBJ that can be read: line {last_line}: it names corner {}, and there are {}",
            u64::from(highest) + 1,
            found.corners.len()
        ));
    }
    Ok(found)
}

fn corner<'a>(mut words: impl Iterator<Item = &'a str>) -> Option<[f64; 3]> {
    let mut next = || words.next()?.parse().ok();
    Some([next()?, next()?, next()?])
}

/// The corner that a word of a face names: counted from 1, or backwards from the last of the `count` above it; what follows a `/` is of its
/// texture and its normal.
fn index(word: &str, count: usize) -> Result<u32, String> {
    let number = word.split('/').next().unwrap_or_default();
    let told: i64 = number.parse().map_err(|_| format!("`{word}` names no corner"))?;
    let from_zero = if told < 0 {
        i64::try_from(count).ok().and_then(|count| count.checked_add(told))
    } else {
        told.checked_sub(1)
    };
    let from_zero = from_zero.and_then(|index| u32::try_from(index).ok());
    from_zero.ok_or_else(|| {
        format!("`{word}` names no corner; corners are counted from 1, or from -1 backwards, and {count} stand above")
    })
}

#[cfg(test)]
mod tests {
    use super::read;

    fn refused(text: &str) -> String {
        read(text.as_bytes()).unwrap_err()
    }

    const CORNERS: &str = "v 0 0 0\nv 1 0 0 1\nv 1 1 0\nv 0 1 0 0.5 0.5 0.5\n";

    #[test]
    fn faces_name_corners_in_any_way() {
        for faces in
            ["f 1 2 3 4", "f -4 -3 -2 -1", "f 1/1 2/1/1 3//1 4/2/", "g a\nusemtl b\nf 1 2 3\nf 1 3 4\nl 1 9\np 1"]
        {
            let found = read(format!("# \u{fffd}\n{CORNERS}vn 0 0 1\nvt 0 0\n{faces}\n").as_bytes()).unwrap();
            assert_eq!(found.triangles, [[0, 1, 2], [0, 2, 3]], "{faces}");
            assert_eq!(found.corners[3], [0.0, 1.0, 0.0]);
        }
        let below = read(format!("f 1 2 3\n{CORNERS}").as_bytes()).unwrap();
        assert_eq!(below.triangles, [[0, 1, 2]]);
    }

    /// The library that read these before multiplied indices without a check: in a release build a far one became a near one.
    #[test]
    fn corners_that_there_are_not_are_refused_with_their_line() {
        for (face, hint) in [
            ("f 1 2 5", "line 5: it names corner 5, and there are 4"),
            ("f 1 2 0", "line 5: `0` names no corner"),
            ("f 1 2 -5", "line 5: `-5` names no corner"),
            ("f 1 2 9223372036854775807", "line 5: `9223372036854775807` names no corner"),
            ("f 1 2 -9223372036854775808", "names no corner"),
            ("f 1 2 6148914691236517206", "names no corner"),
            ("f 1 2 4294967296", "it names corner 4294967296, and there are 4"),
            ("f 1 /2 3", "line 5: `/2` names no corner"),
        ] {
            let words = refused(&format!("{CORNERS}{face}\n"));
            assert!(words.contains(hint), "{face}: {words}");
        }
        assert!(refused("v 1 2\n").contains("line 1: `v` must have three numbers"));
        assert!(refused("v 1 2 x\n").contains("three numbers"));
    }
}

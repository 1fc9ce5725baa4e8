//! Shaders joined from pieces.
//!
//! A line `#import name` stands for the piece of that name, which is included once however often it is imported. Pieces may
//! import pieces.

use crate::ImportError;
use std::collections::HashSet;

/// Pieces that shaders can import: name, which is that of the file without `.wgsl`, and text.
pub type ShaderLibrary<'a> = &'a [(&'a str, &'a str)];

/// The piece `sums_before`: the sum of a number over the threads of a group before each, and over all. The declaration of the shader that imports it
/// has `GROUP`, the number of threads.
pub const SUMS_BEFORE: (&str, &str) = ("sums_before", include_str!("sums_before.wgsl"));

/// The piece `compensated_sums`: sums without error in pairs of numbers (see [`to_pair`](crate::to_pair)), and counts of more than 32 bits. The declaration of the shader that imports
/// it has a buffer `parameters` with a member `zero`, which is always 0.
pub const COMPENSATED_SUMS: (&str, &str) = ("compensated_sums", include_str!("compensated_sums.wgsl"));

/// The piece `group_reduction`: the values of the threads of a group combined into one.
pub const GROUP_REDUCTION: (&str, &str) = ("group_reduction", include_str!("group_reduction.wgsl"));

/// The text of a shader with everything it imports before it; `name` is for errors.
///
/// # Errors
/// [`ImportError::Missing`].
pub fn join(name: &str, text: &str, library: ShaderLibrary<'_>) -> Result<String, ImportError> {
    let mut joined = String::new();
    append(name, text, library, &mut HashSet::from([name.to_owned()]), &mut joined)?;
    Ok(joined)
}

fn append(
    name: &str,
    text: &str,
    library: ShaderLibrary<'_>,
    taken: &mut HashSet<String>,
    joined: &mut String,
) -> Result<(), ImportError> {
    let mut own = String::new();
    for (index, line) in text.lines().enumerate() {
        let Some(piece) = line.strip_prefix("#import ").map(str::trim) else {
            own.push_str(line);
            own.push('\n');
            continue;
        };
        if taken.insert(piece.to_owned()) {
            let missing = || ImportError::Missing { shader: name.into(), line: index + 1, piece: piece.into() };
            let (_, text) = library.iter().find(|(name, _)| *name == piece).ok_or_else(missing)?;
            append(piece, text, library, taken, joined)?;
        }
    }
    joined.push_str(&own);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_come_first_and_once() {
        let library = [("a", "#import b\nconst A = B;"), ("b", "const B = 1;")];
        let text = join("main", "#import a\n#import b\nconst C = A + B;", &library).unwrap();
        assert_eq!(text, "const B = 1;\nconst A = B;\nconst C = A + B;\n");
    }

    #[test]
    fn a_ring_of_imports_ends() {
        let library = [("a", "#import b\nconst A = 1;"), ("b", "#import a\nconst B = 1;")];
        assert_eq!(join("main", "#import a", &library).unwrap(), "const B = 1;\nconst A = 1;\n");
    }

    #[test]
    fn what_is_missing_is_named_with_its_line() {
        let error = join("main", "const A = 1;\n#import light", &[]).unwrap_err();
        assert_eq!(error, ImportError::Missing { shader: "main".into(), line: 2, piece: "light".into() });
    }
}

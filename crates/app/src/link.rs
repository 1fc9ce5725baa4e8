//! Links to scenes: what a page's address opens, and the address of what is open. See [`SceneLink`].

use crate::{Source, Start};
use corpuscle::scene::{SceneLink, builtin};

/// What a link opens; `#` before it may be there.
///
/// # Errors
/// A text that says what is wrong with it.
pub fn read(link: &str) -> Result<Start, String> {
    let Some(SceneLink { name, changes }) = SceneLink::read(link)? else { return Ok(Start::Welcome) };
    let scene = builtin(&name).ok_or_else(|| format!("The link names a scene that is not there: {name}"))?;
    Ok(Start::Scene(Source { changes, ..scene.into() }))
}

/// The link to a built-in scene with changes; none for another scene.
pub fn to(source: &Source, changes: &[(String, String)]) -> Option<String> {
    SceneLink::write(&source.name, changes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(link: &str) -> Source {
        let Start::Scene(source) = read(link).unwrap() else { panic!("{link}") };
        source
    }

    #[test]
    fn a_link_is_the_scene_with_its_changes() {
        let source = scene("#gas/maxwell?gas.species.0.count=2000&seed=7");
        assert_eq!(source.name, "gas/maxwell");
        assert_eq!(source.scene().unwrap().seed, 7);
        assert_eq!(to(&source, &source.changes).unwrap(), "gas/maxwell?gas.species.0.count=2000&seed=7");
    }

    #[test]
    fn any_change_comes_back() {
        let source = scene("flood/dam-break");
        let changes = vec![("flood.gauge.2".to_owned(), "{ name = \"a & b #1 = 50 %\", at = [1.0, -2.5] }".to_owned())];
        let link = to(&source, &changes).unwrap();
        assert!(link.is_ascii() && !link.contains(' ') && !link.contains('"'), "{link}");
        assert_eq!(scene(&link).changes, changes);
    }

    #[test]
    fn what_is_wrong_with_a_link_is_told() {
        assert!(matches!(read(""), Ok(Start::Welcome)));
        for (link, told) in [("#gas/none", "gas/none"), ("gas/maxwell?seed", "seed"), ("%FF?a=b", "%FF")] {
            assert!(read(link).unwrap_err().contains(told), "{link}");
        }
    }
}

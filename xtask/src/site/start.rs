//! The start page: a live picture of each model, and the gallery.

use super::write as write_file;
use anyhow::{Context, Result};
use corpuscle_scene::{Builtin, Scene, Terrain, kinds};
use std::fmt::Write;
use std::path::Path;

/// The scenes that are live on the start page.
const LIVE: [&str; 3] = ["gas/maxwell", "dew/pane", "flood/valley"];

/// What the gallery says of a scene that a page refuses.
const REFUSED: &str =
    "<span class=\"refused\">Not in a page: its terrain is fetched over a network. It runs with the program.</span>";

/// Writes the page with its pictures.
///
/// # Errors
/// Where a scene or its picture is missing, or a file cannot be written.
pub fn write(root: &Path, out: &Path) -> Result<()> {
    let (mut live, mut gallery) = (String::new(), String::new());
    for kind in kinds().into_iter().filter(|kind| !kind.scenes.is_empty()) {
        let (first, rest) = kind.name.split_at(1);
        let _ = write!(gallery, "<h3>{}{rest}</h3>\n<ul class=\"gallery\">\n", first.to_uppercase());
        for scene in kind.scenes {
            let card = Card::of(*scene, root, out)?;
            let _ = writeln!(gallery, "{}", card.html());
            if LIVE.contains(&scene.name) {
                let _ = writeln!(live, "{}", card.live());
            }
        }
        gallery.push_str("</ul>\n");
    }
    let page = include_str!("../../pages/start.html").replace("{live}", &live).replace("{gallery}", &gallery);
    write_file(&out.join("index.html"), page.as_bytes())
}

struct Card {
    name: &'static str,
    title: String,
    sentence: String,
    image: String,
    /// True where a page refuses it: its terrain is fetched over a network.
    is_refused: bool,
}

impl Card {
    /// The card of a scene; its picture is copied.
    fn of(scene: Builtin, root: &Path, out: &Path) -> Result<Self> {
        let parsed = Scene::parse(scene.text, scene.name, &[])?;
        let is_refused = parsed.flood().is_some_and(|flood| matches!(flood.terrain, Terrain::Fetch(_)));
        let Scene { title, description, .. } = parsed;
        let stem = format!("scene-{}", scene.name.replace('/', "-"));
        let folder = root.join("docs/src/images");
        let found =
            ["jpg", "png"].map(|ending| format!("{stem}.{ending}")).into_iter().find(|file| folder.join(file).exists());
        let image = found.with_context(|| format!("{} has no picture {stem} in docs/src/images", scene.name))?;
        write_file(&out.join("images").join(&image), &std::fs::read(folder.join(&image))?)?;
        let description = description.split_whitespace().collect::<Vec<_>>().join(" ");
        let sentence = description.split_inclusive(". ").next().unwrap_or_default().trim_end().to_owned();
        Ok(Self { name: scene.name, title, sentence, image, is_refused })
    }

    fn html(&self) -> String {
        let Self { name, image, .. } = self;
        let (title, sentence) = (escaped(&self.title), escaped(&self.sentence));
        let refused = if self.is_refused { REFUSED } else { "" };
        format!(
            "<li><a href=\"app/#{name}\"><img src=\"images/{image}\" alt=\"\" loading=\"lazy\"><strong>{title}</strong><span>{sentence}</span>{refused}</a></li>"
        )
    }

    fn live(&self) -> String {
        let Self { name, image, .. } = self;
        let title = escaped(&self.title);
        format!(
            "<figure data-scene=\"{name}\"><div class=\"picture\"><img src=\"images/{image}\" alt=\"{title}\"></div><figcaption><a href=\"app/#{name}\">{title}</a></figcaption></figure>"
        )
    }
}

/// A text in a page.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

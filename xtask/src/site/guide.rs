//! The guide as pages: the Markdown of `docs/src`, in the order of its summary.

use super::write as write_file;
use anyhow::{Context, Result, ensure};
use pulldown_cmark::{CowStr, Event, HeadingLevel, Options, Parser, Tag, TagEnd, html};
use serde::Serialize;
use std::collections::HashMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Writes all pages and the files that they show.
///
/// # Errors
/// Where a page is missing, or a file cannot be written.
pub fn write(source: &Path, out: &Path) -> Result<()> {
    let read = |name: &str| fs::read_to_string(source.join(name)).with_context(|| format!("docs/src/{name}"));
    let summary = read("SUMMARY.md")?;
    let pages = pages(&summary);
    ensure!(!pages.is_empty(), "docs/src/SUMMARY.md names no page");
    let mut sections = Vec::new();
    for page in &pages {
        let navigation =
            page_html(&summary).replace(&format!("href=\"{}\"", html_name(page)), "class=\"here\" href=\"\"");
        let text = read(page)?;
        let content = page_html(&text);
        let whole = include_str!("../../pages/guide.html")
            .replace("{title}", &title(&text))
            .replace("{navigation}", &navigation)
            .replace("{content}", &content);
        write_file(&out.join(html_name(page)), whole.as_bytes())?;
        sections.extend(sections_of(page, &text));
    }
    write_file(&out.join("search.json"), &serde_json::to_vec(&sections)?)?;
    write_file(&out.join("search.js"), include_bytes!("../../pages/search.js"))?;
    let first = html_name(&pages[0]);
    let forward = format!(
        "<!doctype html><meta charset=\"utf-8\"><meta http-equiv=\"refresh\" content=\"0; url={first}\"><a href=\"{first}\">The guide</a>"
    );
    write_file(&out.join("index.html"), forward.as_bytes())?;
    write_file(&out.join("guide.css"), include_bytes!("../../pages/guide.css"))?;
    for file in super::files(source)?.iter().filter(|file| file.extension().is_none_or(|ending| ending != "md")) {
        write_file(&out.join(file), &fs::read(source.join(file))?)?;
    }
    Ok(())
}

/// What the search finds: a heading of a page with the text below it, up to the next.
#[derive(Debug, Serialize)]
struct Section {
    /// Its address in the guide.
    link: String,
    /// The title of its page.
    page: String,
    heading: String,
    text: String,
}

/// The sections of a page.
fn sections_of(page: &str, text: &str) -> Vec<Section> {
    let events: Vec<_> = Parser::new_ext(text, options()).collect();
    let (mut known, mut sections, mut is_heading) = (HashMap::new(), Vec::<Section>::new(), false);
    for (at, event) in events.iter().enumerate() {
        if let Event::Start(Tag::Heading { .. }) = event {
            let link = format!("{}#{}", html_name(page), anchor(&events[at + 1..], &mut known));
            is_heading = true;
            sections.push(Section { link, page: title(text), heading: String::new(), text: String::new() });
        }
        let Some(section) = sections.last_mut() else { continue };
        let into = if is_heading { &mut section.heading } else { &mut section.text };
        match event {
            Event::Text(part) | Event::Code(part) => into.push_str(part),
            Event::SoftBreak | Event::HardBreak => into.push(' '),
            Event::End(TagEnd::Heading(_)) => is_heading = false,
            Event::End(TagEnd::Paragraph | TagEnd::Item | TagEnd::TableCell | TagEnd::CodeBlock) => into.push(' '),
            _ => {}
        }
    }
    for section in &mut sections {
        section.text = section.text.split_whitespace().collect::<Vec<_>>().join(" ");
    }
    sections
}

/// The pages that the summary names, in order.
fn pages(summary: &str) -> Vec<String> {
    let links = Parser::new(summary).filter_map(|event| match event {
        Event::Start(Tag::Link { dest_url, .. }) => Some(dest_url.to_string()),
        _ => None,
    });
    links.filter(|link| link.ends_with(".md")).collect()
}

/// The file that a page is written to.
fn html_name(page: &str) -> String {
    page.strip_suffix(".md").map_or_else(|| page.to_owned(), |stem| format!("{stem}.html"))
}

/// The text of the first heading.
fn title(text: &str) -> String {
    let mut inside = false;
    let mut title = String::new();
    for event in Parser::new(text) {
        match event {
            Event::Start(Tag::Heading { .. }) => inside = true,
            Event::End(TagEnd::Heading(_)) => break,
            Event::Text(part) | Event::Code(part) if inside => title.push_str(&part),
            _ => {}
        }
    }
    title
}

/// A page's Markdown as HTML: links lead to pages of the site, headings can be linked to, tables scroll by themselves.
fn page_html(text: &str) -> String {
    let events: Vec<_> = Parser::new_ext(text, options()).collect();
    let mut known = HashMap::new();
    let mut written = Vec::with_capacity(events.len());
    for (at, event) in events.iter().enumerate() {
        match event {
            Event::Start(Tag::Link { link_type, dest_url, title, id }) => {
                let (link_type, title, id) = (*link_type, title.clone(), id.clone());
                written.push(Event::Start(Tag::Link { link_type, dest_url: linked(dest_url), title, id }));
            }
            Event::Start(Tag::Heading { level, .. }) => {
                let name = anchor(&events[at + 1..], &mut known);
                written.push(Event::InlineHtml(format!("<{} id=\"{name}\">", tag(*level)).into()));
            }
            Event::End(TagEnd::Heading(level)) => {
                written.push(Event::InlineHtml(format!("</{}>\n", tag(*level)).into()))
            }
            Event::Start(Tag::Table(_)) => {
                written.push(Event::Html("<div class=\"table-wrapper\">".into()));
                written.push(event.clone());
            }
            Event::End(TagEnd::Table) => {
                written.push(event.clone());
                written.push(Event::Html("</div>".into()));
            }
            event => written.push(event.clone()),
        }
    }
    let mut html = String::new();
    html::push_html(&mut html, written.into_iter());
    html
}

/// The extensions of Markdown that the guide has.
fn options() -> Options {
    Options::ENABLE_TABLES | Options::ENABLE_FOOTNOTES | Options::ENABLE_STRIKETHROUGH
}

fn tag(level: HeadingLevel) -> String {
    level.to_string()
}

/// A link of the guide as a link of the site.
fn linked(link: &str) -> CowStr<'static> {
    if link.contains("://") {
        return link.to_owned().into();
    }
    let (page, place) = link.split_once('#').map_or((link, String::new()), |(page, place)| (page, format!("#{place}")));
    format!("{}{place}", html_name(page)).into()
}

/// The name of a heading: its words in lower case, joined by `-`; a second of the same name has a number.
fn anchor(after: &[Event<'_>], known: &mut HashMap<String, usize>) -> String {
    let mut name = String::new();
    for event in after {
        match event {
            Event::End(TagEnd::Heading(_)) => break,
            Event::Text(part) | Event::Code(part) => {
                for letter in part.chars().flat_map(char::to_lowercase) {
                    match letter {
                        ' ' => name.push('-'),
                        letter if letter.is_alphanumeric() || "-_".contains(letter) => name.push(letter),
                        _ => {}
                    }
                }
            }
            _ => {}
        }
    }
    let before = known.entry(name.clone()).or_default();
    *before += 1;
    if *before > 1 {
        let _ = write!(name, "-{}", *before - 1);
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    fn source() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/src")
    }

    /// All values of an attribute in a page.
    fn values<'a>(html: &'a str, attribute: &str) -> Vec<&'a str> {
        let begin = format!("{attribute}=\"");
        html.split(&*begin).skip(1).filter_map(|rest| rest.split('"').next()).collect()
    }

    #[test]
    fn every_link_of_the_guide_leads_to_a_place_that_is_there() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("guide");
        write(&source(), &out).unwrap();
        let mut links = 0;
        for file in super::super::files(&out).unwrap() {
            if file.extension().is_none_or(|ending| ending != "html") {
                continue;
            }
            let html = fs::read_to_string(out.join(&file)).unwrap();
            let local = |link: &&&str| !link.contains("://") && !link.starts_with("../") && !link.starts_with("data:");
            for link in values(&html, "href").iter().chain(&values(&html, "src")).filter(local) {
                let (page, place) = link.split_once('#').unwrap_or((link, ""));
                let target = if page.is_empty() { file.clone() } else { page.into() };
                assert!(out.join(&target).exists(), "{}: {link}", file.display());
                if !place.is_empty() {
                    let other = fs::read_to_string(out.join(&target)).unwrap();
                    assert!(values(&other, "id").contains(&place), "{}: {link}", file.display());
                }
                links += 1;
            }
        }
        assert!(links > 1000, "{links}");
        let sections =
            serde_json::from_slice::<Vec<HashMap<String, String>>>(&fs::read(out.join("search.json")).unwrap());
        let sections = sections.unwrap();
        for link in sections.iter().map(|section| &section["link"]) {
            let (page, place) = link.split_once('#').unwrap();
            let html = fs::read_to_string(out.join(page)).unwrap();
            assert!(values(&html, "id").contains(&place), "{link}");
        }
        assert!(sections.len() > 300, "{}", sections.len());
    }

    #[test]
    fn sections_have_their_place_and_their_text() {
        let sections =
            sections_of("a.md", "# A `b`\n\nOne\ntwo.\n\n| x | y |\n|---|---|\n| 1 | `2` |\n\n## A b\n\nThree.\n");
        let [first, second] = &sections[..] else { panic!("{sections:?}") };
        assert_eq!(
            [&first.link, &first.page, &first.heading, &first.text],
            ["a.html#a-b", "A b", "A b", "One two. x y 1 2"]
        );
        assert_eq!([&second.link, &second.heading, &second.text], ["a.html#a-b-1", "A b", "Three."]);
    }

    #[test]
    fn headings_of_one_name_are_told_apart() {
        let html = page_html("# A `b` c\n\n## A b c\n\n[there](gas.md#a-b-c)\n");
        assert!(html.contains("<h1 id=\"a-b-c\">A <code>b</code> c</h1>"), "{html}");
        assert!(html.contains("<h2 id=\"a-b-c-1\">") && html.contains("href=\"gas.html#a-b-c\""), "{html}");
        assert_eq!(title("# A `b` c\n\ntext"), "A b c");
    }
}

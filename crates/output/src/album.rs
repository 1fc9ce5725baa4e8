//! Pictures and film of a run in its report.

use crate::OutputError;
use crate::whole::write_bytes;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use corpuscle_drawing::png::decode_rgba;
use corpuscle_scene::{read_bytes, read_text};
use jpeg_encoder::{ColorType, Encoder};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// Markers round the section in the page.
const START: &str = "<!-- pictures -->\n";
const END: &str = "<!-- /pictures -->\n";
/// Most pictures in the page, and their largest width, pixels.
const MOST: usize = 6;
const WIDTH: usize = 800;
/// Quality of the JPEG files in the page, of 100.
const QUALITY: u8 = 85;
/// Largest film embedded in the page, bytes; a larger one is linked.
const LARGEST_FILM: u64 = 4 << 20;

/// Puts the pictures of a run (`pictures/picture_*.png`, six of them at most, smaller than they are) and its film (`film.mp4`) into its
/// report, before all figures, in place of those that were there. False where the run has no report.
///
/// # Errors
/// [`OutputError::Read`], [`OutputError::Write`]; [`OutputError::Content`] for a picture that cannot be read.
pub fn put_into_report(folder: &Path) -> Result<bool, OutputError> {
    let path = folder.join("report.html");
    if !path.exists() {
        return Ok(false);
    }
    let page = read_text(&path).map_err(OutputError::read(&path))?;
    let page = without_album(&page);
    let at = page.find("<section>").ok_or_else(|| OutputError::content(&path, "it has no sections"))?;
    let page = [&page[..at], &album(folder)?, &page[at..]].concat();
    write_bytes(&path, page.as_bytes())?;
    Ok(true)
}

fn without_album(page: &str) -> String {
    match (page.find(START), page.find(END)) {
        (Some(start), Some(end)) if start < end => [&page[..start], &page[end + END.len()..]].concat(),
        _ => page.to_owned(),
    }
}

/// The pictures and the film as a part of the page; empty where there are none.
fn album(folder: &Path) -> Result<String, OutputError> {
    let mut html = film(folder)?;
    let mut figures = String::new();
    for (number, path) in chosen(pictures(folder)).iter().enumerate() {
        let jpeg = STANDARD.encode(small(path)?);
        let of = format!("Picture {} of the run", number + 1);
        let _ = writeln!(figures, "<figure><img alt=\"{of}\" src=\"data:image/jpeg;base64,{jpeg}\"></figure>");
    }
    if !figures.is_empty() {
        let _ = write!(html, "<div class=\"pair\">\n{figures}</div>\n");
    }
    if html.is_empty() {
        return Ok(html);
    }
    Ok(format!("{START}<section>\n<h2>Pictures</h2>\n{html}</section>\n{END}"))
}

/// The film in the page, or a link to it.
fn film(folder: &Path) -> Result<String, OutputError> {
    let path = folder.join("film.mp4");
    let Ok(length) = fs::metadata(&path).map(|about| about.len()) else { return Ok(String::new()) };
    let link = "<p>The film of the run is <a href=\"film.mp4\">film.mp4</a>, beside this page.</p>\n";
    if length > LARGEST_FILM {
        return Ok(link.into());
    }
    let bytes = STANDARD.encode(read_bytes(&path).map_err(OutputError::read(&path))?);
    let video = "<video controls loop muted playsinline style=\"display:block;width:100%;height:auto\"";
    Ok(format!("<figure>{video} src=\"data:video/mp4;base64,{bytes}\"></video></figure>\n{link}"))
}

/// The files of pictures, in order.
fn pictures(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder.join("pictures")) else { return Vec::new() };
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let is_picture = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("picture_") && name.ends_with(".png")
    };
    let mut pictures: Vec<PathBuf> = paths.filter(is_picture).collect();
    pictures.sort();
    pictures
}

/// Some, spread evenly from the first to the last.
fn chosen(all: Vec<PathBuf>) -> Vec<PathBuf> {
    let last = all.len().saturating_sub(1);
    match all.len() {
        ..=MOST => all,
        _ => (0..MOST).map(|number| all[(number * last + (MOST - 1) / 2) / (MOST - 1)].clone()).collect(),
    }
}

/// A picture as a JPEG file, no wider than a page needs.
fn small(path: &Path) -> Result<Vec<u8>, OutputError> {
    let bytes = read_bytes(path).map_err(OutputError::read(path))?;
    let wrong = |what: String| OutputError::content(path, what);
    let (width, height, rgba) = decode_rgba(&bytes).map_err(wrong)?;
    let (size, rgb) = shrunk([width as usize, height as usize], &rgba);
    let [width, height] = size.map(|length| u16::try_from(length).unwrap_or(u16::MAX));
    let mut jpeg = Vec::new();
    let encoder = Encoder::new(&mut jpeg, QUALITY);
    encoder.encode(&rgb, width, height, ColorType::Rgb).map_err(|error| wrong(error.to_string()))?;
    Ok(jpeg)
}

/// Red, green and blue of a picture at most [`WIDTH`] wide: each pixel the mean of those it stands for.
fn shrunk([width, height]: [usize; 2], rgba: &[u8]) -> ([usize; 2], Vec<u8>) {
    let new_width = width.min(WIDTH);
    let size = [new_width, (height * new_width / width.max(1)).max(1)];
    let part = |at: usize, old: usize, new: usize| at * old / new..((at + 1) * old).div_ceil(new);
    let mut rgb = Vec::with_capacity(3 * size[0] * size[1]);
    for y in 0..size[1] {
        for x in 0..size[0] {
            let mut sums = [0_usize; 3];
            let (rows, columns) = (part(y, height, size[1]), part(x, width, size[0]));
            let count = rows.len() * columns.len();
            for pixel in rows.flat_map(|row| columns.clone().map(move |column| 4 * (row * width + column))) {
                // Where a picture is transparent the page is seen, which is white.
                let opacity = usize::from(rgba[pixel + 3]);
                (0..3).for_each(|k| sums[k] += (opacity * usize::from(rgba[pixel + k]) + (255 - opacity) * 255) / 255);
            }
            rgb.extend(sums.map(|sum| ((sum + count / 2) / count) as u8));
        }
    }
    (size, rgb)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::write_picture;
    use tempfile::TempDir;

    const PAGE: &str = "<main>\n<header>A</header>\n<section>B</section>\n</main>\n";

    #[test]
    fn pictures_and_film_are_in_the_page_once() {
        let folder = TempDir::new().unwrap();
        let at = |name: &str| folder.path().join(name);
        assert!(!put_into_report(folder.path()).unwrap());
        fs::write(at("report.html"), PAGE).unwrap();
        assert!(put_into_report(folder.path()).unwrap());
        assert_eq!(fs::read_to_string(at("report.html")).unwrap(), PAGE);
        for number in 0..9 {
            let picture = at(&format!("pictures/picture_{number:06}.png"));
            write_picture(&picture, [1000, 500], &[90; 4 * 1000 * 500]).unwrap();
        }
        fs::write(at("pictures/max_depth.png"), "not one of them").unwrap();
        fs::write(at("film.mp4"), "film").unwrap();
        put_into_report(folder.path()).unwrap();
        let page = fs::read_to_string(at("report.html")).unwrap();
        put_into_report(folder.path()).unwrap();
        assert_eq!(fs::read_to_string(at("report.html")).unwrap(), page);
        let count = |what: &str| page.matches(what).count();
        assert_eq!(
            (count("data:image/jpeg"), count("data:video/mp4;base64,ZmlsbQ=="), count("<h2>Pictures")),
            (6, 1, 1)
        );
        assert!(page.find("Pictures") < page.find("<section>B"));
        assert_eq!(without_album(&page), PAGE);
        // A truncated picture is an error, and the page stays.
        fs::write(at("pictures/picture_000000.png"), "cut").unwrap();
        assert!(put_into_report(folder.path()).unwrap_err().to_string().contains("picture_000000.png"));
        assert_eq!(fs::read_to_string(at("report.html")).unwrap(), page);
    }

    #[test]
    fn a_large_film_stands_beside_the_page() {
        let folder = TempDir::new().unwrap();
        fs::write(folder.path().join("report.html"), PAGE).unwrap();
        fs::write(folder.path().join("film.mp4"), vec![0; LARGEST_FILM as usize + 1]).unwrap();
        put_into_report(folder.path()).unwrap();
        let page = fs::read_to_string(folder.path().join("report.html")).unwrap();
        assert!(page.contains("href=\"film.mp4\"") && !page.contains("<video"));
    }

    #[test]
    fn shrinking_keeps_the_mean() {
        let rgba: Vec<u8> =
            (0..1600 * 10).flat_map(|pixel| [if pixel % 2 == 0 { 0 } else { 200 }, 10, 20, 255]).collect();
        let (size, rgb) = shrunk([1600, 10], &rgba);
        assert_eq!((size, rgb.len()), ([800, 5], 3 * 800 * 5));
        assert!(rgb.chunks_exact(3).all(|pixel| pixel == [100, 10, 20]));
        // Transparent pixels show the page, which is white.
        let rgba = [[9, 9, 9, 255], [9, 9, 9, 0], [55, 155, 255, 51]].concat();
        assert_eq!(shrunk([3, 1], &rgba), ([3, 1], vec![9, 9, 9, 255, 255, 255, 215, 235, 255]));
    }
}

//! PNG: pictures from pixels, and from SVG with the fonts that come along.

use crate::fonts::{REGULAR, SEMI_BOLD};
use crate::svg::Figure;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb::Database};
use std::sync::{Arc, LazyLock};

/// Width of a picture in pixels, over its width in CSS pixels.
const PIXELS: f32 = 1.6;

/// The only fonts, so that a picture is the same on every machine.
static FONTS: LazyLock<Arc<Database>> = LazyLock::new(|| {
    let mut fonts = Database::new();
    fonts.load_font_data(REGULAR.to_vec());
    fonts.load_font_data(SEMI_BOLD.to_vec());
    Arc::new(fonts)
});

/// A figure as PNG.
///
/// # Errors
/// What cannot be drawn (a figure without extent).
pub fn svg_to_png(figure: &Figure) -> Result<Vec<u8>, String> {
    let tree = tree(&figure.standalone())?;
    let [width, height] = figure.size().map(|length| (length as f32 * PIXELS).round() as u32);
    let mut pixels = Pixmap::new(width, height).ok_or("the figure has no extent")?;
    // The page rectangle may end within the last pixel: none is left transparent, and premultiplied colours are plain.
    pixels.fill(Color::WHITE);
    resvg::render(&tree, Transform::from_scale(PIXELS, PIXELS), &mut pixels.as_mut());
    let rgb: Vec<u8> = pixels.data().chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    encode_rgb(width, height, &rgb)
}

/// A figure without ground as pixels, `scale` of them for a CSS pixel: width, height, and red, green, blue and opacity of each
/// pixel, row by row, the colours multiplied by the opacity.
///
/// # Errors
/// What cannot be drawn (a figure without extent).
pub fn svg_to_pixels(figure: &Figure, scale: f32) -> Result<(u32, u32, Vec<u8>), String> {
    let tree = tree(&figure.transparent())?;
    let [width, height] = figure.size().map(|length| (length as f32 * scale).round() as u32);
    let mut pixels = Pixmap::new(width, height).ok_or("the figure has no extent")?;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixels.as_mut());
    Ok((width, height, pixels.take()))
}

fn tree(svg: &str) -> Result<Tree, String> {
    let options = Options { fontdb: FONTS.clone(), font_family: "Inter".into(), ..Options::default() };
    Tree::from_str(svg, &options).map_err(|error| error.to_string())
}

/// A picture of red, green and blue bytes.
///
/// # Errors
/// What cannot be encoded (bytes that do not fit the size).
pub fn encode_rgb(width: u32, height: u32, rgb: &[u8]) -> Result<Vec<u8>, String> {
    encode(width, height, rgb, |encoder| encoder.set_color(png::ColorType::Rgb))
}

/// A picture of red, green, blue and opacity bytes.
///
/// # Errors
/// What cannot be encoded (bytes that do not fit the size).
pub fn encode_rgba(width: u32, height: u32, rgba: &[u8]) -> Result<Vec<u8>, String> {
    encode(width, height, rgba, |encoder| encoder.set_color(png::ColorType::Rgba))
}

/// A picture of one byte for each pixel that chooses a colour (red, green, blue, opacity).
///
/// # Errors
/// What cannot be encoded (bytes that do not fit the size).
pub fn encode_indexed(width: u32, height: u32, indices: &[u8], palette: &[[u8; 4]]) -> Result<Vec<u8>, String> {
    encode(width, height, indices, |encoder| {
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(palette.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]).collect::<Vec<u8>>());
        encoder.set_trns(palette.iter().map(|colour| colour[3]).collect::<Vec<u8>>());
    })
}

fn encode(
    width: u32,
    height: u32,
    data: &[u8],
    set_up: impl FnOnce(&mut png::Encoder<'_, &mut Vec<u8>>),
) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_depth(png::BitDepth::Eight);
    set_up(&mut encoder);
    let mut writer = encoder.write_header().map_err(|error| error.to_string())?;
    writer.write_image_data(data).map_err(|error| error.to_string())?;
    writer.finish().map_err(|error| error.to_string())?;
    Ok(bytes)
}

/// The most bytes that Deflate packs into one: what a file says to hold beyond that it cannot.
const MOST_PACKED: usize = 1032;

/// Most pixels of a file that has fewer bytes than pixels: those of a photo have more.
const MOST_PIXELS: u64 = 100_000_000;

/// A PNG file of any kind as width, height, and red, green, blue and opacity of each pixel, row by row.
///
/// # Errors
/// What cannot be read; a file that is too short for the pixels that it names, or that unpacks to far more pixels than it has bytes.
pub fn decode_rgba(bytes: &[u8]) -> Result<(u32, u32, Vec<u8>), String> {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::normalize_to_color8() | png::Transformations::ALPHA);
    let mut reader = decoder.read_info().map_err(|error| error.to_string())?;
    let header = reader.info();
    let packed = header.raw_row_length().saturating_mul(header.height as usize);
    if packed / MOST_PACKED > bytes.len() {
        return Err(format!("{} x {} pixels cannot be in {} bytes", header.width, header.height, bytes.len()));
    }
    let pixels = u64::from(header.width) * u64::from(header.height);
    if pixels > MOST_PIXELS.max(bytes.len() as u64) {
        return Err(format!(
            "it has {} x {} pixels, far more than bytes; {MOST_PIXELS} are possible",
            header.width, header.height
        ));
    }
    let colours = header.palette.as_ref().map_or(0, |palette| palette.len());
    let opacities = header.trns.as_ref().map_or(0, |opacities| opacities.len());
    // The library takes for granted that they fit, and panics.
    if header.color_type == png::ColorType::Indexed
        && !(colours.is_multiple_of(3) && colours <= 3 * 256 && opacities <= colours / 3)
    {
        return Err(format!("a palette of {colours} bytes with {opacities} opacities is broken"));
    }
    let mut pixels = vec![0; reader.output_buffer_size().ok_or("the picture is too large")?];
    let info = reader.next_frame(&mut pixels).map_err(|error| error.to_string())?;
    pixels.truncate(info.buffer_size());
    let rgba = match info.color_type {
        png::ColorType::GrayscaleAlpha => {
            pixels.chunks_exact(2).flat_map(|pixel| [pixel[0], pixel[0], pixel[0], pixel[1]]).collect()
        }
        _ => pixels,
    };
    Ok((info.width, info.height, rgba))
}

/// A PNG as a URL that holds it.
pub fn data_url(png: &[u8]) -> String {
    format!("data:image/png;base64,{}", STANDARD.encode(png))
}

/// An SVG file as a URL that holds it.
pub fn svg_url(svg: &[u8]) -> String {
    format!("data:image/svg+xml;base64,{}", STANDARD.encode(svg))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::svg::{Anchor, Svg};

    #[test]
    fn pixels_come_back_from_files_of_any_kind() {
        let rgb = encode_rgb(2, 1, &[1, 2, 3, 4, 5, 6]).unwrap();
        assert_eq!(decode_rgba(&rgb), Ok((2, 1, vec![1, 2, 3, 255, 4, 5, 6, 255])));
        let indexed = encode_indexed(2, 1, &[1, 0], &[[9, 8, 7, 0], [1, 2, 3, 255]]).unwrap();
        assert_eq!(decode_rgba(&indexed), Ok((2, 1, vec![1, 2, 3, 255, 9, 8, 7, 0])));
        let mut grey = Vec::new();
        let mut encoder = png::Encoder::new(&mut grey, 1, 1);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.write_header().unwrap().write_image_data(&[77]).unwrap();
        assert_eq!(decode_rgba(&grey), Ok((1, 1, vec![77, 77, 77, 255])));
        assert!(decode_rgba(&rgb[..20]).is_err() && decode_rgba(b"no picture").is_err());
    }

    #[test]
    fn a_broken_palette_is_refused() {
        let indexed = |palette: &[u8], opacities: &[u8]| {
            let mut file = Vec::new();
            let mut encoder = png::Encoder::new(&mut file, 1, 1);
            encoder.set_color(png::ColorType::Indexed);
            encoder.set_palette(palette.to_vec());
            encoder.set_trns(opacities.to_vec());
            encoder.write_header().unwrap().write_image_data(&[0]).unwrap();
            decode_rgba(&file)
        };
        assert_eq!(indexed(&[1, 2, 3], &[4]), Ok((1, 1, vec![1, 2, 3, 4])));
        assert!(indexed(&[1, 2, 3, 4, 5], &[6]).is_err() && indexed(&[1, 2, 3], &[4, 5]).is_err());
    }

    #[test]
    fn a_file_too_short_for_its_pixels_is_refused_before_they_take_memory() {
        let mut long = Vec::new();
        let encoder = png::Encoder::new(&mut long, 100_000, 100_000);
        encoder.write_header().unwrap().write_chunk(png::chunk::IDAT, &[0x78, 0x01]).unwrap();
        assert!(decode_rgba(&long).unwrap_err().starts_with("100000 x 100000 pixels cannot be in"));
    }

    #[test]
    fn a_small_file_of_very_many_pixels_is_refused() {
        let [width, height] = [20_000, 10_000];
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, width, height);
        encoder.set_depth(png::BitDepth::One);
        let row = (width as usize).div_ceil(8);
        encoder.write_header().unwrap().write_image_data(&vec![0; row * height as usize]).unwrap();
        assert!(file.len() < 1 << 20, "{}", file.len());
        let error = decode_rgba(&file).unwrap_err();
        assert!(error.contains("20000 x 10000 pixels") && error.contains("100000000 are possible"), "{error}");
    }

    #[test]
    fn text_leaves_ink_on_the_page() {
        let ink = |text: &str| {
            let mut svg = Svg::default();
            svg.text([5.0, 20.0], Anchor::Start, "title", text);
            let png = svg_to_png(&svg.finish([200.0, 30.0], "")).unwrap();
            let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
            let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut pixels).unwrap();
            pixels.iter().filter(|value| **value < 128).count()
        };
        assert_eq!(ink(""), 0);
        // Each of these must be in the font: a letter without a glyph would leave as much as the one before.
        assert!(ink("10⁻¹²") > ink("10⁻¹"));
        assert!(ink("m³") > ink("m"));
        assert!(ink("0 – 5") > ink("0 5"));
    }
}

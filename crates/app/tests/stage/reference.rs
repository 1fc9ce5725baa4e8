//! Pictures that were looked at, to be compared with.

use corpuscle::gpu::Image;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// Mean difference of two pictures of the same, in steps of a byte: drivers round differently.
const SAME: f64 = 0.15;
/// Side of the squares in which two pictures are compared, pixels, and the largest difference of their means, in steps of a byte.
const SQUARE: u32 = 8;
const SAME_SQUARE: f64 = 8.0;

/// The part `[left, top, right, bottom]` of a picture, at half its size.
pub fn half(image: &Image, [left, top, right, bottom]: [u32; 4]) -> Image {
    let (width, height) = ((right - left) / 2, (bottom - top) / 2);
    let at = |x: u32, y: u32, channel: u32| u32::from(image.rgba[((y * image.width + x) * 4 + channel) as usize]);
    let mut rgba = Vec::with_capacity((width * height * 4) as usize);
    for row in 0..height {
        for column in 0..width {
            let (x, y) = (left + 2 * column, top + 2 * row);
            for channel in 0..4 {
                let sum = at(x, y, channel) + at(x + 1, y, channel) + at(x, y + 1, channel) + at(x + 1, y + 1, channel);
                rgba.push((sum / 4) as u8);
            }
        }
    }
    Image { width, height, rgba }
}

/// Compares with the reference of a name; where it differs it is left beside the test's other output.
pub fn compare(name: &str, image: &Image) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference").join(format!("{name}.png"));
    if std::env::var_os("CORPUSCLE_NEW_REFERENCE").is_some_and(|value| value == "1") {
        write(&path, image);
    }
    let reference = read(&path);
    assert_eq!([image.width, image.height], [reference.width, reference.height], "{name}");
    let (mean, largest) = differences(image, &reference);
    if mean > SAME || largest > SAME_SQUARE {
        let found = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.png"));
        write(&found, image);
        panic!(
            "{name} is off by {mean:.2} (at most {SAME}), in a square by {largest:.1} (at most {SAME_SQUARE}): compare {} with {}",
            found.display(),
            path.display()
        );
    }
}

/// Mean difference of all bytes, and the largest difference of the means of a square.
fn differences(one: &Image, other: &Image) -> (f64, f64) {
    let sum: u64 = one.rgba.iter().zip(&other.rgba).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    let mut largest = 0.0_f64;
    for top in (0..one.height).step_by(SQUARE as usize) {
        for left in (0..one.width).step_by(SQUARE as usize) {
            for channel in 0..3 {
                let mean = |image: &Image| {
                    let rows = top..(top + SQUARE).min(image.height);
                    let columns = left..(left + SQUARE).min(image.width);
                    let count = f64::from(rows.len() as u32 * columns.len() as u32);
                    let at = |x: u32, y: u32| f64::from(image.rgba[((y * image.width + x) * 4 + channel) as usize]);
                    rows.flat_map(|y| columns.clone().map(move |x| (x, y))).map(|(x, y)| at(x, y)).sum::<f64>() / count
                };
                largest = largest.max((mean(one) - mean(other)).abs());
            }
        }
    }
    (sum as f64 / one.rgba.len() as f64, largest)
}

fn read(path: &Path) -> Image {
    let file = File::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut reader = png::Decoder::new(BufReader::new(file)).read_info().unwrap();
    let mut rgba = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut rgba).unwrap();
    Image { width: info.width, height: info.height, rgba }
}

fn write(path: &Path, image: &Image) {
    let mut encoder = png::Encoder::new(File::create(path).unwrap(), image.width, image.height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().unwrap().write_image_data(&image.rgba).unwrap();
}

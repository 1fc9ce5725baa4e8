//! Films as a player sees them: duration, size, rate, pictures.

mod boxes;
mod ffprobe;

use boxes::Mp4;
use corpuscle_video::{Film, FilmError, Format};
use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;

/// A dark ground with a bright square that wanders to the right.
fn picture([width, height]: [u32; 2], number: u32) -> Vec<u8> {
    let mut rgba = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let inside = (x + 60 * number) % 64 < 16 && y < height / 2;
            rgba.extend_from_slice(if inside { &[230, 200, 60, 255] } else { &[20, 60, 120, 255] });
        }
    }
    rgba
}

fn write(path: &Path, size: [u32; 2], rate: f64, pictures: u32) -> Result<(), FilmError> {
    let mut film = Film::create(path, Format::of(path), size, rate)?;
    for number in 0..pictures {
        film.add(&picture(size, number))?;
    }
    film.finish()
}

#[test]
fn an_mp4_has_the_duration_size_and_rate_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    // Asked for; as it must be: size, seconds, pictures a second.
    let cases = [
        ([64, 48], 25.0, 50, [64, 48], 2.0),
        ([65, 47], 30.0, 15, [66, 48], 0.5),
        ([320, 180], 60.0, 30, [320, 180], 0.5),
        ([64, 64], 29.97, 60, [64, 64], 60.0 / 29.97),
        ([64, 64], 0.5, 3, [64, 64], 6.0),
        ([64, 64], 10.0, 1, [64, 64], 0.1),
    ];
    for (asked, rate, pictures, size, seconds) in cases {
        let path = folder.path().join("film.mp4");
        write(&path, asked, rate, pictures).unwrap();
        let film = Mp4::read(&path);
        assert_eq!(film.size, size);
        assert!((film.seconds - seconds).abs() < 1e-4, "{} s, should be {seconds} s", film.seconds);
        assert_eq!(film.pictures, pictures.max(2) as usize);
        if let Some(probed) = ffprobe::read(&path) {
            assert_eq!((probed.codec.as_str(), probed.size), ("h264", size));
            assert!((probed.seconds - seconds).abs() < 1e-3, "{probed:?}");
            assert_eq!(probed.pictures, pictures.max(2) as usize, "{probed:?}");
            assert!(pictures < 2 || (probed.rate / rate - 1.0).abs() < 1e-3, "{probed:?}");
        }
    }
}

#[test]
fn the_pictures_of_an_mp4_are_those_put_in() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.mp4");
    let size = [128, 96];
    write(&path, size, 25.0, 20).unwrap();
    let decoded = Mp4::read(&path).decode();
    assert_eq!(decoded.len(), 20);
    for (number, rgb) in decoded.iter().enumerate() {
        let rgba = picture(size, number as u32);
        let difference: u64 = (rgba.as_chunks::<4>().0.iter().zip(rgb.as_chunks::<3>().0))
            .flat_map(|(put, got)| put.iter().zip(got).map(|(put, got)| u64::from(put.abs_diff(*got))))
            .sum();
        let mean = difference as f64 / rgb.len() as f64;
        assert!(mean < 3.0, "picture {number} differs by {mean} of 255 on average");
    }
}

#[test]
fn the_same_pictures_give_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["film.mp4", "film.gif"] {
        let [one, two] = ["1", "2"].map(|run| folder.path().join(format!("{run}-{name}")));
        write(&one, [64, 48], 25.0, 8).unwrap();
        write(&two, [64, 48], 25.0, 8).unwrap();
        assert_eq!(fs::read(one).unwrap(), fs::read(two).unwrap());
    }
}

#[test]
fn a_gif_lasts_as_long_as_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.gif");
    // 30 a second is 3.33 hundredths: the sum must be right all the same.
    write(&path, [33, 21], 30.0, 30).unwrap();
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(File::open(&path).unwrap()).unwrap();
    assert_eq!((decoder.width(), decoder.height(), decoder.repeat()), (33, 21, gif::Repeat::Infinite));
    let (mut hundredths, mut number) = (0, 0);
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        assert_eq!(frame.buffer, picture([33, 21], number), "picture {number}");
        hundredths += u32::from(frame.delay);
        number += 1;
    }
    assert_eq!((hundredths, number), (100, 30));
}

#[test]
fn a_sequence_holds_every_picture_unchanged() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pictures");
    write(&path, [21, 9], 25.0, 3).unwrap();
    assert_eq!(fs::read_dir(&path).unwrap().count(), 3);
    for number in 0..3 {
        let file = BufReader::new(File::open(path.join(format!("{number:06}.png"))).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        assert_eq!(pixels, picture([21, 9], number));
    }
    assert!(matches!(write(&path, [21, 9], 25.0, 3), Err(FilmError::Exists { .. })));
}

#[test]
fn a_film_given_up_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["film.mp4", "film.gif", "pictures"] {
        let path = folder.path().join(name);
        let mut film = Film::create(&path, Format::of(&path), [64, 48], 25.0).unwrap();
        film.add(&picture([64, 48], 0)).unwrap();
        drop(film);
        let film = Film::create(&path, Format::of(&path), [64, 48], 25.0).unwrap();
        assert!(matches!(film.finish(), Err(FilmError::Empty { .. })));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "{name}");
    }
}

#[test]
fn what_a_format_cannot_hold_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let create = |name: &str, size, rate| {
        let path = folder.path().join(name);
        Film::create(&path, Format::of(&path), size, rate).err()
    };
    for (name, size) in [("a.mp4", [0, 100]), ("a.mp4", [8000, 100]), ("a.mp4", [2200, 2200]), ("a.gif", [70_000, 1])] {
        assert!(matches!(create(name, size, 25.0), Some(FilmError::Size { .. })), "{name} {size:?}");
    }
    for (name, rate) in [("a.mp4", f64::NAN), ("a.mp4", -1.0), ("a.mp4", 1e9), ("a.gif", 60.0)] {
        assert!(matches!(create(name, [64, 64], rate), Some(FilmError::Rate { .. })), "{name} {rate}");
    }
    assert!(matches!(create("none/a.mp4", [64, 64], 25.0), Some(FilmError::Write { .. })));
    let mut film = Film::create(&folder.path().join("a.mp4"), Format::Mp4, [64, 64], 25.0).unwrap();
    let error = film.add(&[0; 12]).unwrap_err();
    assert!(error.to_string().contains("12 bytes") && error.to_string().contains("16384"), "{error}");
}

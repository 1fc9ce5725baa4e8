//! GIF, written with the `gif` library.

use crate::{FilmError, Writer, check_rate, check_size};
use corpuscle_atomic_file::WholeFile;
use gif::{Encoder, EncodingError, Frame, Repeat};
use std::io;
use std::path::{Path, PathBuf};

/// Most pictures per second: many players slow down anything faster.
const MOST: f64 = 50.0;
/// Coarseness of the choice of colours, 1 to 30; the library recommends 10.
const SPEED: i32 = 10;

pub(crate) struct Gif {
    path: PathBuf,
    size: [u16; 2],
    rate: f64,
    pictures: usize,
    encoder: Encoder<WholeFile>,
}

impl Gif {
    pub(crate) fn create(path: &Path, size: [u32; 2], rate: f64) -> Result<Self, FilmError> {
        check_size(size, 1, [u16::MAX.into(); 2])?;
        check_rate(rate, MOST)?;
        let size = size.map(|side| side as u16);
        let encoder = start(path, size).map_err(|error| failed(path, error))?;
        Ok(Self { path: path.into(), size, rate, pictures: 0, encoder })
    }

    /// Duration of the next picture, hundredths of a second, such that the sum is right to half of one.
    fn delay(&self) -> u16 {
        let at = |picture: usize| (100.0 * picture as f64 / self.rate).round();
        (at(self.pictures + 1) - at(self.pictures)) as u16
    }
}

impl Writer for Gif {
    fn add(&mut self, rgba: &[u8]) -> Result<(), FilmError> {
        let [width, height] = self.size;
        let rgb: Vec<u8> =
            rgba.as_chunks::<4>().0.iter().flat_map(|[red, green, blue, _]| [*red, *green, *blue]).collect();
        let mut frame = Frame::from_rgb_speed(width, height, &rgb, SPEED);
        frame.delay = self.delay();
        self.encoder.write_frame(&frame).map_err(|error| failed(&self.path, error))?;
        self.pictures += 1;
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<(), FilmError> {
        let file = self.encoder.into_inner().map_err(|error| failed(&self.path, error))?;
        file.finish().map_err(FilmError::write(&self.path))
    }
}

fn start(path: &Path, [width, height]: [u16; 2]) -> Result<Encoder<WholeFile>, EncodingError> {
    let mut encoder = Encoder::new(WholeFile::create(path)?, width, height, &[])?;
    encoder.set_repeat(Repeat::Infinite)?;
    Ok(encoder)
}

fn failed(path: &Path, error: EncodingError) -> FilmError {
    let source = match error {
        EncodingError::Io(source) => source,
        other => io::Error::other(other),
    };
    FilmError::Write { path: path.into(), source }
}

//! H.264 in MP4, with the libraries `openh264` and `muxide`.

use crate::{FilmError, Writer, check_rate, check_size};
use corpuscle_atomic_file::WholeFile;
use muxide::api::{Muxer, MuxerBuilder, MuxerError, VideoCodec};
use openh264::OpenH264API;
use openh264::encoder::{
    Encoder, EncoderConfig, FrameRate, FrameType, IntraFramePeriod, MatrixCoefficients, RateControlMode, VuiConfig,
};
use openh264::formats::{RgbaSliceU8, YUVBuffer};
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// Most pictures per second.
const MOST: f64 = 120.0;
/// Interval of key frames, s.
const JUMP: f64 = 2.0;
pub(crate) struct Mp4 {
    path: PathBuf,
    size: [u32; 2],
    rate: f64,
    encoder: Encoder,
    /// The writer of MP4: keeps the encoded pictures; the file is written at the end, with its index in front.
    muxer: Muxer<WholeFile>,
    yuv: YUVBuffer,
    pictures: usize,
    last: Vec<u8>,
}

impl Mp4 {
    pub(crate) fn create(path: &Path, size: [u32; 2], rate: f64) -> Result<Self, FilmError> {
        check_size(size, 16, [3840, 2160])?;
        check_rate(rate, MOST)?;
        let [width, height] = size.map(|side| side.next_multiple_of(2));
        let file = WholeFile::create(path).map_err(FilmError::write(path))?;
        let muxer = MuxerBuilder::new(file)
            .video(VideoCodec::H264, width, height, rate)
            .build()
            .map_err(FilmError::encoder(path))?;
        let encoder =
            Encoder::with_api_config(OpenH264API::from_source(), config(rate)).map_err(FilmError::encoder(path))?;
        let yuv = YUVBuffer::new(width as usize, height as usize);
        Ok(Self { path: path.into(), size, rate, encoder, muxer, yuv, pictures: 0, last: Vec::new() })
    }

    fn write(&mut self, time: f64) -> Result<(), FilmError> {
        let stream = self.encoder.encode(&self.yuv).map_err(FilmError::encoder(&self.path))?;
        let jump = stream.frame_type() == FrameType::IDR;
        self.last.clear();
        stream.write_vec(&mut self.last);
        self.muxer.write_video(time, &self.last, jump).map_err(|error| failed(&self.path, error))
    }
}

impl Writer for Mp4 {
    fn add(&mut self, rgba: &[u8]) -> Result<(), FilmError> {
        let [width, height] = self.size.map(|side| side.next_multiple_of(2) as usize);
        let even = even(rgba, self.size);
        self.yuv.read_rgba8(RgbaSliceU8::new(&even, (width, height)));
        self.write(self.pictures as f64 / self.rate)?;
        self.pictures += 1;
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> Result<(), FilmError> {
        // In an MP4 a picture lasts until the next, and the last as long as the one before it: one picture alone
        // would last no time. It is shown twice, for half its time.
        if self.pictures == 1 {
            self.write(0.5 / self.rate)?;
        }
        self.muxer.finish_in_place().map_err(|error| failed(&self.path, error))?;
        self.muxer.into_writer().finish().map_err(FilmError::write(&self.path))
    }
}

/// Every picture is kept and of the same quality (quantiser 26, hardly a visible loss), and the same pictures give the
/// same bytes.
fn config(rate: f64) -> EncoderConfig {
    EncoderConfig::new()
        .rate_control_mode(RateControlMode::Off)
        .skip_frames(false)
        // Only checked, in 1 to 60: without rate control nothing follows from it.
        .max_frame_rate(FrameRate::from_hz(rate.clamp(1.0, 60.0) as f32))
        .num_threads(1)
        .intra_frame_period(IntraFramePeriod::from_num_frames((JUMP * rate).ceil() as u32))
        // What the library's conversion from RGB does: the weights of BT.601 in 16 to 235, primaries as on a screen.
        .vui(VuiConfig::bt709().matrix_coefficients(MatrixCoefficients::Smpte170M))
}

/// The picture with its last row and column twice where their number is odd.
fn even(rgba: &[u8], [width, height]: [u32; 2]) -> Cow<'_, [u8]> {
    if width.is_multiple_of(2) && height.is_multiple_of(2) {
        return Cow::Borrowed(rgba);
    }
    let across = width as usize * 4;
    let rows = rgba.chunks_exact(across);
    let mut even = Vec::with_capacity(rgba.len() + rgba.len() / 16);
    let twice = (!height.is_multiple_of(2)).then(|| &rgba[rgba.len() - across..]);
    for row in rows.chain(twice) {
        even.extend_from_slice(row);
        if !width.is_multiple_of(2) {
            even.extend_from_slice(&row[across - 4..]);
        }
    }
    Cow::Owned(even)
}

fn failed(path: &Path, error: MuxerError) -> FilmError {
    match error {
        MuxerError::Io(source) => FilmError::Write { path: path.into(), source },
        other => FilmError::encoder(path)(other),
    }
}

#[cfg(test)]
mod tests {
    use super::even;

    #[test]
    fn odd_sides_get_their_last_pixels_twice() {
        let picture: Vec<u8> = (0..9).flat_map(|pixel| [pixel; 4]).collect();
        let pixels: Vec<u8> = even(&picture, [3, 3]).as_chunks::<4>().0.iter().map(|pixel| pixel[0]).collect();
        assert_eq!(pixels, [0, 1, 2, 2, 3, 4, 5, 5, 6, 7, 8, 8, 6, 7, 8, 8]);
    }
}

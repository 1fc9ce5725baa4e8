//! An MP4 file, read by its boxes (ISO 14496-12).

use openh264::decoder::Decoder;
use openh264::formats::YUVSource;
use std::fs;
use std::path::Path;

/// What a player finds in the file.
pub struct Mp4 {
    pub size: [u32; 2],
    pub seconds: f64,
    pub pictures: usize,
    /// Sequence and picture parameter sets.
    parameters: Vec<Vec<u8>>,
    /// The pictures, each unit after four bytes that tell its length.
    media: Vec<u8>,
}

impl Mp4 {
    pub fn read(path: &Path) -> Self {
        let file = fs::read(path).unwrap();
        let track = |names: &[&str]| inside(&file, &[&["moov", "trak", "mdia"], names].concat());
        let table = |name| track(&["minf", "stbl", name]);
        let header = track(&["mdhd"]);
        let description = &table("stsd")[8..];
        let entry = inside(description, &["avc1"]);
        let sizes = table("stsz");
        assert_eq!(u32_at(sizes, 8) as usize, (sizes.len() - 12) / 4);
        let times: u32 = table("stts")[8..].as_chunks::<8>().0.iter().map(|run| u32_at(run, 0) * u32_at(run, 4)).sum();
        assert_eq!(times, u32_at(header, 16), "the times of the pictures are not the film's");
        Self {
            size: [u16_at(entry, 24).into(), u16_at(entry, 26).into()],
            seconds: f64::from(u32_at(header, 16)) / f64::from(u32_at(header, 12)),
            pictures: u32_at(sizes, 8) as usize,
            parameters: parameters(inside(&entry[78..], &["avcC"])),
            media: inside(&file, &["mdat"]).to_vec(),
        }
    }

    /// The pictures as three bytes a pixel.
    pub fn decode(&self) -> Vec<Vec<u8>> {
        let mut units = self.parameters.clone();
        let mut rest = self.media.as_slice();
        while !rest.is_empty() {
            let (unit, after) = rest[4..].split_at(u32_at(rest, 0) as usize);
            units.push(unit.to_vec());
            rest = after;
        }
        let mut decoder = Decoder::new().unwrap();
        let mut pictures = Vec::new();
        for unit in units {
            if let Some(yuv) = decoder.decode(&[&[0, 0, 0, 1], unit.as_slice()].concat()).unwrap() {
                let (width, height) = yuv.dimensions();
                let mut rgb = vec![0; width * height * 3];
                yuv.write_rgb8(&mut rgb);
                pictures.push(rgb);
            }
        }
        pictures
    }
}

/// The sets in an `avcC` box (ISO 14496-15): a count and lengths before each kind.
fn parameters(content: &[u8]) -> Vec<Vec<u8>> {
    let mut sets = Vec::new();
    let mut at = 5;
    for mask in [0x1f, 0xff] {
        let count = content[at] & mask;
        at += 1;
        for _ in 0..count {
            let length = u16_at(content, at) as usize;
            sets.push(content[at + 2..at + 2 + length].to_vec());
            at += 2 + length;
        }
    }
    sets
}

/// The content of the box that is reached by these names.
fn inside<'a>(content: &'a [u8], names: &[&str]) -> &'a [u8] {
    let Some((name, deeper)) = names.split_first() else { return content };
    let mut rest = content;
    while rest.len() >= 8 {
        let (this, after) = rest.split_at(u32_at(rest, 0) as usize);
        if &this[4..8] == name.as_bytes() {
            return inside(&this[8..], deeper);
        }
        rest = after;
    }
    panic!("no box {name}");
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap())
}

fn u16_at(bytes: &[u8], at: usize) -> u16 {
    u16::from_be_bytes(bytes[at..at + 2].try_into().unwrap())
}

//! Colours of numbers.

use crate::shared::{SRGB_EXPONENT, SRGB_LINE_END, SRGB_OFFSET, SRGB_SCALE, SRGB_SLOPE};
use corpuscle_gpu::{Gpu, texture_2d, wgpu};

/// Colours in a table on the device.
const ENTRIES: usize = 256;

/// A table of colours for numbers from `low` to `high`; sRGB bytes.
#[derive(Debug, Clone, PartialEq)]
pub struct ColourTable {
    /// The number that has the first colour.
    pub low: f32,
    /// The number that has the last.
    pub high: f32,
    /// Colours at equal distances, interpolated between them. At least one.
    pub colours: Vec<[u8; 3]>,
}

impl ColourTable {
    /// One colour for everything.
    pub fn plain(colour: [u8; 3]) -> Self {
        Self { low: 0.0, high: 1.0, colours: vec![colour] }
    }

    /// The colour of a number.
    pub fn colour(&self, value: f32) -> [u8; 3] {
        let part = ((value - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
        let last = self.colours.len() - 1;
        let position = if part.is_nan() { 0.0 } else { part * last as f32 };
        let below = (position as usize).min(last.saturating_sub(1));
        let [from, to] = [self.colours[below], self.colours[(below + 1).min(last)]];
        let mix = position - below as f32;
        std::array::from_fn(|k| (f32::from(from[k]) + (f32::from(to[k]) - f32::from(from[k])) * mix).round() as u8)
    }

    /// The table on the device: [`ENTRIES`] colours in a row.
    pub(crate) fn upload(&self, gpu: &Gpu) -> wgpu::TextureView {
        let value = |entry: usize| self.low + (self.high - self.low) * entry as f32 / (ENTRIES - 1) as f32;
        let rgba: Vec<u8> = (0..ENTRIES)
            .flat_map(|entry| {
                let [r, g, b] = self.colour(value(entry));
                [r, g, b, 255]
            })
            .collect();
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let size = [ENTRIES as u32, 1];
        let texture = texture_2d(gpu, "colours", size, wgpu::TextureFormat::Rgba8UnormSrgb, usage);
        let texture = texture.expect("256 pixels are within every limit");
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * size[0]), rows_per_image: None };
        gpu.queue.write_texture(texture.as_image_copy(), &rgba, layout, texture.size());
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    }
}

/// Linear light of an sRGB colour (IEC 61966-2-1).
pub fn linear(colour: [u8; 3]) -> [f32; 3] {
    colour.map(|byte| {
        let value = f32::from(byte) / 255.0;
        if value <= SRGB_LINE_END {
            value / SRGB_SLOPE
        } else {
            ((value + SRGB_OFFSET) / SRGB_SCALE).powf(SRGB_EXPONENT)
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_go_over_into_each_other_and_stay_within() {
        let table = ColourTable { low: -1.0, high: 3.0, colours: vec![[0; 3], [100, 200, 0], [255; 3]] };
        assert_eq!(table.colour(-5.0), [0; 3]);
        assert_eq!(table.colour(0.0), [50, 100, 0]);
        assert_eq!(table.colour(9.0), [255; 3]);
        assert_eq!(table.colour(f32::NAN), [0; 3]);
        assert_eq!(ColourTable::plain([1, 2, 3]).colour(0.7), [1, 2, 3]);
    }
}

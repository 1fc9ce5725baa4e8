//! Pictures side by side, and pictures with their overlay as vectors.

use crate::Error;
use corpuscle_drawing::png::{data_url, encode_rgba};
use corpuscle_drawing::svg::{Figure, Svg};
use corpuscle_gpu::Image;
use corpuscle_render::RenderError;

/// Pictures of one height side by side, each with its overlay if that is apart.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sheet {
    pictures: Vec<(Image, Option<Figure>)>,
}

impl Sheet {
    /// Adds a picture to the right. One that is less high than the others has white below it.
    pub fn add(&mut self, image: Image, overlay: Option<Figure>) {
        self.pictures.push((image, overlay));
    }

    /// The pictures as one, without overlays that are apart.
    pub fn image(&self) -> Image {
        let images = || self.pictures.iter().map(|(image, _)| image);
        let (width, height) =
            (images().map(|image| image.width).sum::<u32>(), images().map(|image| image.height).max());
        let (width, height) = (width as usize, height.unwrap_or(0) as usize);
        let mut rgba = vec![255; 4 * width * height];
        let mut left = 0;
        for image in images() {
            let row = 4 * image.width as usize;
            let rows = rgba.chunks_exact_mut(4 * width).zip(image.rgba.chunks_exact(row));
            rows.for_each(|(to, from)| to[left..left + row].copy_from_slice(from));
            left += row;
        }
        Image { width: width as u32, height: height as u32, rgba }
    }

    /// The pictures in an SVG file, with overlays that are apart as vectors over them.
    ///
    /// # Errors
    /// [`Error::Render`] where a picture cannot be encoded.
    pub fn svg(&self) -> Result<String, Error> {
        let mut svg = Svg::default();
        let (mut left, mut high) = (0.0, 0.0_f64);
        for (image, overlay) in &self.pictures {
            let size = overlay.as_ref().map_or([f64::from(image.width), f64::from(image.height)], Figure::size);
            let png = encode_rgba(image.width, image.height, &image.rgba).map_err(RenderError::Overlay)?;
            svg.image([left, 0.0], size, &data_url(&png), 1.0);
            if let Some(overlay) = overlay {
                svg.place([left, 0.0], overlay);
            }
            left += size[0];
            high = high.max(size[1]);
        }
        Ok(svg.finish([left, high], "").transparent())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_drawing::svg::Anchor;

    fn plain(width: u32, height: u32, grey: u8) -> Image {
        Image { width, height, rgba: vec![grey; 4 * (width * height) as usize] }
    }

    #[test]
    fn pictures_stand_side_by_side() {
        let mut sheet = Sheet::default();
        sheet.add(plain(3, 2, 10), None);
        sheet.add(plain(2, 1, 20), None);
        let image = sheet.image();
        assert_eq!((image.width, image.height), (5, 2));
        assert_eq!((image.pixel(2, 1), image.pixel(3, 0), image.pixel(4, 1)), ([10; 4], [20; 4], [255; 4]));
        assert_eq!(Sheet::default().image(), Image { width: 0, height: 0, rgba: Vec::new() });
    }

    #[test]
    fn overlays_apart_are_vectors() {
        let mut text = Svg::default();
        text.text([5.0, 20.0], Anchor::Start, "over-title", "A < B");
        let mut sheet = Sheet::default();
        sheet.add(plain(4, 2, 10), None);
        sheet.add(plain(4, 2, 10), Some(text.finish([1440.0, 720.0], "")));
        let svg = sheet.svg().unwrap();
        assert!(svg.contains("viewBox=\"0 0 1444 720\"") && svg.contains("A &lt; B"), "{svg}");
        assert_eq!(svg.matches("data:image/png;base64").count(), 2);
    }
}

//! Pictures of many balls, pixel by pixel.

use crate::picture::colour::Colour;
use crate::picture::colour::mix;
use crate::picture::png::encode_rgba;

/// Discs side by side on a transparent ground.
pub(super) struct Flat {
    width: usize,
    height: usize,
    /// Red, green, blue and opacity; the colours not multiplied by it.
    pixels: Vec<[u8; 4]>,
}

impl Flat {
    pub(super) fn new([width, height]: [usize; 2]) -> Self {
        Self { width, height, pixels: vec![[0; 4]; width * height] }
    }

    /// A disc with a darker rim, its edge smoothed over a pixel. One smaller than a pixel is drawn a pixel wide.
    pub(super) fn disc(&mut self, [x, y]: [f64; 2], radius: f64, colour: Colour) {
        let radius = radius.max(0.6);
        let rim = mix(colour, [23, 33, 43], 0.45);
        for row in within(y, radius, self.height) {
            for column in within(x, radius, self.width) {
                let distance = (column as f64 + 0.5 - x).hypot(row as f64 + 0.5 - y);
                let cover = (radius - distance + 0.5).clamp(0.0, 1.0);
                if cover > 0.0 {
                    let at_rim = if radius > 3.0 { (distance - radius + 1.6).clamp(0.0, 1.0) } else { 0.0 };
                    self.blend(row * self.width + column, mix(colour, rim, at_rim), cover);
                }
            }
        }
    }

    fn blend(&mut self, pixel: usize, colour: Colour, cover: f64) {
        let [r, g, b, opacity] = self.pixels[pixel];
        let below = f64::from(opacity) / 255.0 * (1.0 - cover);
        let all = cover + below;
        let [r, g, b] = mix([r, g, b], colour, cover / all);
        self.pixels[pixel] = [r, g, b, (255.0 * all).round() as u8];
    }

    pub(super) fn png(&self) -> Result<Vec<u8>, String> {
        encode_rgba(self.width as u32, self.height as u32, self.pixels.as_flattened())
    }
}

/// Pixels of a row or column that a disc may touch.
fn within(centre: f64, radius: f64, count: usize) -> std::ops::Range<usize> {
    let bound = |position: f64| position.clamp(0.0, count as f64) as usize;
    bound(centre - radius - 1.0)..bound(centre + radius + 2.0)
}

/// Shaded spheres, the near ones before the far ones.
pub(super) struct Spheres {
    width: usize,
    height: usize,
    pixels: Vec<Colour>,
    /// Distance from the eye; infinite where there is nothing.
    depths: Vec<f32>,
}

/// Each pixel is the mean of so many across and down.
const SAMPLES: usize = 2;

/// Where the light comes from: left, above, before; of length 1.
const LIGHT: [f64; 3] = [-0.44, 0.62, 0.65];

/// Half way between the light and the eye; of length 1.
const SHINE: [f64; 3] = [-0.242, 0.341, 0.908];

/// A sphere as the eye sees it: its middle in pixels, y downwards, its distance, both in pixels, and its radius.
pub(super) struct Seen {
    pub point: [f64; 2],
    pub distance: f64,
    pub radius: f64,
    pub colour: Colour,
}

impl Spheres {
    /// An empty picture, `width` by `height` pixels.
    pub(super) fn new([width, height]: [usize; 2]) -> Self {
        let [width, height] = [width * SAMPLES, height * SAMPLES];
        Self { width, height, pixels: vec![[0; 3]; width * height], depths: vec![f32::INFINITY; width * height] }
    }

    pub(super) fn sphere(&mut self, seen: &Seen) {
        let fine = SAMPLES as f64;
        let ([x, y], distance, radius) =
            (seen.point.map(|length| length * fine), seen.distance * fine, seen.radius * fine);
        for row in within(y, radius, self.height) {
            for column in within(x, radius, self.width) {
                let [across, up] = [(column as f64 + 0.5 - x) / radius, (y - row as f64 - 0.5) / radius];
                let towards = 1.0 - across * across - up * up;
                if towards < 0.0 {
                    continue;
                }
                let normal = [across, up, towards.sqrt()];
                let (pixel, depth) = (row * self.width + column, (distance - radius * normal[2]) as f32);
                if depth < self.depths[pixel] {
                    self.depths[pixel] = depth;
                    self.pixels[pixel] = shaded(seen.colour, normal);
                }
            }
        }
    }

    /// The picture, transparent where there is nothing.
    pub(super) fn png(&self) -> Result<Vec<u8>, String> {
        let [width, height] = [self.width / SAMPLES, self.height / SAMPLES];
        let mut bytes = Vec::with_capacity(4 * width * height);
        for pixel in 0..width * height {
            let corner = pixel / width * SAMPLES * self.width + pixel % width * SAMPLES;
            let samples = (0..SAMPLES * SAMPLES).map(|k| corner + k / SAMPLES * self.width + k % SAMPLES);
            let hit: Vec<Colour> = samples.filter(|k| self.depths[*k].is_finite()).map(|k| self.pixels[k]).collect();
            let count = hit.len().max(1);
            bytes.extend(
                [0, 1, 2].map(|k| (hit.iter().map(|colour| usize::from(colour[k])).sum::<usize>() / count) as u8),
            );
            bytes.push((255 * hit.len() / (SAMPLES * SAMPLES)) as u8);
        }
        encode_rgba(width as u32, height as u32, &bytes)
    }
}

/// Lambert's law with some light from all sides, and a highlight (Blinn 1977).
fn shaded(colour: Colour, normal: [f64; 3]) -> Colour {
    let along = |direction: [f64; 3]| (0..3).map(|k| normal[k] * direction[k]).sum::<f64>().max(0.0);
    let light = 0.42 + 0.66 * along(LIGHT);
    let shine = 70.0 * along(SHINE).powi(36);
    colour.map(|channel| (f64::from(channel) * light + shine).min(255.0) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disc_covers_its_area() {
        let mut canvas = Flat::new([40, 40]);
        canvas.disc([20.3, 19.8], 10.0, [10, 20, 30]);
        let covered: f64 = canvas.pixels.iter().map(|pixel| f64::from(pixel[3]) / 255.0).sum();
        assert!((covered - std::f64::consts::PI * 100.0).abs() < 2.0, "{covered}");
        assert_eq!(canvas.pixels[20 * 40 + 20], [10, 20, 30, 255]);
        canvas.disc([-50.0, 500.0], 3.0, [0; 3]);
    }

    #[test]
    fn the_nearer_sphere_hides_the_farther_in_any_order() {
        let near = Seen { point: [10.0, 10.0], distance: 50.0, radius: 4.0, colour: [200, 0, 0] };
        let far = Seen { point: [10.0, 10.0], distance: 90.0, radius: 8.0, colour: [0, 0, 200] };
        let paint = |spheres: [&Seen; 2]| {
            let mut canvas = Spheres::new([20, 20]);
            spheres.into_iter().for_each(|sphere| canvas.sphere(sphere));
            canvas.pixels
        };
        let pixels = paint([&near, &far]);
        assert_eq!(pixels, paint([&far, &near]));
        let [middle, rim] = [pixels[20 * 40 + 20], pixels[20 * 40 + 32]];
        assert!(middle[0] > middle[2] && rim[2] > rim[0], "{middle:?} {rim:?}");
    }
}

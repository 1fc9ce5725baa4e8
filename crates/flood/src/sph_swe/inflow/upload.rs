//! The zones of sources as the shaders have them.

use crate::sph_swe::gpu::shared::{BAND, DISC};
use crate::sph_swe::gpu::upload::Origin;
use crate::zone::{Source, Zone};

/// The words of all zones, and the first word of that of each source: see `sph_spawn.wgsl`.
pub(in crate::sph_swe) fn zones(sources: &[Source], origin: Origin) -> (Vec<u32>, Vec<u32>) {
    let mut words = Vec::new();
    let firsts = sources.iter().map(|source| add(&mut words, &source.zone, origin)).collect();
    (words, firsts)
}

fn add(words: &mut Vec<u32>, zone: &Zone, origin: Origin) -> u32 {
    let (kind, corners, width): (u32, &[[f64; 2]], f64) = match zone {
        Zone::Disc { radius, .. } => (DISC, &[], *radius),
        Zone::Band { line, half_width } => (BAND, line, *half_width),
        Zone::Polygon(_) => unreachable!("sources are points and lines"),
    };
    let (first, count) = (words.len() as u32, corners.len() as u32);
    words.extend(corners.iter().flat_map(|corner| origin.relative(*corner).map(f32::to_bits)));
    let at = words.len() as u32;
    let [x, y] = origin.relative(zone.round().0);
    let length: f64 = corners.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1])).sum();
    words.extend([kind, first, count]);
    words.extend([width as f32, x, y, length as f32].map(f32::to_bits));
    at
}

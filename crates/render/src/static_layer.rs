//! The static layer: static things are drawn once, and kept from picture to picture while the camera rests: in plain light, and in light that casts
//! shadows where all things that cast one are static.

use crate::formats::{COLOUR_FORMAT, DEPTH_FORMAT};
use crate::view::{SHADOW_PIXELS, depth_map};
use crate::{Drawable, Light};
use corpuscle_gpu::{Gpu, wgpu};
use std::sync::atomic::{AtomicU64, Ordering};

/// A unique number for the appearance of a static thing.
pub(crate) fn new_state() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

/// Colour and depth of the static things, for one size of picture.
#[derive(Debug, Default)]
pub(crate) struct StaticLayer {
    /// The inputs of the last picture: camera, light and size, and the state of each static thing.
    by: Option<(Vec<u8>, Vec<u64>)>,
    textures: Option<[wgpu::Texture; 2]>,
    /// True where the textures hold it.
    drawn: bool,
    /// The sun's depth map, and whether light throws shadows that it is for.
    shadows: Option<(wgpu::TextureView, bool)>,
}

/// Use of the static layer in a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum StaticUse {
    /// Something has changed: static things are drawn with the rest.
    Changed,
    /// Nothing has changed since the last picture: static things are drawn alone and stored.
    Rests,
    /// The stored layer is used.
    Kept,
}

impl StaticLayer {
    /// The sun's depth map for such a light; what it holds stays from picture to picture.
    pub fn shadows(&mut self, gpu: &Gpu, light: &Light) -> wgpu::TextureView {
        let throws = light.throws_shadows();
        if let Some((map, _)) = self.shadows.as_ref().filter(|(_, threw)| *threw == throws) {
            return map.clone();
        }
        let map = depth_map(gpu, if throws { SHADOW_PIXELS } else { 1 });
        self.shadows = Some((map.clone(), throws));
        self.by = None;
        map
    }

    /// Decides how the layer is used in a picture with a camera and light.
    pub fn decide(&mut self, view: &[u8], light: &Light, things: &[&mut dyn Drawable]) -> StaticUse {
        let states: Vec<u64> = things.iter().filter_map(|thing| thing.static_state()).collect();
        let moves = |thing: &&mut dyn Drawable| {
            thing.static_state().is_none() && thing.throws_shadow() && !thing.lets_light_through()
        };
        if states.is_empty() || (light.throws_shadows() && things.iter().any(moves)) {
            self.by = None;
            return StaticUse::Changed;
        }
        let same = self.by.as_ref().is_some_and(|(last, of)| last == view && *of == states);
        if !same {
            self.by = Some((view.to_vec(), states));
            self.drawn = false;
            return StaticUse::Changed;
        }
        if std::mem::replace(&mut self.drawn, true) { StaticUse::Kept } else { StaticUse::Rests }
    }

    /// Stores the layer from the colour and depth of a target.
    pub fn keep(&mut self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, target: [&wgpu::Texture; 2]) {
        let kept = self.textures.get_or_insert_with(|| {
            [("static colours", COLOUR_FORMAT), ("static depth", DEPTH_FORMAT)].map(|(label, format)| {
                gpu.device.create_texture(&wgpu::TextureDescriptor {
                    label: Some(label),
                    size: target[0].size(),
                    mip_level_count: 1,
                    sample_count: 1,
                    dimension: wgpu::TextureDimension::D2,
                    format,
                    usage: wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST,
                    view_formats: &[],
                })
            })
        });
        copy(encoder, target, [&kept[0], &kept[1]]);
    }

    /// Copies the stored layer into the colour and depth of a target.
    pub fn lay(&self, encoder: &mut wgpu::CommandEncoder, target: [&wgpu::Texture; 2]) {
        if let Some([colour, depth]) = &self.textures {
            copy(encoder, [colour, depth], target);
        }
    }
}

fn copy(encoder: &mut wgpu::CommandEncoder, from: [&wgpu::Texture; 2], to: [&wgpu::Texture; 2]) {
    for (from, to) in from.into_iter().zip(to) {
        encoder.copy_texture_to_texture(from.as_image_copy(), to.as_image_copy(), from.size());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A static thing, or one that moves, with or without a shadow.
    struct Thing(Option<u64>, bool);

    impl Drawable for Thing {
        fn static_state(&self) -> Option<u64> {
            self.0
        }

        fn throws_shadow(&self) -> bool {
            self.1
        }
    }

    #[test]
    fn what_moves_without_a_shadow_leaves_the_rest_in_peace() {
        let uses = |throws: bool, light: &Light| {
            let (mut static_layer, mut ground, mut moving) =
                (StaticLayer::default(), Thing(Some(new_state()), true), Thing(None, throws));
            [(); 3].map(|()| static_layer.decide(&[1], light, &[&mut ground, &mut moving]))
        };
        let kept = [StaticUse::Changed, StaticUse::Rests, StaticUse::Kept];
        assert_eq!(uses(false, &Light::day()), kept);
        assert_eq!(uses(true, &Light::day()), [StaticUse::Changed; 3]);
        assert_eq!(uses(true, &Light::day().without_shadows()), kept);
    }
}

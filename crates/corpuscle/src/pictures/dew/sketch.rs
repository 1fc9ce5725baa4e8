//! Dew as discs: solids by their patches, drops, and the air of a section.

use super::section::{RADIUS, Section, temperatures};
use super::{FIELD_OF_VIEW, MARGIN, MATT, RAISED, Room, azimuth, shows_air};
use crate::pictures::{Disc, Moment, OwnView, Patch, Sketch, SketchView, Sketcher};
use corpuscle_dew::humid_air::ZERO_CELSIUS;
use corpuscle_drawing::text;
use corpuscle_model::{ParticleSet, Surface};
use corpuscle_render::{Axes, Overlay, Stage};
use corpuscle_scene::Dew;

/// Colour of drops.
const WATER: [u8; 3] = [0x3d, 0x93, 0xd8];
/// Darkest and brightest patches of a solid, over its colour.
const SHADE: [f64; 2] = [0.75, 1.2];
/// Side of a drawn patch over its own, so that there are no gaps.
const PATCH: f64 = 1.03;

/// Sketches dew.
pub(crate) struct DewSketch {
    stage: Stage,
    /// The section, where the air is shown.
    section: Option<Section>,
    patches: Vec<Patch>,
    azimuth: f64,
    /// Distance of particles of air, m.
    spacing: f64,
}

impl DewSketch {
    pub(crate) fn new(dew: &Dew, surfaces: &[Surface]) -> Self {
        let section = shows_air(dew).then(|| Section::new(dew, surfaces));
        let stage = section.as_ref().map_or_else(|| Room::stage(dew, surfaces), |section| section.stage);
        let azimuth = azimuth(surfaces);
        let light = [azimuth.cos() * 0.5, azimuth.sin() * 0.5, 0.8];
        let patches = surfaces.iter().flat_map(|surface| patches(surface, light)).collect();
        Self { stage, section, patches, azimuth, spacing: dew.spacing_m }
    }

    fn air(&self, section: &Section, set: &ParticleSet) -> Vec<Disc> {
        let disc = |(position, kelvin): (&[f64; 3], &f64)| Disc {
            position: *position,
            radius: RADIUS * self.spacing,
            colour: section.colours.colour((kelvin - ZERO_CELSIUS) as f32),
            has_rim: true,
        };
        set.position.iter().zip(temperatures(set)).map(disc).collect()
    }
}

impl Sketcher for DewSketch {
    fn sketch(&mut self, seen: &SketchView, title: &str, moment: &Moment<'_>) -> Sketch {
        let sets = |name: &'static str| moment.frame.sets.iter().filter(move |set| set.name == name);
        let mut discs = Vec::new();
        let (camera, overlay) = match &self.section {
            Some(section) => {
                discs.extend(sets("air").flat_map(|set| self.air(section, set)));
                (section.camera(&seen.camera_offset, seen.aspect), section.overlay(title, moment.frame.time))
            }
            None => {
                let own = OwnView {
                    direction: [self.azimuth, RAISED],
                    field_of_view: FIELD_OF_VIEW,
                    margin: MARGIN,
                    margins: [2.0 * MARGIN; 4],
                };
                let (from, to) = (self.stage.from.into(), self.stage.to.into());
                let overlay = Overlay {
                    title: title.into(),
                    time: format!("t = {}", text::time(moment.frame.time)),
                    axes: Some(Axes { from, to, unit: "m".into(), heights: 1.0 }),
                    ..Overlay::default()
                };
                (seen.orbit(&self.stage, &own), overlay)
            }
        };
        for set in sets("drops") {
            let drops = set.position.iter().zip(&set.radius);
            discs.extend(drops.map(|(position, radius)| Disc {
                position: *position,
                radius: *radius,
                colour: WATER,
                has_rim: true,
            }));
        }
        Sketch {
            shown: seen.shown(self.stage, camera, overlay),
            patches: self.patches.clone(),
            discs,
            lines: Vec::new(),
        }
    }
}

/// The patches of a solid, brighter where they face the light.
fn patches(surface: &Surface, light: [f64; 3]) -> Vec<Patch> {
    let each = surface.position.iter().zip(&surface.normal).zip(&surface.half_width);
    let patch = |((position, normal), half_width): ((&[f64; 3], &[f64; 3]), &f64)| {
        let facing = (0..3).map(|axis| normal[axis] * light[axis]).sum::<f64>().clamp(-1.0, 1.0);
        let shade = SHADE[0] + (SHADE[1] - SHADE[0]) * (0.5 + 0.5 * facing);
        let colour = MATT.map(|channel| (f64::from(channel) * shade).min(255.0) as u8);
        Patch::across(*position, *normal, PATCH * half_width, colour)
    };
    each.map(patch).collect()
}

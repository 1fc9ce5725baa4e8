//! Pictures of dew: drops on solids in a dim room, against which they show; and air round solids, where boundary treatments are
//! compared.

mod section;
mod sketch;

use super::{DrawContext, Moment, OwnView, Shown, Subject};
use crate::Error;
use corpuscle_drawing::text;
use corpuscle_model::{ParticleSet, Surface, Values};
use corpuscle_render::{Axes, Cap, Drawable, Floor, FogPatch, Light, Overlay, Solid, SolidStyle, Stage};
use corpuscle_scene::Dew;
use corpuscle_scene::dew::Material;
use section::SectionPicture;
pub(crate) use sketch::DewSketch;

/// Azimuth of the camera from the normal of the wet side, its elevation, and field of view, radians.
const BESIDE: f64 = 0.45;
const RAISED: f64 = 0.2;
const FIELD_OF_VIEW: f64 = 0.5;
const MARGIN: f64 = 0.09;
/// Azimuth of the sun to the left of the camera, radians.
const SUN: f64 = -1.0;
/// Default azimuth of the camera for solids without a common wet side, radians.
const NO_SIDE: f64 = -1.9;
/// Light that the clearest glass transmits: least of red.
const GLASS: [u8; 3] = [232, 242, 238];
/// Colour of solids that are not glass.
const MATT: [u8; 3] = [150, 152, 156];

/// True where pictures show the air instead of the drops: where boundary treatments are compared.
pub(crate) fn shows_air(dew: &Dew) -> bool {
    dew.solid.windows(2).any(|pair| pair[0].treatment != pair[1].treatment)
}

/// Draws dew.
pub(crate) enum DewPicture {
    Room(Room),
    Section(SectionPicture),
}

impl DewPicture {
    pub(crate) fn new(context: &DrawContext, dew: &Dew, surfaces: &[Surface]) -> Self {
        match shows_air(dew) {
            true => Self::Section(SectionPicture::new(context, dew, surfaces)),
            false => Self::Room(Room::new(context, dew, surfaces)),
        }
    }
}

impl Subject for DewPicture {
    fn draw(&mut self, context: &DrawContext, title: &str, moment: &Moment<'_>) -> Result<Shown, Error> {
        match self {
            Self::Room(room) => room.draw(context, title, moment),
            Self::Section(section) => section.draw(context, title, moment),
        }
    }

    fn draws_from_device(&self) -> bool {
        matches!(self, Self::Section(_))
    }
}

/// Drops on solids.
pub(crate) struct Room {
    stage: Stage,
    solids: Vec<Solid>,
    floor: Floor,
    /// Azimuth of the camera, radians.
    azimuth: f64,
}

impl Room {
    fn new(context: &DrawContext, dew: &Dew, surfaces: &[Surface]) -> Self {
        let stage = Self::stage(dew, surfaces);
        let style = |surface: &Surface| {
            let solid = dew.solid.iter().find(|solid| solid.name == surface.name);
            solid.map_or(SolidStyle::Opaque(MATT, 0.6), |solid| style(&solid.material))
        };
        let solids =
            surfaces.iter().map(|surface| Solid::new(&context.renderer, &stage, &surface.shape, style(surface)));
        let floor = Floor::new(&context.renderer, stage.from.z - 0.002 * stage.unit());
        Self { solids: solids.collect(), floor, azimuth: azimuth(surfaces), stage }
    }

    /// The solids' box; the room where there are none.
    fn stage(dew: &Dew, surfaces: &[Surface]) -> Stage {
        let corner = |pick: fn(f64, f64) -> f64, side: usize, start: f64| {
            std::array::from_fn(|k| surfaces.iter().map(|surface| surface.shape.bounds[side][k]).fold(start, pick))
        };
        match surfaces {
            [] => Stage::new([0.0; 3], dew.size_m),
            _ => Stage::new(corner(f64::min, 0, f64::INFINITY), corner(f64::max, 1, f64::NEG_INFINITY)),
        }
    }

    fn draw(&mut self, context: &DrawContext, title: &str, moment: &Moment<'_>) -> Result<Shown, Error> {
        let own = OwnView {
            direction: [self.azimuth, RAISED],
            field_of_view: FIELD_OF_VIEW,
            margin: MARGIN,
            margins: [2.0 * MARGIN; 4],
        };
        let camera = context.camera(&self.stage, &own, moment.frame.time);
        let light = context.lit(Light::dim_room().from_azimuth(self.azimuth + SUN));
        let drops: Vec<Cap> = moment.frame.sets.iter().filter(|set| set.name == "drops").flat_map(caps).collect();
        let faces = |normal: [f64; 3], position: [f64; 3]| {
            let eye: [f64; 3] = camera.eye.into();
            (0..3).map(|k| normal[k] * (eye[k] - position[k])).sum::<f64>() > 0.0
        };
        let faces_eye = |cap: &&Cap| faces(cap.normal, cap.position);
        let gpu = context.renderer.gpu();
        // Drops and fog on the far side are seen through the solid, so they are drawn before it.
        let far = drops.iter().filter(|cap| !faces_eye(cap)).copied();
        let mut far = context.caps.caps(gpu, &self.stage, far, []);
        let near = drops.iter().filter(faces_eye).copied();
        let fog = moment.frame.sets.iter().filter(|set| set.name == "unseen").flat_map(fog);
        let (near_fog, far_fog): (Vec<_>, Vec<_>) = fog.partition(|patch| faces(patch.normal, patch.position));
        let far_sides = self.solids.iter().filter_map(Solid::far_side);
        let mut far_fog = context.caps.caps(gpu, &self.stage, [], far_fog).on_far_sides(far_sides);
        let mut near = context.caps.caps(gpu, &self.stage, near, near_fog);
        let mut things: Vec<&mut dyn Drawable> = vec![&mut far_fog];
        if !context.target.transparent {
            things.push(&mut self.floor);
        }
        things.push(&mut far);
        things.extend(self.solids.iter_mut().map(|solid| solid as &mut dyn Drawable));
        things.push(&mut near);
        let overlay = Overlay {
            title: title.into(),
            time: format!("t = {}", text::time(moment.frame.time)),
            axes: Some(Axes { from: self.stage.from.into(), to: self.stage.to.into(), unit: "m".into(), heights: 1.0 }),
            ..Overlay::default()
        };
        context.take(&self.stage, &camera, &light, &mut things, overlay)
    }
}

/// Style of a solid of a material.
fn style(material: &Material) -> SolidStyle {
    let Material::Named(name) = material else { return SolidStyle::Opaque(MATT, 0.6) };
    match name.as_str() {
        "glass" | "pmma" | "polycarbonate" => SolidStyle::Glass(GLASS),
        "oak" | "wood" => SolidStyle::Opaque([150, 105, 66], 0.35),
        "copper" => SolidStyle::Opaque([184, 115, 62], 1.0),
        "concrete" => SolidStyle::Opaque([150, 146, 138], 0.0),
        _ => SolidStyle::Opaque(MATT, 0.6),
    }
}

/// Azimuth of the camera: a little beside the wet side.
fn azimuth(surfaces: &[Surface]) -> f64 {
    wet_side(surfaces) + BESIDE
}

/// Azimuth of the mean normal of the wet patches of all solids; none where they have no common side.
fn wet_side(surfaces: &[Surface]) -> f64 {
    let mut sum = [0.0; 2];
    for surface in surfaces {
        for (normal, half_width) in surface.normal.iter().zip(&surface.half_width) {
            (0..2).for_each(|k| sum[k] += normal[k] * half_width * half_width);
        }
    }
    let area: f64 = surfaces.iter().flat_map(|surface| &surface.half_width).map(|half| half * half).sum();
    if sum[0].hypot(sum[1]) > 0.2 * area { sum[1].atan2(sum[0]) } else { NO_SIDE }
}

/// The patches with unseen drops of a set.
fn fog(set: &ParticleSet) -> Vec<FogPatch> {
    let column = |name: &str| set.columns.iter().find(|column| column.name == name).map(|column| &column.values);
    let (Some(Values::Scalar(parts)), Some(Values::Vector(normals))) = (column("covered_part"), column("normal"))
    else {
        return Vec::new();
    };
    let patch = |at: usize| FogPatch {
        position: set.position[at],
        half_width: set.radius[at],
        normal: normals[at],
        covered: parts[at],
    };
    (0..set.len()).map(patch).collect()
}

/// The drops of a set.
fn caps(set: &ParticleSet) -> Vec<Cap> {
    let column = |name: &str| set.columns.iter().find(|column| column.name == name).map(|column| &column.values);
    let (Some(Values::Scalar(heights)), Some(Values::Vector(normals))) = (column("height"), column("normal")) else {
        return Vec::new();
    };
    let drops = set.position.iter().zip(&set.radius).zip(heights.iter().zip(normals));
    drops
        .map(|((position, radius), (height, normal))| Cap {
            position: *position,
            radius: *radius,
            normal: *normal,
            height: *height,
        })
        .collect()
}

//! Pictures of a run: what is drawn of each model, with which camera and colours.

mod camera_offset;
mod device;
pub(crate) mod dew;
pub(crate) mod flood;
pub(crate) mod flood_sketch;
#[cfg(all(test, feature = "gpu"))]
mod flood_surface;
pub(crate) mod gas;
mod ground_style;
mod lines;
mod particles;
mod photo;
mod scenery;
mod sheet;
mod show;
mod sketch;
mod subject;
mod sunlight;
mod times;
mod viewpoint;
mod water_colour;

use crate::Error;
pub use camera_offset::CameraOffset;
use corpuscle_drawing::svg::Figure;
use corpuscle_gpu::{DeviceParticles, Gpu, Image};
pub use corpuscle_model::Glance;
use corpuscle_model::{Container, Frame, Path};
use corpuscle_render::{
    BallPainter, Camera, CapPainter, Drawable, FluidPainter, Light, Overlay, Renderer, Stage, Target, TubePainter,
};
use corpuscle_scene::Flood;
use corpuscle_terrain::Terrain;
pub(crate) use device::{gpu_of, particles_of};
use flood::FloodPicture;
pub use ground_style::GroundStyle;
pub use particles::Particles;
pub use photo::ground_picture;
pub use scenery::{Made, Scenery};
pub use sheet::Sheet;
pub use show::{Quality, Shown};
pub use sketch::{Disc, GroundMap, Line, Patch, Sketch, SketchView, Sketcher, Sketches};
pub use subject::Subject;
pub use sunlight::Sun;
pub use viewpoint::Viewpoint;
use viewpoint::{OwnView, Station};
pub use water_colour::WaterColour;

/// Settings of pictures.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureSettings {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Samples each way in a pixel: 2 for stills; 1 is fast.
    pub samples: u32,
    /// Viewpoints at times, s: one is a fixed camera, several are stations of a moving one; none is the model's default
    /// camera.
    pub viewpoints: Vec<(f64, Viewpoint)>,
    /// Surface style of the terrain of a flood.
    pub ground: GroundStyle,
    /// Exaggeration of the heights of a flood.
    pub heights: f64,
    /// Colour of the water of a flood.
    pub water: WaterColour,
    /// Where the sun stands over a flood.
    pub sun: Sun,
    /// True to leave the background and the floor out, so that they are transparent.
    pub transparent: bool,
    /// True for an arrow towards north in pictures of floods that are not plans, which always have one.
    pub north: bool,
    /// A text below the title; may be empty.
    pub caption: String,
}

impl Default for PictureSettings {
    fn default() -> Self {
        Self {
            size: [1920, 1080],
            samples: 2,
            viewpoints: Vec::new(),
            ground: GroundStyle::Natural,
            heights: 1.0,
            water: WaterColour::default(),
            sun: Sun::default(),
            transparent: false,
            north: false,
            caption: String::new(),
        }
    }
}

/// A model at one time, as a picture shows it.
#[derive(Debug, Clone, Copy)]
pub struct Moment<'a> {
    /// The particles.
    pub frame: &'a Frame,
    /// The water of a flood, or the air, in memory of the device that draws: drawn instead of the frame's, except with [`GroundStyle::Depth`].
    pub on_device: Option<&'a DeviceParticles>,
    /// Trajectories of followed particles; only the part before the frame's time is drawn.
    pub paths: &'a [Path],
    /// The box round the particles.
    pub container: Option<Container>,
}

/// Draws pictures of one run.
pub struct Pictures {
    context: DrawContext,
    title: String,
    subject: Box<dyn Subject>,
}

/// Renderer, painters, target and camera settings that all subjects draw with.
pub struct DrawContext {
    renderer: Renderer,
    balls: BallPainter,
    tubes: TubePainter,
    caps: CapPainter,
    fluids: FluidPainter,
    target: Target,
    stations: Vec<Station>,
    /// How the user moved the camera.
    camera_offset: CameraOffset,
    quality: Quality,
    /// Background of a drawing, linear light.
    paper: [f32; 3],
    /// True where text and lines are drawn into the picture; false where the caller draws them.
    overlaid: bool,
    /// True where they are drawn for a file of their own.
    overlay_apart: bool,
    /// True for an arrow towards north in pictures that are not plans.
    north: bool,
    /// A text below the title.
    caption: String,
    /// A small drawing in a lower corner.
    inset: Option<Figure>,
}

impl Pictures {
    /// Pictures with a title, by a model's own drawing.
    pub(crate) fn new(context: DrawContext, title: String, subject: Box<dyn Subject>) -> Self {
        Self { context, title, subject }
    }

    /// Opens pictures of a flood without scene, on a device that is open already.
    ///
    /// # Errors
    /// [`Error::Render`] where the pictures are larger than the device can hold.
    pub fn of_flood(gpu: &Gpu, flood: &Flood, ground: &Terrain, settings: PictureSettings) -> Result<Self, Error> {
        let context = DrawContext::new(gpu, &settings, Some(ground))?;
        let flood = FloodPicture::new(&context, flood, ground, flood::drawn_ground(ground), &settings)?;
        Ok(Self::new(context, String::new(), Box::new(flood)))
    }

    /// The device that draws, by its name.
    pub fn device(&self) -> &str {
        &self.context.renderer.gpu().name
    }

    /// Draws a small drawing into a lower corner of the next pictures.
    pub fn set_inset(&mut self, inset: Option<Figure>) {
        self.context.inset = inset;
    }

    /// The picture of a moment.
    ///
    /// # Errors
    /// [`Error::Render`] where the device was lost.
    pub fn draw(&mut self, moment: &Moment<'_>) -> Result<Image, Error> {
        self.still(moment, &CameraOffset::default())
    }

    /// The same with its overlay apart.
    ///
    /// # Errors
    /// [`Error::Render`] where the device was lost.
    pub fn draw_apart(&mut self, moment: &Moment<'_>) -> Result<(Image, Figure), Error> {
        self.context.overlay_apart = true;
        let shown = self.draw_still(moment, &CameraOffset::default());
        self.context.overlay_apart = false;
        let Shown { stage, camera, overlay, .. } = shown?;
        Ok((self.read()?, overlay.figure(&stage, &camera, self.context.target.size)))
    }
}

impl DrawContext {
    pub(crate) fn new(gpu: &Gpu, settings: &PictureSettings, ground: Option<&Terrain>) -> Result<Self, Error> {
        let renderer = Renderer::new(gpu);
        let target = Target::new(gpu, settings.size, settings.samples)?.without_background(settings.transparent);
        let viewpoints = settings.viewpoints.iter().copied();
        let stations = match ground {
            Some(ground) => viewpoints.map(|at| Station::on_ground(at, ground, settings.heights)).collect(),
            None => viewpoints.map(Station::plain).collect(),
        };
        let (balls, tubes) = (BallPainter::new(&renderer), TubePainter::new(&renderer));
        let caps = CapPainter::new(&renderer);
        let fluids = FluidPainter::new(&renderer);
        Ok(Self {
            renderer,
            balls,
            tubes,
            caps,
            fluids,
            target,
            stations,
            camera_offset: CameraOffset::default(),
            quality: Quality::Full,
            paper: [1.0; 3],
            overlaid: true,
            overlay_apart: false,
            north: settings.north,
            caption: settings.caption.clone(),
            inset: None,
        })
    }

    /// Width of a picture over its height.
    fn aspect(&self) -> f64 {
        let [width, height] = self.target.size;
        f64::from(width) / f64::from(height)
    }

    /// The light at the current quality.
    fn lit(&self, light: Light) -> Light {
        if self.quality == Quality::Full { light } else { light.without_shadows() }
    }

    /// An overlay with what the user wants in it.
    fn annotated(&self, overlay: Overlay) -> Overlay {
        Overlay { caption: self.caption.clone(), inset: self.inset.clone(), ..overlay }
    }

    /// Draws things, with their overlay if it is wanted in the picture.
    fn take(
        &self,
        stage: &Stage,
        camera: &Camera,
        light: &Light,
        things: &mut [&mut dyn Drawable],
        overlay: Overlay,
    ) -> Result<Shown, Error> {
        let overlay = if self.overlaid { self.annotated(overlay) } else { overlay };
        let quick = !self.overlaid && self.quality == Quality::Simple && self.target.samples == 1;
        if quick {
            self.renderer.draw_light(&self.target, stage, camera, light, things);
        } else {
            let is_drawn = self.overlaid && !self.overlay_apart;
            let image = if is_drawn { Some(overlay.image(stage, camera, self.target.size)?) } else { None };
            self.renderer.draw(&self.target, stage, camera, light, things, image.as_ref());
        }
        Ok(Shown { stage: *stage, camera: *camera, on_paper: !light.is_lit(), finished: !quick, overlay })
    }
}

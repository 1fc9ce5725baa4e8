//! Pictures of a model's frames on the GPU, off screen or on.
//!
//! A [`Renderer`] draws [`Drawable`] things, seen by a [`Camera`] under a [`Light`], into a [`Target`], from which a picture is
//! read back. It depends on no physics and no files.
//!
//! Things are drawn in the coordinates of a [`Stage`]: relative to the middle of what is shown, its half diagonal 1. So a gas of
//! nanometres and a valley of kilometres have the same relative error in single precision.

mod balls;
mod buffer;
mod camera;
mod camera_path;
mod caps;
mod colour;
mod drawable;
mod error;
mod floor;
mod fluid;
mod formats;
mod inlay;
mod light;
mod overlay;
mod pipeline;
mod renderer;
mod shaders;
mod shared;
mod solids;
mod stage;
mod static_layer;
mod target;
mod terrain;
mod tone;
mod tubes;
mod view;

pub use balls::{BallPainter, BallStyle, Balls, BallsOfDevice, Shading, ValueOfDevice};
pub use camera::{Camera, Lens, ProjectedBall, Projection};
pub use camera_path::CameraPath;
pub use caps::{Cap, CapPainter, Caps, FarFog, FogPatch};
pub use colour::{ColourTable, linear};
pub use drawable::{Before, Drawable, Through};
pub use error::RenderError;
pub use floor::Floor;
pub use fluid::{DeviceWater, Droplet, Fluid, FluidPainter, FluidPass, FluidStyle, Smoothing, Water, WaterSides};
pub use formats::{COLOUR_FORMAT, DEPTH_FORMAT};
pub use inlay::{Inlay, InlayPainter};
pub use light::{Backdrop, Light};
pub use overlay::{Axes, AxisOnPage, Border, Key, KeyPosition, LineStyle, Mark, Overlay};
pub use renderer::Renderer;
pub use solids::{FarSide, Solid, SolidStyle};
pub use stage::Stage;
pub use target::Target;
pub use terrain::{HeightField, Terrain, natural_colours};
pub use tubes::{TubePainter, TubeStyle, Tubes, box_edges};
pub use view::View;

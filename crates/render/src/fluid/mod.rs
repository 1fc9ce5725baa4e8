//! Screen-space water: particles are drawn, their nearest surface is smoothed in the picture, and the resulting surface
//! is shaded (van der Laan, Green and Sainz, Screen Space Fluid Rendering with Curvature Flow, 2009; the flood paper of 2021).
//!
//! ```text
//! depth      particles as sprites, the nearest surface of them          fluid_depth.wgsl
//! thickness  the same, added up: water, foam and flow in a line of sight fluid_thickness.wgsl
//! smoothing  narrow-range or bilateral filter of depth                  narrow_range.wgsl, bilateral.wgsl
//! normals    from the smoothed depth                                    fluid_normals.wgsl
//! wetting    ground that is under water now                            wet_ground/wet_mark.wgsl
//! shading    ripples, refraction, mirror, highlight, foam               fluid_shade.wgsl, ripples.wgsl, mirror.wgsl
//! composing  into the picture, where it is not hidden; wet ground       fluid_compose.wgsl, wet_ground/wetness.wgsl
//! ```
//!
//! Whatever does arithmetic pixel by pixel is a compute shader: fragment shaders only draw sprites and copy. On GPUs, which have few
//! raster units for small sprites, compute shaders draw the particles as well, as splats: splat_depth.wgsl and splat_nearest.wgsl,
//! splat_thickness.wgsl and splat_added.wgsl.

mod device;
mod droplet;
mod layers;
mod painter;
mod passes;
mod sides;
mod style;
mod thing;
mod water;
mod wet_ground;

#[cfg(test)]
mod picture;

pub use device::DeviceWater;
pub use droplet::Droplet;
pub use painter::FluidPainter;
pub use passes::FluidPass;
pub use sides::WaterSides;
pub use style::{FluidStyle, Smoothing};
pub use thing::Fluid;
pub use water::Water;

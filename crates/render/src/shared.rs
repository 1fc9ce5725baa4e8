//! Structures and constants shared by the host and the shaders of this crate, declared once. Shaders take them in by `#import declared`; the bindings stand in the shaders.

use corpuscle_gpu::{Layout, SharedPiece, wgpu};

/// Acceleration of free fall, m/s2, in double precision: `GRAVITY` of shaders.
pub(crate) const FREE_FALL: f64 = 9.81;

corpuscle_gpu::declare! {
    constants {
        /// Circumference of a circle over its width.
        pub(crate) const PI: f32 = std::f32::consts::PI;
        /// Turns by it spread what is placed one after the other evenly round a circle, radians.
        pub(crate) const GOLDEN_ANGLE: f32 = 2.399_963_2;
        /// Threads of a group that goes through the pixels of a picture, eastwards.
        pub(crate) const PIXELS_ACROSS: u32 = 32;
        /// The same downwards.
        pub(crate) const PIXELS_DOWN: u32 = 2;
        /// Threads of a group of those that splat particles.
        pub(crate) const SPLAT_GROUP: u32 = 128;
        /// Index of the number of particles in the arguments of splats.
        pub(crate) const SPLAT_COUNT: u32 = 25;
        /// Numbers a pixel in which splats add up water, foam and flow.
        pub(crate) const SUMS: u32 = 7;
        /// m/s2.
        pub(crate) const GRAVITY: f32 = FREE_FALL as f32;
        /// sRGB (IEC 61966-2-1): a straight line for dark colours, `linear * SRGB_SLOPE`, and `SRGB_SCALE * linear^(1 / SRGB_EXPONENT) - SRGB_OFFSET` above.
        pub(crate) const SRGB_SLOPE: f32 = 12.92;
        /// See above.
        pub(crate) const SRGB_SCALE: f32 = 1.055;
        /// See above.
        pub(crate) const SRGB_OFFSET: f32 = 0.055;
        /// See above.
        pub(crate) const SRGB_EXPONENT: f32 = 2.4;
        /// Where the line ends, in sRGB.
        pub(crate) const SRGB_LINE_END: f32 = 0.04045;
        /// The same in linear light.
        pub(crate) const SRGB_LINE_END_LINEAR: f32 = 0.003_130_8;
        /// Quads along a side of a tile of the ground.
        pub(crate) const QUADS: u32 = 64;
    }
    structs {
        /// Camera, light and size of a picture. All in stage coordinates: the half diagonal of what is shown is 1. Depth is 1 near and 0 far; nothing drawn is 0.
        pub(crate) struct CameraAndLight {
            /// From the stage to clip space.
            pub(crate) clip_from_world: [[f32; 4]; 4],
            /// Back.
            pub(crate) world_from_clip: [[f32; 4]; 4],
            /// From the stage to what the camera has before it.
            pub(crate) view_from_world: [[f32; 4]; 4],
            /// Back.
            pub(crate) world_from_view: [[f32; 4]; 4],
            /// From there to clip space.
            pub(crate) clip_from_view: [[f32; 4]; 4],
            /// Back.
            pub(crate) view_from_clip: [[f32; 4]; 4],
            /// From the stage to the clip space of the sun's depth map.
            pub(crate) sun_from_world: [[f32; 4]; 4],
            /// Position of the eye; 1 with perspective, 0 without.
            pub(crate) eye: [f32; 4],
            /// Line of sight; height of a pixel, at distance 1 where there is perspective.
            pub(crate) forward: [f32; 4],
            /// Direction towards the sun; tangent of half the angle it fills.
            pub(crate) sun: [f32; 4],
            /// Its light; strength of the light from all round.
            pub(crate) sunlight: [f32; 4],
            /// Light from overhead.
            pub(crate) above: [f32; 4],
            /// Light from the horizon.
            pub(crate) horizon: [f32; 4],
            /// Light from below.
            pub(crate) below: [f32; 4],
            /// Width and height of the target, pixels; metres in a stage unit; 0 sky, 1 studio, 1.25 room, 2 paper.
            pub(crate) frame: [f32; 4],
        }

        /// How the samples of a picture become bytes.
        pub(crate) struct Tone {
            /// Samples each way in a pixel.
            pub(crate) samples: u32,
            /// 0 for colours as they are, 1 where highlights are pressed.
            pub(crate) pressed: u32,
            /// Whether something is laid over.
            pub(crate) overlay: u32,
            /// Whether the background is left out.
            pub(crate) transparent: u32,
        }

        /// A ball, in stage coordinates.
        pub(crate) struct BallInstance {
            /// Middle.
            pub(crate) x: f32,
            /// Middle.
            pub(crate) y: f32,
            /// Middle.
            pub(crate) z: f32,
            /// Below 0 where there is no ball.
            pub(crate) radius: f32,
            /// The number that its colour shows.
            pub(crate) value: f32,
        }

        /// Style of balls.
        pub(crate) struct BallUniforms {
            /// The number of the first colour.
            pub(crate) low: f32,
            /// The number of the last colour.
            pub(crate) high: f32,
            /// Part of light that the coat mirrors.
            pub(crate) gloss: f32,
            /// Least radius, samples.
            pub(crate) least: f32,
        }

        /// A drop as a cap on a surface, in stage coordinates.
        pub(crate) struct CapInstance {
            /// Middle of the disc that it covers.
            pub(crate) position: [f32; 3],
            /// Radius of the disc.
            pub(crate) radius: f32,
            /// The way out of the surface, of length 1.
            pub(crate) out: [f32; 3],
            /// Height.
            pub(crate) height: f32,
            /// Where its neighbours' numbers begin, and how many there are.
            pub(crate) neighbours: [u32; 2],
            /// Of a patch with drops too small to be drawn one by one the part that they cover; 0 for a drop.
            pub(crate) covered: f32,
            /// Fills up.
            pub(crate) unused: u32,
        }

        /// Style of drops.
        pub(crate) struct CapUniforms {
            /// How far they reach for each other.
            pub(crate) neck: f32,
            /// Drops of smaller radius are fog, samples.
            pub(crate) finest: f32,
            /// Fills up.
            pub(crate) unused: [f32; 2],
        }

        /// The ground's grid, in stage units.
        pub(crate) struct Ground {
            /// West and south end, and height of a stage unit's zero.
            pub(crate) origin: [f32; 4],
            /// Length of a cell east and north; the last is 1 where it has the grain of natural ground.
            pub(crate) cell: [f32; 4],
            /// Nodes east and north.
            pub(crate) nodes: [u32; 4],
        }

        /// Style of a solid.
        pub(crate) struct SolidUniforms {
            /// Colour; of glass what is left of light straight through.
            pub(crate) colour: [f32; 4],
            /// Part of light that the coat mirrors, first.
            pub(crate) gloss: [f32; 4],
            /// Colour of the roof; 1 for a building.
            pub(crate) roof: [f32; 4],
        }

        /// Style of a fluid.
        pub(crate) struct FluidUniforms {
            /// Part of light that is lost in a metre of water (1/m); density of foam that hides what is below.
            pub(crate) absorption: [f32; 4],
            /// Light that deep water gives back in full light; strength of the sun's highlight.
            pub(crate) colour: [f32; 4],
            /// Half the width of the smoothing, how far depths may part, what is farther is taken for (stage units); most pixels.
            pub(crate) smoothing: [f32; 4],
            /// Exponent of the highlight; depth over which a film begins to be seen, m.
            pub(crate) surface: [f32; 4],
            /// West, south, east and north end of what is drawn.
            pub(crate) within: [f32; 4],
            /// Length of the longest ripples, stage units; steepness of ripples on fast water; time, s; time in which a pattern that goes with the water comes and goes, s.
            pub(crate) ripples: [f32; 4],
        }

        /// The grid of ground that was under water.
        pub(crate) struct WetGround {
            /// Its south-western corner, stage units.
            pub(crate) corner: [f32; 2],
            /// Cells in a stage unit.
            pub(crate) per_unit: f32,
            /// How far above the water ground is soaked, stage units.
            pub(crate) soaked: f32,
            /// Cells eastwards and northwards.
            pub(crate) cells: [u32; 2],
            /// Time since the first picture, and 1, s.
            pub(crate) now: f32,
            /// 1 over the time in which ground dries, 1/s.
            pub(crate) drying: f32,
        }

        /// A floor that only its shadows show.
        pub(crate) struct Floor {
            /// Height in stage coordinates.
            pub(crate) height: f32,
            /// How dark the darkest shadow is.
            pub(crate) darkness: f32,
            /// Fills up.
            pub(crate) unused: [f32; 2],
        }

        /// The way a pass over the pixels goes.
        pub(crate) struct Direction {
            /// (1, 0) or (0, 1).
            pub(crate) step: [i32; 2],
            /// Fills up.
            pub(crate) unused: [i32; 2],
        }
    }

    /// What shaders read by their bindings.
    pub(crate) piece Bound;
}

corpuscle_gpu::declare! {
    constants {}
    structs {
        /// A corner of a surface, in stage units.
        pub(crate) struct Vertex {
            /// Position; of sides cut upright the depth below the surface.
            pub(crate) position: [f32; 4],
            /// Direction out of the surface.
            pub(crate) normal: [f32; 4],
        }

        /// A particle of a fluid as a ball, or flattened along a direction; in stage coordinates.
        pub(crate) struct DropletInstance {
            /// Middle.
            pub(crate) position: [f32; 3],
            /// Radius across `normal`.
            pub(crate) radius: f32,
            /// The direction along which it is flattened, of length 1.
            pub(crate) normal: [f32; 3],
            /// Thickness over width: 1 for a ball.
            pub(crate) flatness: f32,
            /// What pass thickness adds up: depth in the middle, m (0: a ball, whose chord counts), foam, radius of the footprint; its number, by which tests tell them apart.
            pub(crate) matter: [f32; 4],
            /// Velocity eastwards and northwards, m/s.
            pub(crate) flow: [f32; 2],
            /// Fills up.
            pub(crate) unused: [f32; 2],
        }

        /// A tile of the ground.
        pub(crate) struct TileInstance {
            /// Its first node, eastwards and northwards.
            pub(crate) first: [u32; 2],
            /// How many nodes of the ground its own are apart.
            pub(crate) stride: u32,
            /// Fills up.
            pub(crate) unused: u32,
        }

        /// A piece of a tube, in stage coordinates.
        pub(crate) struct TubeInstance {
            /// One end, and the radius.
            pub(crate) from_end: [f32; 4],
            /// The other end, and the least radius, samples.
            pub(crate) to_end: [f32; 4],
            /// Linear colour; 1 with shading.
            pub(crate) colour: [f32; 4],
        }
    }

    /// What vertex shaders take in from vertex buffers.
    pub(crate) piece Vertices;
}

/// All in WGSL.
pub(crate) fn declared() -> String {
    let vertices: String = Vertices::structs().iter().map(Layout::wgsl_of_vertex).collect();
    Bound::wgsl() + &vertices
}

/// The layout of a vertex buffer of structures of one kind, whose members are `attributes`.
pub(crate) fn buffer_layout<'a>(
    layout: &Layout,
    step_mode: wgpu::VertexStepMode,
    attributes: &'a [wgpu::VertexAttribute],
) -> wgpu::VertexBufferLayout<'a> {
    wgpu::VertexBufferLayout { array_stride: layout.size as u64, step_mode, attributes }
}

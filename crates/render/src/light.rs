//! Sunlight and background.

use glam::Vec3;

/// Sun and surroundings. Colours are linear; 1 is what white paper in full light gives back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// Direction of the sun: azimuth (from east over north) and height above the horizon, radians.
    pub sun: [f32; 2],
    /// Colour and strength of sunlight.
    pub sunlight: [f32; 3],
    /// Angular radius of the sun, radians: softness of shadows. The real one has 0.0047.
    pub softness: f32,
    /// Strength of the light that comes from the backdrop.
    pub ambient: f32,
    /// The background, which surfaces also reflect.
    pub backdrop: Backdrop,
    /// True where sunlight casts shadows.
    pub shadows: bool,
}

/// The background.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Backdrop {
    /// A clear sky with the sun in it.
    Sky {
        /// Overhead.
        above: [f32; 3],
        /// At the horizon.
        horizon: [f32; 3],
        /// Of the ground, seen straight down.
        below: [f32; 3],
    },
    /// A colour overhead, one at the horizon and one below it.
    Studio {
        /// Overhead.
        above: [f32; 3],
        /// At the horizon.
        horizon: [f32; 3],
        /// Straight below.
        below: [f32; 3],
    },
    /// The same with a bright window towards the sun, for its reflections.
    Room {
        /// Overhead.
        above: [f32; 3],
        /// At the horizon.
        horizon: [f32; 3],
        /// Straight below.
        below: [f32; 3],
    },
    /// One colour, shown as it is: the ground of a drawing. Nothing is lit, colours are those of the table.
    Paper([f32; 3]),
}

impl Light {
    /// A clear afternoon.
    pub fn day() -> Self {
        let (sun, sunlight) = ([2.5, 0.75], [2.3, 2.15, 1.9]);
        let backdrop =
            Backdrop::Sky { above: [0.10, 0.25, 0.62], horizon: [0.66, 0.77, 0.90], below: [0.60, 0.63, 0.65] };
        Self { sun, sunlight, softness: 0.02, ambient: 0.75, backdrop, shadows: true }
    }

    /// A bright room.
    pub fn studio() -> Self {
        let backdrop = Backdrop::Studio { above: [0.92, 0.95, 1.0], horizon: [0.97; 3], below: [0.62, 0.63, 0.65] };
        let (sun, sunlight) = ([2.3, 0.95], [1.75, 1.72, 1.66]);
        Self { sun, sunlight, softness: 0.05, ambient: 0.8, backdrop, shadows: true }
    }

    /// A room with dark walls and a window, for transparent things.
    pub fn dim_room() -> Self {
        let backdrop =
            Backdrop::Room { above: [0.92, 0.97, 1.05], horizon: [0.53, 0.57, 0.62], below: [0.17, 0.185, 0.21] };
        Self { ambient: 1.0, sunlight: [1.9, 1.85, 1.75], backdrop, ..Self::studio() }
    }

    /// The same with the sun at another azimuth, radians.
    pub fn from_azimuth(self, azimuth: f64) -> Self {
        Self { sun: [azimuth as f32, self.sun[1]], ..self }
    }

    /// The same without shadows: much less to draw.
    pub fn without_shadows(self) -> Self {
        Self { shadows: false, ..self }
    }

    /// White paper.
    pub fn paper() -> Self {
        Self::paper_of([1.0; 3])
    }

    /// Paper of a colour, linear.
    pub fn paper_of(colour: [f32; 3]) -> Self {
        Self { backdrop: Backdrop::Paper(colour), ..Self::studio() }
    }

    /// The direction towards the sun.
    pub fn towards_sun(&self) -> Vec3 {
        let [azimuth, height] = self.sun;
        Vec3::new(azimuth.cos() * height.cos(), azimuth.sin() * height.cos(), height.sin())
    }

    /// The clear colour where the background is not drawn: of paper, or at the horizon.
    pub(crate) fn plain_backdrop(&self) -> [f32; 3] {
        match self.backdrop {
            Backdrop::Sky { horizon, .. } | Backdrop::Studio { horizon, .. } | Backdrop::Room { horizon, .. } => {
                horizon
            }
            Backdrop::Paper(colour) => colour,
        }
    }

    /// True where the sun's depth map is needed.
    pub fn throws_shadows(&self) -> bool {
        self.is_lit() && self.shadows
    }

    /// True where the backdrop is drawn, not one colour: without shadows only that of a room, which its floor shows too.
    pub(crate) fn draws_backdrop(&self) -> bool {
        self.throws_shadows() || matches!(self.backdrop, Backdrop::Room { .. })
    }

    /// True where things are lit, not drawn in flat colours.
    pub fn is_lit(&self) -> bool {
        !matches!(self.backdrop, Backdrop::Paper(_))
    }
}

//! What is known of a point beside a surface.

/// How far a point is from the surface of a solid, and the way out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// Distance to the nearest point of the surface, m; negative inside.
    pub distance: f64,
    /// Unit vector in which the distance grows fastest: out of the solid. Where several points of the surface are
    /// nearest it is that of one of them.
    pub normal: [f64; 3],
}

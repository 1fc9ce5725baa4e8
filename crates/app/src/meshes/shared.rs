//! Structures shared by the host and the shader of meshes, declared once.

use corpuscle::gpu::{DECLARED, Layout, SharedPiece, join};
use egui::epaint::Vertex;

corpuscle::gpu::declare! {
    constants {}
    structs {
        /// Size of the window.
        pub(super) struct WindowSize {
            /// Width and height, points.
            pub(super) size: [f32; 2],
            /// Fills up.
            pub(super) unused: [f32; 2],
        }
    }

    /// What the shader reads by its bindings.
    pub(super) piece Bound;
}

corpuscle::gpu::declare! {
    constants {}
    structs {
        /// A corner of a triangle.
        pub(super) struct MeshVertex {
            /// Position in the window, points.
            pub(super) position: [f32; 2],
            /// Position in its image, fractions of width and height.
            pub(super) uv: [f32; 2],
            /// Colour, its opacity multiplied in: bytes of red, green, blue and opacity.
            pub(super) colour: u32,
            /// Fills up.
            pub(super) unused: u32,
        }
    }

    /// What the vertex shader takes in from vertex buffers.
    pub(super) piece Vertices;
}

impl From<&Vertex> for MeshVertex {
    fn from(vertex: &Vertex) -> Self {
        let Vertex { pos, uv, color } = vertex;
        Self { position: [pos.x, pos.y], uv: [uv.x, uv.y], colour: u32::from_le_bytes(color.to_array()), unused: 0 }
    }
}

/// The shader, joined with the structures.
pub(super) fn shader() -> String {
    let vertices: String = Vertices::structs().iter().map(Layout::wgsl_of_vertex).collect();
    let declared = Bound::wgsl() + &vertices;
    join("meshes", include_str!("meshes.wgsl"), &[(DECLARED, declared.as_str())]).expect("a test joins it")
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle::gpu::{check_layouts_in, check_shader};

    #[test]
    fn the_shader_is_valid_and_lays_structures_out_as_the_host_does() {
        check_shader(&shader()).unwrap();
        check_layouts_in(&Bound::wgsl(), &Bound::structs()).unwrap();
        check_layouts_in(&Vertices::wgsl(), &Vertices::structs()).unwrap();
    }
}

//! Solids bounded by triangles.

mod catch_panic;
mod check;
mod crossing;
mod gltf;
mod obj;
mod ply;
mod read;
mod stl;

use crate::{Nearest, SolidError};
use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::{TriMesh, TriMeshFlags};
use std::path::Path;
use std::sync::Arc;

/// More triangles than this are refused: each takes half a kilobyte while it is checked (measured: 739 MB for 1.44 million).
pub const MOST_TRIANGLES: usize = 2_000_000;

/// Larger files are refused before they are read, bytes.
pub const MOST_BYTES: u64 = 1 << 29;

/// A closed surface of triangles, in m, all wound so that they turn left seen from outside.
#[derive(Debug, Clone)]
pub struct Mesh {
    triangles: Arc<TriMesh>,
    volume: f64,
    area: f64,
    notes: Vec<String>,
}

/// Triangles as read: corners, and three of them for each triangle.
#[derive(Debug, Clone, Default, PartialEq)]
struct Triangles {
    corners: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// Reads a mesh from a file in OBJ, STL, PLY, glTF or GLB, chosen by its extension, and checks it. `unit` is what 1
    /// means in the file, in m: needed but for glTF and GLB, which are in metres and have y up: they are turned so that
    /// z is up.
    ///
    /// # Errors
    /// [`SolidError::Unreadable`], or [`SolidError::Mesh`] where the file is none of these, larger than [`MOST_BYTES`] or
    /// [`MOST_TRIANGLES`], or as in [`Mesh::new`].
    pub fn read(path: &Path, unit: Option<f64>) -> Result<Self, SolidError> {
        read::read(path, unit)
    }

    /// A mesh of corners in m and triangles of three of them each. `name` is what messages call it. Corners at the same position
    /// are taken for one, triangles without area left out, and triangles wound against their neighbours turned; see
    /// [`Mesh::notes`].
    ///
    /// # Errors
    /// [`SolidError::Mesh`] where it is not the surface of a solid: a corner that is not finite or missing, open edges, edges
    /// of more than two triangles, triangles that cross, no volume.
    pub fn new(name: &Path, corners: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> Result<Self, SolidError> {
        Self::checked(Triangles { corners, triangles }).map_err(|what| SolidError::Mesh { path: name.to_owned(), what })
    }

    fn checked(triangles: Triangles) -> Result<Self, String> {
        let (Triangles { corners, triangles }, notes) = check::solid(triangles)?;
        let (volume, area) = check::volume_and_area(&corners, &triangles);
        let corners = corners.into_iter().map(Vector::from).collect();
        let flags = TriMeshFlags::ORIENTED;
        let triangles = TriMesh::with_flags(corners, triangles, flags).map_err(|error| error.to_string())?;
        crossing::refuse(&triangles)?;
        Ok(Self { triangles: Arc::new(triangles), volume, area, notes })
    }

    /// Distance and way out.
    pub fn nearest(&self, point: [f64; 3]) -> Nearest {
        let point = Vector::from(point);
        let (projection, _) = self.triangles.project_local_point_and_get_feature(point);
        let (away, sign) = (point - projection.point, if projection.is_inside { -1.0 } else { 1.0 });
        let length = away.length();
        let normal = if length > 0.0 { sign * away / length } else { self.normal_of(projection.subshape) };
        Nearest { distance: sign * length, normal: normal.into() }
    }

    /// The way out at a triangle itself.
    fn normal_of(&self, triangle: u32) -> Vector {
        self.triangles.triangle(triangle).normal().unwrap_or(Vector::X)
    }

    /// Its smallest and largest coordinates, m.
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        let bounds = self.triangles.local_aabb();
        [bounds.mins.into(), bounds.maxs.into()]
    }

    /// Its volume, m³.
    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// Its surface, m².
    pub fn area(&self) -> f64 {
        self.area
    }

    /// What was put right, in sentences.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }
}

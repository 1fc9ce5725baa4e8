//! Meshes to test with, in every format, and what brute force says of them.

use base64::Engine;
use std::collections::HashMap;
use std::f64::consts::PI;

/// Corners, and three of them for each triangle.
#[derive(Debug, Clone, Default)]
pub struct Soup {
    pub corners: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
}

/// A box with a corner at the origin.
pub fn cube([x, y, z]: [f64; 3]) -> Soup {
    let corner = |at: u32| [f64::from(at & 1) * x, f64::from(at >> 1 & 1) * y, f64::from(at >> 2) * z];
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    Soup { corners: (0..8).map(corner).collect(), triangles: triangles.collect() }
}

/// A ball of 20 triangles, each divided into four so many times.
pub fn ball(radius: f64, divided: u32) -> Soup {
    let golden = 0.5 * (1.0 + 5_f64.sqrt());
    let mut corners = Vec::new();
    for (a, b) in [(-1.0, golden), (1.0, golden), (-1.0, -golden), (1.0, -golden)] {
        corners.push([a, b, 0.0]);
    }
    for (a, b) in [(-1.0, golden), (1.0, golden), (-1.0, -golden), (1.0, -golden)] {
        corners.push([0.0, a, b]);
    }
    for (a, b) in [(-1.0, golden), (1.0, golden), (-1.0, -golden), (1.0, -golden)] {
        corners.push([b, 0.0, a]);
    }
    let mut triangles: Vec<[u32; 3]> = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..divided {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                let [p, q] = [a, b].map(|at| corners[at as usize]);
                corners.push(std::array::from_fn(|axis| 0.5 * (p[axis] + q[axis])));
                corners.len() as u32 - 1
            })
        };
        let parts = triangles.iter().flat_map(|&[a, b, c]| {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
        });
        triangles = parts.collect();
    }
    for corner in &mut corners {
        let length = corner.iter().map(|x: &f64| x * x).sum::<f64>().sqrt();
        *corner = corner.map(|x| radius * x / length);
    }
    Soup { corners, triangles }
}

/// A ring about z.
pub fn torus(large: f64, small: f64, around: u32, across: u32) -> Soup {
    let mut soup = Soup::default();
    for i in 0..around {
        for j in 0..across {
            let (u, v) = (2.0 * PI * f64::from(i) / f64::from(around), 2.0 * PI * f64::from(j) / f64::from(across));
            let from_axis = large + small * v.cos();
            soup.corners.push([from_axis * u.cos(), from_axis * u.sin(), small * v.sin()]);
            let at = |i: u32, j: u32| i % around * across + j % across;
            soup.triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            soup.triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    soup
}

impl Soup {
    pub fn add(&mut self, other: &Soup) {
        let first = self.corners.len() as u32;
        self.corners.extend(&other.corners);
        self.triangles.extend(other.triangles.iter().map(|triangle| triangle.map(|corner| first + corner)));
    }

    fn triangle_corners(&self) -> impl Iterator<Item = [[f64; 3]; 3]> + '_ {
        self.triangles.iter().map(|triangle| triangle.map(|corner| self.corners[corner as usize]))
    }

    /// Distance to the nearest triangle, all of them tried.
    pub fn distance(&self, point: [f64; 3]) -> f64 {
        self.triangle_corners().map(|triangle| to_triangle(point, triangle)).fold(f64::INFINITY, f64::min)
    }

    /// Solid angle of the surface over that of all directions: 1 inside, 0 outside (van Oosterom & Strackee, IEEE Transactions on
    /// Biomedical Engineering 30, 1983, 125).
    pub fn winding(&self, point: [f64; 3]) -> f64 {
        let angle = |triangle: [[f64; 3]; 3]| {
            let [a, b, c] = triangle.map(|corner| less(corner, point));
            let [la, lb, lc] = [a, b, c].map(|v| dot(v, v).sqrt());
            let below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
            2.0 * dot(a, cross(b, c)).atan2(below)
        };
        self.triangle_corners().map(angle).sum::<f64>() / (4.0 * PI)
    }

    /// The mesh as files of all formats.
    pub fn in_all_formats(&self) -> Vec<(&'static str, Vec<u8>)> {
        let (gltf, glb) = (self.gltf(), self.glb());
        vec![
            ("mesh.stl", self.ascii_stl()),
            ("binary.stl", self.binary_stl()),
            ("mesh.obj", self.obj()),
            ("mesh.ply", self.ascii_ply()),
            ("binary.ply", self.binary_ply()),
            ("mesh.gltf", gltf),
            ("mesh.glb", glb),
        ]
    }

    fn ascii_stl(&self) -> Vec<u8> {
        let mut text = String::from("solid\n");
        for triangle in self.triangle_corners() {
            text += "facet normal 0 0 0\nouter loop\n";
            triangle.iter().for_each(|[x, y, z]| text += &format!("vertex {x} {y} {z}\n"));
            text += "endloop\nendfacet\n";
        }
        (text + "endsolid\n").into()
    }

    /// With a head that begins like that of an ASCII file.
    fn binary_stl(&self) -> Vec<u8> {
        let mut bytes = b"solid ".to_vec();
        bytes.resize(80, b' ');
        bytes.extend((self.triangles.len() as u32).to_le_bytes());
        for triangle in self.triangle_corners() {
            bytes.extend([0; 12]);
            bytes.extend(triangle.as_flattened().iter().flat_map(|&x| (x as f32).to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    fn obj(&self) -> Vec<u8> {
        let mut text = String::from("mtllib none.mtl\no test\nusemtl none\n");
        self.corners.iter().for_each(|[x, y, z]| text += &format!("v {x} {y} {z}\n"));
        self.triangles.iter().for_each(|[a, b, c]| text += &format!("f {} {} {}\n", a + 1, b + 1, c + 1));
        text.into()
    }

    fn ply_head(&self, format: &str) -> String {
        let (corners, faces) = (self.corners.len(), self.triangles.len());
        format!(
            "ply\nformat {format} 1.0\nelement vertex {corners}\nproperty double x\nproperty double y\nproperty double z\n\
             element face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
        )
    }

    fn ascii_ply(&self) -> Vec<u8> {
        let mut text = self.ply_head("ascii");
        self.corners.iter().for_each(|[x, y, z]| text += &format!("{x} {y} {z}\n"));
        self.triangles.iter().for_each(|[a, b, c]| text += &format!("3 {a} {b} {c}\n"));
        text.into()
    }

    fn binary_ply(&self) -> Vec<u8> {
        let mut bytes = self.ply_head("binary_big_endian").into_bytes();
        bytes.extend(self.corners.as_flattened().iter().flat_map(|x| x.to_be_bytes()));
        for triangle in &self.triangles {
            bytes.push(3);
            bytes.extend(triangle.iter().flat_map(|corner| corner.to_be_bytes()));
        }
        bytes
    }

    fn data(&self) -> Vec<u8> {
        let positions = self.corners.as_flattened().iter().flat_map(|&x| (x as f32).to_le_bytes());
        positions.chain(self.triangles.as_flattened().iter().flat_map(|corner| corner.to_le_bytes())).collect()
    }

    fn json(&self, uri: &str) -> String {
        let (corners, indices) = (self.corners.len(), 3 * self.triangles.len());
        let (positions, all) = (12 * corners, 12 * corners + 4 * indices);
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],"buffers":[{{{uri}"byteLength":{all}}}],"bufferViews":[{{"buffer":0,"byteLength":{positions}}},{{"buffer":0,"byteOffset":{positions},"byteLength":{}}}],"accessors":[{{"bufferView":0,"componentType":5126,"count":{corners},"type":"VEC3","min":[-9,-9,-9],"max":[9,9,9]}},{{"bufferView":1,"componentType":5125,"count":{indices},"type":"SCALAR"}}]}}"#,
            4 * indices
        )
    }

    fn gltf(&self) -> Vec<u8> {
        let data = base64::engine::general_purpose::STANDARD.encode(self.data());
        self.json(&format!("\"uri\":\"data:application/octet-stream;base64,{data}\",")).into()
    }

    fn glb(&self) -> Vec<u8> {
        let (mut json, data) = (self.json("").into_bytes(), self.data());
        json.resize(json.len().next_multiple_of(4), b' ');
        let length = 12 + 8 + json.len() + 8 + data.len();
        let mut bytes = b"glTF".to_vec();
        bytes.extend(2_u32.to_le_bytes());
        bytes.extend((length as u32).to_le_bytes());
        for (kind, chunk) in [(b"JSON", &json), (b"BIN\0", &data)] {
            bytes.extend((chunk.len() as u32).to_le_bytes());
            bytes.extend(kind);
            bytes.extend(chunk);
        }
        bytes
    }
}

/// Distance to a triangle: to its plane where the foot is inside, else to its nearest edge.
fn to_triangle(point: [f64; 3], [a, b, c]: [[f64; 3]; 3]) -> f64 {
    let normal = cross(less(b, a), less(c, a));
    let is_left = |from: [f64; 3], to: [f64; 3]| dot(cross(less(to, from), less(point, from)), normal) >= 0.0;
    if is_left(a, b) && is_left(b, c) && is_left(c, a) {
        return (dot(less(point, a), normal) / dot(normal, normal).sqrt()).abs();
    }
    [[a, b], [b, c], [c, a]].into_iter().map(|edge| to_edge(point, edge)).fold(f64::INFINITY, f64::min)
}

fn to_edge(point: [f64; 3], [a, b]: [[f64; 3]; 2]) -> f64 {
    let (along, from) = (less(b, a), less(point, a));
    let part = (dot(from, along) / dot(along, along)).clamp(0.0, 1.0);
    let away: [f64; 3] = std::array::from_fn(|axis| from[axis] - part * along[axis]);
    dot(away, away).sqrt()
}

fn less(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

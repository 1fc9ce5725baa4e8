//! The pass over faces: eight at a time between cells, one at a time on borders.

use super::super::boundaries::{Now, through};
use super::super::domain::Domain;
use super::super::local::Local;
use super::super::mesh::{Face, Mesh, SOLID};
use super::super::reconstruction::{Faces, at_side, at_wall, differences};
use super::super::water::{DEPTH, LEVEL, Slopes, Water};
use super::{Crossings, Flux, between};
use corpuscle_model::{ROUNDERS, ReproducibleSum};
use corpuscle_simd::{LANES, Lanes, LanesExt, Select, Simd, SimdBase, SimdFloat, SimdFrom, transposed};

/// What fluxes are found from.
#[derive(Clone, Copy)]
pub(crate) struct Inputs<'a> {
    pub mesh: &'a Mesh,
    pub water: &'a [Water],
    pub slopes: &'a [Slopes],
    /// Faces on borders, in order.
    pub borders: &'a [u32],
    pub gravity: f64,
    /// What part of its outflow each cell has the water for; none where all have it in full.
    pub kept: Option<&'a [f32]>,
    /// Time step, s, times the number of faces that a cell has at most.
    pub outflow_time: f64,
    /// Where cells take steps of their own: `outflow_time` is for the shortest.
    pub local: Option<&'a Local>,
    /// The part of this process where several share the cells: momentum of the ground is counted by the process of a face's first cell.
    pub domain: Option<&'a Domain>,
}

impl Inputs<'_> {
    /// Whether some of the faces are beside a cell whose fluxes are needed now.
    #[inline(always)]
    fn are_needed(&self, faces: &[Face]) -> bool {
        let needed = |local: &Local, face: &Face| {
            let near = |cell: u32| local.near.get(cell as usize).is_some_and(|near| *near <= local.now);
            face.cells.into_iter().any(near)
        };
        self.local.is_none_or(|local| faces.iter().any(|face| needed(local, face)))
    }

    /// For how many of the shortest steps what faces do counts, in the first cells and in the second.
    #[inline(always)]
    fn weights(&self, local: &Local, faces: &[Face]) -> [[f64; LANES]; 2] {
        self.of_cells(faces, |cell| local.times(cell))
    }

    /// The steps of the first and the second cells times the number of faces that a cell has at most, s.
    #[inline(always)]
    fn outflow_times(&self, local: &Local, faces: &[Face]) -> [[f64; LANES]; 2] {
        let faces_a_cell = self.outflow_time / local.shortest;
        self.of_cells(faces, |cell| faces_a_cell * local.step(cell))
    }

    /// A value of the cells on both sides of faces between cells; 0 on borders.
    #[inline(always)]
    fn of_cells(&self, faces: &[Face], value: impl Fn(usize) -> f64) -> [[f64; LANES]; 2] {
        let mut lanes = [[0.0; LANES]; 2];
        for (k, face) in faces.iter().enumerate().filter(|(_, face)| face.border().is_none()) {
            (0..2).for_each(|side| lanes[side][k] = value(face.cells[side] as usize));
        }
        lanes
    }
}

/// What a chunk of faces did.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct OnFaces {
    /// Force of the ground on the water over density, m4/s2.
    pub by_ground: [ReproducibleSum<f64>; 2],
    /// Whether a face takes so much that its cell may not have the water for all its faces.
    pub may_drain: bool,
}

/// Fluxes through the faces from `first` on. Inlined into versions of itself for the vector instructions at hand.
#[inline(always)]
pub(crate) fn fluxes_of_chunk<S: Simd>(
    simd: S,
    inputs: &Inputs,
    boundaries: &impl Fn(usize) -> Now,
    first: usize,
    fluxes: &mut [Flux],
) -> OnFaces {
    let mut by_ground = [ReproducibleSum::of(Lanes::splat(simd, 0.0)); 2];
    let mut may_drain = false;
    let faces = &inputs.mesh.faces[first..first + fluxes.len()];
    for (block, (fluxes, faces)) in fluxes.chunks_mut(LANES).zip(faces.chunks(LANES)).enumerate() {
        let number = first + block * LANES;
        if !inputs.are_needed(faces) {
            continue;
        }
        may_drain |= block_between(simd, inputs, number, faces, fluxes, &mut by_ground);
        for (k, (flux, face)) in
            fluxes.iter_mut().zip(faces).enumerate().filter(|(_, (_, face))| face.border().is_some())
        {
            let border = || boundaries(inputs.borders.binary_search(&((number + k) as u32)).unwrap_or(0));
            may_drain |= border_flux(simd, inputs, face, border, flux);
        }
    }
    OnFaces { by_ground: by_ground.map(|sum| sum.map(LanesExt::sum)), may_drain }
}

/// Fluxes through the faces of a block that are between cells; nothing for those on borders. Whether one may take more than there is.
#[inline(always)]
fn block_between<S: Simd>(
    simd: S,
    inputs: &Inputs,
    first: usize,
    faces: &[Face],
    fluxes: &mut [Flux],
    by_ground: &mut [ReproducibleSum<Lanes<S>>; 2],
) -> bool {
    let mut block = Block::default();
    if !block.gather(inputs, first, faces) {
        fluxes.fill(Flux::default());
        return false;
    }
    let block_faces = faces;
    let (faces, limits, length) = block.turned(simd);
    let own = [[faces.water[0][DEPTH], faces.water[0][LEVEL]], [faces.water[1][DEPTH], faces.water[1][LEVEL]]];
    let found = between(simd, faces.at(simd), own, inputs.gravity);
    let half = 0.5 * inputs.gravity;
    let on_first = found.thrust[0] + own[0][0] * own[0][0] * half;
    let on_second = found.thrust[1] + own[1][0] * own[1][0] * half;
    let (pushed, times) = match inputs.local {
        None => (on_second - on_first, [Lanes::splat(simd, inputs.outflow_time); 2]),
        Some(local) => {
            let [first, second] = inputs.weights(local, block_faces);
            let [first, second] = [first, second].map(|lanes| Lanes::simd_from(simd, lanes));
            (
                on_second * second - on_first * first,
                inputs.outflow_times(local, block_faces).map(|lanes| Lanes::simd_from(simd, lanes)),
            )
        }
    };
    let pushed = pushed * length * limits.counts;
    let rounders = ROUNDERS.map(|rounder| Lanes::splat(simd, rounder));
    by_ground[0].add(pushed * faces.normal[0], &rounders);
    by_ground[1].add(pushed * faces.normal[1], &rounders);
    store(simd, &found, limits.kept, faces.normal, length, fluxes);
    let out = found.volume * length;
    (out * times[0] - limits.volume[0]).max(-(out * times[1]) - limits.volume[1]).largest() > 0.0
}

/// What eight faces can let out of the cells on both sides.
struct Limits<S: Simd> {
    /// The part of its outflow that each cell has the water for.
    kept: [Lanes<S>; 2],
    /// Water in each cell, m3.
    volume: [Lanes<S>; 2],
    /// 1 where the ground's thrust on the water on both sides is counted, 0 where another process counts it.
    counts: Lanes<S>,
}

/// Puts what eight faces do into their fluxes.
#[inline(always)]
fn store<S: Simd>(
    simd: S,
    found: &Crossings<S>,
    kept: [Lanes<S>; 2],
    [nx, ny]: [Lanes<S>; 2],
    length: Lanes<S>,
    fluxes: &mut [Flux],
) {
    let kept = found.volume.simd_gt(Lanes::splat(simd, 0.0)).select(kept[0], kept[1]) * length;
    let (across, along) = (found.carried[0] * kept, found.carried[1] * kept);
    let (x, y) = (across * nx - along * ny, across * ny + along * nx);
    let (on_first, on_second) = (found.thrust[0] * length, found.thrust[1] * length);
    let volume: [f64; LANES] = (found.volume * kept).into();
    let first: [[f64; LANES]; 2] = [(-(x + on_first * nx)).into(), (-(y + on_first * ny)).into()];
    let second: [[f64; LANES]; 2] = [(x + on_second * nx).into(), (y + on_second * ny).into()];
    for (k, flux) in fluxes.iter_mut().enumerate() {
        *flux = Flux { volume: volume[k], momentum: [[first[0][k], first[1][k]], [second[0][k], second[1][k]]] };
    }
}

/// What eight faces need: for each five rows, which are turned to columns of eight lanes.
#[derive(Default)]
struct Block {
    water: [[f64; LANES]; LANES],
    slopes: [[[f64; LANES]; LANES]; 2],
    /// Differences from both sides, normal, and the kept parts of both.
    differences: [[f64; LANES]; LANES],
    /// Vectors between the centroids and to the face, and volumes of both.
    vectors: [[f64; LANES]; LANES],
}

impl Block {
    /// Reads cells and faces into an empty block; whether any has water. The rows of faces on borders, and beyond the last, stay 0.
    #[inline(always)]
    fn gather(&mut self, inputs: &Inputs, first: usize, faces: &[Face]) -> bool {
        let Inputs { mesh, water, slopes, kept, .. } = *inputs;
        let mut any = false;
        for (k, face) in faces.iter().enumerate() {
            if face.border().is_some() {
                continue;
            }
            let [i, j] = [face.cells[0] as usize, face.cells[1] as usize];
            let (here, there) = (&water[i], &water[j]);
            if here.depth <= 0.0 && there.depth <= 0.0 {
                continue;
            }
            any = true;
            let lift = mesh.lift_of(first + k);
            let ([u, v], [p, q]) = (here.velocity, there.velocity);
            self.water[k] = [here.depth, here.level, u, v, there.depth, there.level + lift, p, q];
            for (row, slopes) in self.slopes.iter_mut().zip([&slopes[i], &slopes[j]]) {
                for (value, slope) in row[k].iter_mut().zip(slopes) {
                    *value = f64::from(*slope);
                }
            }
            let [depth, level] = differences(here, there, lift);
            let [depth_back, level_back] = differences(there, here, -lift);
            let [kept_here, kept_there] = if let Some(kept) = kept { [kept[i], kept[j]] } else { [1.0; 2] };
            let [x, y] = face.normal;
            let (kept_here, kept_there) = (f64::from(kept_here), f64::from(kept_there));
            self.differences[k] = [depth, level, depth_back, level_back, x, y, kept_here, kept_there];
            let ([bx, by], [ox, oy]) = (face.between, face.offset);
            let volume = [here.depth * mesh.area[i], there.depth * mesh.area[j]];
            let counts = if inputs.domain.is_none_or(|domain| domain.owns(i)) { 1.0 } else { 0.0 };
            self.vectors[k] =
                [f64::from(bx), f64::from(by), f64::from(ox), f64::from(oy), volume[0], volume[1], counts, 0.0];
        }
        any
    }

    /// The faces, what they can let out, and their lengths, m: 0 for empty rows.
    #[inline(always)]
    fn turned<S: Simd>(&self, simd: S) -> (Faces<S>, Limits<S>, Lanes<S>) {
        let [d0, l0, u0, v0, d1, l1, u1, v1] = turned(simd, &self.water);
        let [dx0, lx0, ux0, vx0, dy0, ly0, uy0, vy0] = turned(simd, &self.slopes[0]);
        let [dx1, lx1, ux1, vx1, dy1, ly1, uy1, vy1] = turned(simd, &self.slopes[1]);
        let [depth, level, depth_back, level_back, x, y, kept_here, kept_there] = turned(simd, &self.differences);
        let [bx, by, ox, oy, volume_here, volume_there, counts, _] = turned(simd, &self.vectors);
        let length = (x * x + y * y).sqrt();
        let inverse = Lanes::splat(simd, 1.0) / length.max(f64::MIN_POSITIVE);
        let faces = Faces {
            water: [[d0, l0, u0, v0], [d1, l1, u1, v1]],
            slopes: [[[dx0, lx0, ux0, vx0], [dy0, ly0, uy0, vy0]], [[dx1, lx1, ux1, vx1], [dy1, ly1, uy1, vy1]]],
            differences: [[depth, level], [depth_back, level_back]],
            normal: [x * inverse, y * inverse],
            between: [bx, by],
            offset: [ox, oy],
        };
        (faces, Limits { kept: [kept_here, kept_there], volume: [volume_here, volume_there], counts }, length)
    }
}

/// Rows turned to columns: the k-th result holds the k-th number of every row.
#[inline(always)]
fn turned<S: Simd>(simd: S, rows: &[[f64; LANES]; LANES]) -> [Lanes<S>; LANES] {
    let mut lanes = [Lanes::splat(simd, 0.0); LANES];
    for (lanes, row) in lanes.iter_mut().zip(rows) {
        *lanes = Lanes::simd_from(simd, *row);
    }
    transposed(lanes)
}

/// The flux out of a cell over a border; whether it may take more than there is.
#[inline(always)]
fn border_flux<S: Simd>(
    simd: S,
    inputs: &Inputs,
    face: &Face,
    boundary: impl FnOnce() -> Now,
    flux: &mut Flux,
) -> bool {
    let cell = face.cells[0] as usize;
    let here = &inputs.water[cell];
    let now = if face.border() == Some(SOLID) { Now::Wall } else { boundary() };
    if here.depth <= 0.0 && !matches!(now, Now::Beyond(..) | Now::Discharge(_)) {
        *flux = Flux::default();
        return false;
    }
    let length = (face.normal[0] * face.normal[0] + face.normal[1] * face.normal[1]).sqrt();
    let [nx, ny] = [face.normal[0] / length, face.normal[1] / length];
    let at = if matches!(now, Now::Wall) {
        at_wall(simd, here, &inputs.slopes[cell], face, [nx, ny])
    } else {
        at_side(here, [nx, ny])
    };
    let kept = inputs.kept.map_or(1.0, |kept| f64::from(kept[cell]));
    let found = through(now, at, [here.depth, here.level], inputs.gravity);
    *flux = found.through(length, [nx, ny], kept);
    let time =
        inputs.local.map_or(inputs.outflow_time, |local| inputs.outflow_time / local.shortest * local.step(cell));
    found.volume * length * time > here.depth * inputs.mesh.area[cell]
}

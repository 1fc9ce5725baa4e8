//! Distance from solids on nodes, for the search for air of low utility.

use crate::air::Scale;
use crate::origin::Origin;
use crate::room::Room;
use crate::settings::Settings;
use crate::shared::Parameters;
use crate::solids::Surface;
use crate::utility::CULL_MARGIN;
use rayon::prelude::*;

/// Nodes for each distance of particles: air that is missed or taken for too near is within some thousandths of it.
const FINER: f64 = 2.0;

/// Nodes beyond the room, which interpolation reads.
const BEYOND: f64 = 3.0;

/// Sets the grid of the distances, and returns them, m; none where there is no search for air of low utility.
pub(crate) fn distance_field(
    parameters: &mut Parameters,
    settings: &Settings,
    room: &Room,
    scale: &Scale,
    surfaces: &[Surface],
    origin: Origin,
) -> Vec<f32> {
    let Some(low) = settings.low_utility else { return Vec::new() };
    let (h, apart) = (scale.h(), scale.spacing / FINER);
    let corner = room.low.map(|low| low - BEYOND * apart);
    let nodes = room.size().map(|size| (size / apart + 2.0 * BEYOND).ceil() as usize + 1);
    parameters.field_corner = origin.relative(corner);
    parameters.per_node = (1.0 / apart) as f32;
    parameters.nodes = nodes.map(|count| count as u32);
    parameters.low_beyond = (low.distance * h) as f32;
    parameters.useless_beyond = ((low.distance + CULL_MARGIN) * h) as f32;
    parameters.low_after = low.after as f32;
    let distance = |number: usize| {
        let index = [number % nodes[0], number / nodes[0] % nodes[1], number / (nodes[0] * nodes[1])];
        let position = [0, 1, 2].map(|axis| corner[axis] + index[axis] as f64 * apart);
        // A number that arithmetic bears where there is no solid.
        surfaces.iter().map(|surface| surface(position)).fold(1e6, f64::min) as f32
    };
    (0..nodes.iter().product()).into_par_iter().with_min_len(1024).map(distance).collect()
}

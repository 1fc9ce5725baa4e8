//! Walls behind solids: layers between a solid and the air outside, through which heat goes in one dimension.
//!
//! Behind each particle of the solid that lies in the side of the box is a column of cells. They are nodes of the same network of conductances as the particles of
//! solids ([`Conduction`](super::Conduction)), so that all that goes through solids goes through walls, on CPU and GPU: heat flows between the middles of
//! neighbouring cells through their resistances in series (Patankar 1980, Numerical Heat Transfer and Fluid Flow, section 4.2-3).

use super::sources::{HeatSources, SurfacePart};
use super::{Material, Solids, bodies};
use crate::humid_air::ZERO_CELSIUS;
use crate::room::Room;
use serde::{Deserialize, Serialize};

/// A layer of a wall.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) enum WallLayer {
    /// Of a material, and its thickness, m.
    Solid(Material, f64),
    /// One that holds no heat, by its thermal resistance, m2 K/W.
    Gap(f64),
}

/// A cell of a column behind a particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct WallCell {
    /// Heat capacity, J/K.
    pub capacity: f64,
    /// Number of the wall.
    pub wall: u32,
    /// Number of the layer, counted from the solid.
    pub layer: u32,
    /// The outer surface, of the last cell of a column.
    pub outer: SurfacePart,
}

/// How a wall is divided into cells, for each area of it.
#[derive(Debug, Clone, Default, PartialEq)]
struct Division {
    cells: Vec<CellPerArea>,
    /// From the middle of the last cell to the outer surface, m2 K/W; without cells the resistance of the whole wall.
    last_resistance: f64,
}

/// A cell of a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
struct CellPerArea {
    layer: u32,
    /// J/(m2 K).
    capacity: f64,
    /// From the middle of the cell before, or the solid's surface, m2 K/W.
    resistance_before: f64,
}

/// A cell is at most so much wider than the one before.
const GROWTH: f64 = 1.25;

/// A cell is at most this part of its layer, where it need not be wider for the sake of the time step.
const WIDEST: f64 = 1.0 / 8.0;

/// A cell in which heat spreads farther than its own width in a step would shorten the step: it is at least so many times wider.
const OVER_SPREAD: f64 = 3.0;

/// Widths of the cells of a layer, finest at its faces, where its temperature changes first; m.
fn widths(thickness: f64, spacing: f64, thinnest: f64) -> Vec<f64> {
    let finest = spacing.min(WIDEST * thickness).max(thinnest);
    let widest = finest.max(WIDEST * thickness);
    let mut half = Vec::new();
    let (mut width, mut filled) = (finest, 0.0);
    while filled + 0.5 * width < 0.5 * thickness {
        half.push(width);
        filled += width;
        width = (GROWTH * width).min(widest);
    }
    if half.is_empty() {
        return vec![thickness];
    }
    let scale = 0.5 * thickness / filled;
    half.iter().chain(half.iter().rev()).map(|width| scale * width).collect()
}

impl Division {
    /// Into cells about as wide as the spacing, m, at the faces of layers; in a step heat spreads by its diffusivity, m2/s, for `step` s.
    fn new(layers: &[WallLayer], spacing: f64, step: f64) -> Self {
        let mut division = Self::default();
        for (number, layer) in layers.iter().enumerate() {
            match *layer {
                WallLayer::Gap(resistance) => division.last_resistance += resistance,
                WallLayer::Solid(material, thickness) => {
                    let capacity = material.conductor().capacity;
                    let thinnest = OVER_SPREAD * (material.conductivity / capacity * step).sqrt();
                    for width in widths(thickness, spacing, thinnest) {
                        let half = 0.5 * width / material.conductivity;
                        let resistance_before = division.last_resistance + half;
                        division.cells.push(CellPerArea {
                            layer: number as u32,
                            capacity: capacity * width,
                            resistance_before,
                        });
                        division.last_resistance = half;
                    }
                }
            }
        }
        division
    }

    /// m2 K/W.
    fn resistance(&self) -> f64 {
        self.cells.iter().map(|cell| cell.resistance_before).sum::<f64>() + self.last_resistance
    }
}

/// Resistance of a wall of gaps alone, which has no cells, m2 K/W.
pub(super) fn resistance_of_gaps(layers: &[WallLayer]) -> f64 {
    let of = |layer: &WallLayer| if let WallLayer::Gap(resistance) = layer { *resistance } else { 0.0 };
    layers.iter().map(of).sum()
}

/// Whether a wall has cells, that is anything but gaps.
pub(super) fn holds_heat(layers: &[WallLayer]) -> bool {
    layers.iter().any(|layer| matches!(layer, WallLayer::Solid(..)))
}

/// Puts walls behind the solids that have them, in a room with particles a `spacing` apart, m, and appends the temperatures of their cells. Heat flows through
/// them as if it had done so for long: from the solid at its initial temperature to the air outside. In a step of `step` s heat must not spread beyond a
/// cell. Returns the conductances, W/K, between cells and from particles to them.
pub(crate) fn add(
    bodies: &[bodies::Body],
    solids: &mut Solids,
    temperatures: &mut Vec<f64>,
    room: &Room,
    spacing: f64,
    step: f64,
) -> Vec<(u32, u32, f64)> {
    let mut links = Vec::new();
    for (number, body) in bodies.iter().enumerate() {
        let Some(outside) = body.sources.outside.as_ref().filter(|outside| holds_heat(&outside.layers)) else {
            continue;
        };
        let division = Division::new(&outside.layers, spacing, step);
        let conditions = outside.surroundings.at(0.0);
        let inner = body.temperature.at(0.0) + ZERO_CELSIUS;
        let wall = solids.walls.len() as u32;
        solids.walls.push(number as u32);
        for (particle, part) in HeatSources::parts_in_side(number, body, solids, room, spacing) {
            let [flux, _] = conditions.flux(inner, part.resistance + division.resistance());
            let (mut before, mut resistance, mut temperature) = (particle, part.resistance, inner);
            let last = division.cells.len() - 1;
            for (at, cell) in division.cells.iter().enumerate() {
                resistance += cell.resistance_before;
                temperature += flux * resistance;
                let node = solids.nodes() as u32;
                links.push((before, node, part.area / resistance));
                let outer = SurfacePart { area: part.area, resistance: division.last_resistance };
                let outer = if at == last { outer } else { SurfacePart::default() };
                let (capacity, layer) = (part.area * cell.capacity, cell.layer);
                solids.cells.push(WallCell { capacity, wall, layer, outer });
                temperatures.push(temperature);
                (before, resistance) = (node, 0.0);
            }
        }
    }
    links
}

impl Solids {
    /// Mean temperature, K, of each layer of the wall behind a body that holds heat, by the number of the layer; `temperatures` are those
    /// of all particles and cells, K.
    pub(crate) fn layer_temperatures(&self, body: usize, temperatures: &[f64]) -> Vec<(u32, f64)> {
        let Some(group) = self.wall_behind(body) else { return Vec::new() };
        let wall = (group - self.bodies.len()) as u32;
        let temperatures = &temperatures[self.particles.len()..];
        let mut sums: Vec<(u32, [f64; 2])> = Vec::new();
        for (cell, kelvin) in self.cells.iter().zip(temperatures).filter(|(cell, _)| cell.wall == wall) {
            let at = sums.iter().position(|(layer, _)| *layer == cell.layer).unwrap_or_else(|| {
                sums.push((cell.layer, [0.0; 2]));
                sums.len() - 1
            });
            let [heat, capacity] = sums[at].1;
            sums[at].1 = [heat + cell.capacity * kelvin, capacity + cell.capacity];
        }
        sums.into_iter().map(|(layer, [heat, capacity])| (layer, heat / capacity)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const STEEL: Material = Material { conductivity: 50.0, heat_capacity: 480.0, density: 7800.0 };

    proptest! {
        /// Cells fill the layer, are the same from both ends, and nowhere grow by more than the factor.
        #[test]
        fn cells_fill_a_layer_and_grow_from_its_faces(
            thickness in 1e-4..0.5_f64, spacing in 2e-4..5e-3_f64, thinnest in 0.0..2e-3_f64,
        ) {
            let widths = widths(thickness, spacing, thinnest);
            prop_assert!((widths.iter().sum::<f64>() / thickness - 1.0).abs() < 1e-12);
            let reversed: Vec<f64> = widths.iter().rev().copied().collect();
            prop_assert_eq!(&widths, &reversed);
            for pair in widths.windows(2) {
                prop_assert!(pair[1] < 1.2501 * pair[0] && pair[0] < 1.2501 * pair[1], "{widths:?}");
            }
            let narrowest = widths.iter().copied().fold(f64::INFINITY, f64::min);
            prop_assert!(narrowest > 0.49 * thinnest.min(thickness), "{widths:?}");
            prop_assert!(widths.len() < 80);
        }

        /// A wall resists and holds as much as its layers, however it is divided.
        #[test]
        fn a_wall_has_the_resistance_and_the_capacity_of_its_layers(
            thickness in 1e-4..0.2_f64, gap in 1e-3..1.0_f64, spacing in 2e-4..5e-3_f64, step in 1e-6..1e-2_f64,
        ) {
            let foam = Material { conductivity: 0.035, heat_capacity: 1400.0, density: 30.0 };
            let layers = [WallLayer::Gap(gap), WallLayer::Solid(STEEL, thickness), WallLayer::Solid(foam, 2.0 * thickness), WallLayer::Gap(gap)];
            let division = Division::new(&layers, spacing, step);
            let resistance = 2.0 * gap + thickness / 50.0 + 2.0 * thickness / 0.035;
            prop_assert!((division.resistance() / resistance - 1.0).abs() < 1e-12);
            let capacity: f64 = division.cells.iter().map(|cell| cell.capacity).sum();
            let expected = thickness * (480.0 * 7800.0 + 2.0 * 1400.0 * 30.0);
            prop_assert!((capacity / expected - 1.0).abs() < 1e-12);
            prop_assert!(holds_heat(&layers) && !holds_heat(&layers[..1]));
        }
    }

    #[test]
    fn a_wall_of_gaps_alone_only_resists() {
        let layers = [WallLayer::Gap(0.17), WallLayer::Gap(0.13)];
        assert_eq!(Division::new(&layers, 1e-3, 1e-3).resistance(), resistance_of_gaps(&layers));
        assert!((resistance_of_gaps(&layers) - 0.3).abs() < 1e-15);
    }
}

//! What lets water out by a rating, holds it at a level, or leads it from one point to another.

use super::hydraulics::{Culvert, Law};
use crate::error::setup;
use crate::extent::check_inside;
use crate::series::load;
use crate::zone::Zone;
use corpuscle_model::{GaugeColumn, ModelError};
use corpuscle_scene::{Flood, LinkLaw, Series, Table};
use corpuscle_terrain::Terrain;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// An outflow by a rating.
pub(crate) struct Outflow {
    pub name: String,
    pub zone: Zone,
    /// Discharge, m3/s, over the level, m.
    pub rating: Table,
}

/// Water held at a level.
pub(crate) struct Held {
    pub zone: Zone,
    /// Level over time, m.
    pub level: Table,
}

/// A way from one point to another.
pub(crate) struct Link {
    pub name: String,
    pub ends: [Zone; 2],
    pub both_ways: bool,
    pub law: Law,
}

/// What is odd about the links of a scene, in sentences: a culvert much shorter than the way it bridges would lose too little head.
pub(crate) fn warn_of_links(scene: &Flood, terrain: &Terrain) -> Vec<String> {
    let odd = |link: &corpuscle_scene::Link| {
        let LinkLaw::Culvert(culvert) = &link.law else { return None };
        let [from, to] = [link.from, link.to].map(|point| terrain.to_model(point));
        let distance = (to[0] - from[0]).hypot(to[1] - from[1]);
        let length = culvert.length_m.filter(|length| *length < LEAST_LENGTH * distance)?;
        Some(format!(
            "The culvert '{}' is {length} m long, and its ends lie {distance:.1} m apart: it loses less head than one that reaches from \
             end to end.",
            link.name
        ))
    };
    scene.link.iter().filter_map(odd).collect()
}

/// Length of a culvert over the distance of its ends below which it is warned of: ends may lie a little before its inlet and outlet.
const LEAST_LENGTH: f64 = 0.5;

/// All of them.
#[derive(Default)]
pub(crate) struct Structures {
    pub outflows: Vec<Outflow>,
    pub held: Vec<Held>,
    pub links: Vec<Link>,
}

/// Discharges now, m3/s.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct Flows {
    pub outflows: Vec<f64>,
    pub links: Vec<f64>,
}

impl Structures {
    pub fn open(scene: &Flood, terrain: &Terrain, folder: &Path, spacing: f64) -> Result<Self, ModelError> {
        let zone = |what: &str, line: &Option<Vec<[f64; 2]>>, polygon: &Option<Vec<[f64; 2]>>, at: Option<[f64; 2]>| {
            let positions = line.iter().chain(polygon).flatten().copied().chain(at).collect::<Vec<_>>();
            check_inside(what, &positions, terrain)?;
            let positions: Vec<_> = positions.into_iter().map(|position| terrain.to_model(position)).collect();
            Ok(match (line, polygon) {
                (Some(_), _) => Zone::along(positions, 0.0, 2.0 * spacing),
                (_, Some(_)) => Zone::Polygon(positions),
                _ => Zone::at(positions[0], 0.0, spacing),
            })
        };
        let outflow = |outflow: &corpuscle_scene::Outflow| {
            let what = format!("the outflow '{}'", outflow.name);
            let rating = load(&Series::Table(outflow.rating.clone()), folder)?;
            let zone = zone(&what, &outflow.line, &outflow.polygon, outflow.at)?;
            Ok(Outflow { name: outflow.name.clone(), zone, rating })
        };
        let held = |stage: &corpuscle_scene::Stage| {
            let zone = zone(&format!("the stage '{}'", stage.name), &stage.line, &stage.polygon, None)?;
            Ok(Held { zone, level: load(&stage.level_m, folder)? })
        };
        let link = |link: &corpuscle_scene::Link| {
            check_inside(&format!("the link '{}'", link.name), &[link.from, link.to], terrain)?;
            let positions = [link.from, link.to].map(|position| terrain.to_model(position));
            let [from, to] = positions;
            let distance = (to[0] - from[0]).hypot(to[1] - from[1]);
            let law = match &link.law {
                LinkLaw::Culvert(culvert) => {
                    let ground = positions.map(|[x, y]| terrain.height(x, y));
                    Law::Culvert(Culvert::new(culvert, distance, ground))
                }
                LinkLaw::Weir(weir) => Law::Weir(weir.clone()),
                LinkLaw::Rating(rows) => Law::Rating(load(&Series::Table(rows.clone()), folder)?),
            };
            let ends = positions.map(|position| Zone::at(position, 0.0, spacing));
            if distance < ends.iter().map(Zone::reach).sum() {
                return Err(setup(format!(
                    "the ends of the link '{}' are {distance:.3} m apart and take their water from {:.3} m round them: move \
                     them apart, or take a smaller flood.spacing_m",
                    link.name,
                    ends[0].reach()
                )));
            }
            Ok(Link { name: link.name.clone(), ends, both_ways: link.both_ways, law })
        };
        Ok(Self {
            outflows: scene.outflow.iter().map(outflow).collect::<Result<_, ModelError>>()?,
            held: scene.stage.iter().map(held).collect::<Result<_, ModelError>>()?,
            links: scene.link.iter().map(link).collect::<Result<_, ModelError>>()?,
        })
    }

    /// Nothing flows.
    pub fn at_rest(&self) -> Flows {
        Flows { outflows: vec![0.0; self.outflows.len()], links: vec![0.0; self.links.len()] }
    }

    /// Whether flows are those of these structures.
    pub fn fit(&self, flows: &Flows) -> bool {
        flows.outflows.len() == self.outflows.len() && flows.links.len() == self.links.len()
    }

    /// Number of them.
    #[cfg(feature = "gpu")]
    pub fn count(&self) -> usize {
        self.outflows.len() + self.held.len() + self.links.len()
    }

    /// Whether there are none.
    #[cfg(feature = "gpu")]
    pub fn is_empty(&self) -> bool {
        self.count() == 0
    }

    /// A column of the discharge of each outflow and link.
    pub fn columns(&self) -> impl Iterator<Item = GaugeColumn> + '_ {
        let names = self.outflows.iter().map(|outflow| &outflow.name).chain(self.links.iter().map(|link| &link.name));
        names.map(|name| GaugeColumn { gauge: name.clone(), quantity: "discharge", unit: "m3_per_s" })
    }
}

impl Flows {
    /// The values of the columns.
    pub fn row(&self) -> impl Iterator<Item = f64> + '_ {
        self.outflows.iter().chain(&self.links).copied()
    }
}

impl Link {
    /// Discharge, m3/s, positive from the first end to the second, where the water stands at these levels, m, or is away.
    pub fn discharge(&self, [from, to]: [Option<f64>; 2], gravity: f64) -> f64 {
        let dry = f64::NEG_INFINITY;
        if from.unwrap_or(dry) >= to.unwrap_or(dry) {
            from.map_or(0.0, |level| self.law.discharge(level, to, [0, 1], gravity))
        } else if self.both_ways {
            to.map_or(0.0, |level| -self.law.discharge(level, from, [1, 0], gravity))
        } else {
            0.0
        }
    }
}

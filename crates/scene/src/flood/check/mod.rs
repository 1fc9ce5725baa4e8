//! Checks of `[flood]`.

mod ground;

use crate::check::{Check, Checked};
use crate::{
    Adaptive, Block, Edge, Field, Finer, Flood, Gauge, Inflow, LARGEST_MANNING, Manning, Obstacle, Problem, Scheme,
    Series, SphSwe, StartVelocity, Water,
};
use std::collections::HashMap;

/// Why scheme sph-swe is refused what it does not have.
const OF_VORONOI: &str = "is for scheme = \"voronoi\", the default; scheme sph-swe is the published one, without it";

/// Cells may be so many times finer than elsewhere.
const FINEST: f64 = 64.0;

impl Check {
    pub(crate) fn flood(&self, flood: &Flood) -> Checked {
        if let Some(spacing) = flood.spacing_m {
            self.above("flood.spacing_m", spacing, 0.0)?;
        }
        if let Some(depth) = flood.spacing_depth_m {
            self.above("flood.spacing_depth_m", depth, 0.0)?;
        }
        self.above("flood.gravity_m_per_s2", flood.gravity_m_per_s2, 0.0)?;
        self.manning(&flood.manning)?;
        self.ground(flood)?;
        self.of_voronoi(flood)?;
        self.above("flood.wet_depth_m", flood.wet_depth_m, 0.0)?;
        if let Some(period) = flood.map_every_s {
            self.above("flood.map_every_s", period, 0.0)?;
        }
        self.sph_swe(&flood.sph_swe)?;
        self.edges(flood)?;
        for (index, water) in flood.water.iter().enumerate() {
            self.water(&format!("flood.water.{index}"), water)?;
        }
        for (index, inflow) in flood.inflow.iter().enumerate() {
            self.inflow(&format!("flood.inflow.{index}"), inflow)?;
        }
        for (index, finer) in flood.finer.iter().enumerate() {
            self.finer(&format!("flood.finer.{index}"), finer, flood)?;
        }
        if let Some(adaptive) = &flood.adaptive {
            self.adaptive(adaptive, flood)?;
        }
        for (index, outflow) in flood.outflow.iter().enumerate() {
            self.outflow(&format!("flood.outflow.{index}"), outflow)?;
        }
        for (index, stage) in flood.stage.iter().enumerate() {
            self.stage(&format!("flood.stage.{index}"), stage)?;
        }
        for (index, link) in flood.link.iter().enumerate() {
            self.link(&format!("flood.link.{index}"), link)?;
        }
        for (index, obstacle) in flood.obstacle.iter().enumerate() {
            self.obstacle(&format!("flood.obstacle.{index}"), obstacle)?;
        }
        for (index, gauge) in flood.gauge.iter().enumerate() {
            self.gauge(&format!("flood.gauge.{index}"), gauge)?;
        }
        for (index, section) in flood.section.iter().enumerate() {
            self.line(&format!("flood.section.{index}.line"), &section.line)?;
        }
        self.names(flood)
    }

    fn of_voronoi(&self, flood: &Flood) -> Checked {
        let key = flood.only_of_voronoi().filter(|_| flood.scheme != Scheme::Voronoi);
        key.map_or(Ok(()), |key| self.require(&format!("flood.{key}"), false, || OF_VORONOI.into()))
    }

    fn finer(&self, key: &str, finer: &Finer, flood: &Flood) -> Checked {
        self.exactly_one(
            key,
            &[
                ("polygon", finer.polygon.is_some()),
                ("circle", finer.circle.is_some()),
                ("file", finer.file.is_some()),
                ("line", finer.line.is_some()),
                ("walls", finer.walls),
            ],
        )?;
        if let Some(polygon) = &finer.polygon {
            self.polygon(&format!("{key}.polygon"), polygon)?;
        }
        if let Some(circle) = finer.circle {
            self.above(&format!("{key}.circle.radius_m"), circle.radius_m, 0.0)?;
        }
        if let Some(line) = &finer.line {
            self.line(&format!("{key}.line"), line)?;
        }
        self.at_least(&format!("{key}.within_m"), finer.within_m, 0.0)?;
        self.require(
            &format!("{key}.within_m"),
            finer.within_m > 0.0 || (finer.line.is_none() && !finer.walls),
            || "must be larger than 0: how far from the line, or from obstacles, cells are finer".into(),
        )?;
        self.require(&format!("{key}.walls"), !finer.walls || !flood.obstacle.is_empty(), || {
            "there is no [[flood.obstacle]] to be finer at".into()
        })?;
        self.finer_spacing(&format!("{key}.spacing_m"), finer.spacing_m, flood)
    }

    fn adaptive(&self, adaptive: &Adaptive, flood: &Flood) -> Checked {
        self.above("flood.adaptive.rise_over_depth", adaptive.rise_over_depth, 0.0)?;
        self.require("flood.adaptive.every_steps", adaptive.every_steps >= 1, || "must be at least 1".into())?;
        self.finer_spacing("flood.adaptive.finest_m", adaptive.finest_m, flood)
    }

    /// A spacing that is smaller than elsewhere.
    fn finer_spacing(&self, key: &str, spacing: f64, flood: &Flood) -> Checked {
        self.above(key, spacing, 0.0)?;
        let Some(coarse) = flood.spacing_m else { return Ok(()) };
        self.require(key, spacing < coarse && spacing >= coarse / FINEST, || {
            format!("must be smaller than flood.spacing_m = {coarse}, and not more than {FINEST} times")
        })
    }

    fn manning(&self, manning: &Manning) -> Checked {
        let Manning::Number(n) = *manning else { return Ok(()) };
        self.roughness("flood.manning", n)
    }

    fn roughness(&self, key: &str, n: f64) -> Checked {
        self.at_least(key, n, 0.0)?;
        self.require(key, n <= LARGEST_MANNING, || {
            format!("must be Manning's n, 0.01 to 0.2 for most ground; for Strickler's k give 1/k = {:.4}", 1.0 / n)
        })
    }

    fn sph_swe(&self, sph_swe: &SphSwe) -> Checked {
        self.above("flood.sph_swe.time_step_s", sph_swe.time_step_s, 0.0)?;
        if let Some(length) = sph_swe.smoothing_length_m {
            self.above("flood.sph_swe.smoothing_length_m", length, 0.0)?;
        }
        self.above("flood.sph_swe.density_kg_per_m3", sph_swe.density_kg_per_m3, 0.0)?;
        self.at_least("flood.sph_swe.gas_constant", sph_swe.gas_constant, 0.0)?;
        self.at_least("flood.sph_swe.viscosity", sph_swe.viscosity, 0.0)?;
        if let Some(radius) = sph_swe.radius_m {
            self.above("flood.sph_swe.radius_m", radius, 0.0)?;
        }
        self.at_least("flood.sph_swe.control_strength", sph_swe.control_strength, 0.0)?;
        self.above("flood.sph_swe.control_square", sph_swe.control_square, 0.0)?;
        self.at_least("flood.sph_swe.largest_smoothing", sph_swe.largest_smoothing, 1.0)
    }

    fn edges(&self, flood: &Flood) -> Checked {
        let edges = &flood.edges;
        for (side, edge) in
            [("west", &edges.west), ("east", &edges.east), ("south", &edges.south), ("north", &edges.north)]
        {
            self.edge(&format!("flood.edges.{side}"), edge)?;
        }
        for (index, part) in flood.edge_part.iter().enumerate() {
            let key = format!("flood.edge_part.{index}");
            self.require(&format!("{key}.to"), part.from.is_finite() && part.to > part.from, || {
                format!("must be larger than from = {}", part.from)
            })?;
            self.require(&format!("{key}.edge"), part.edge != Edge::Periodic, || {
                "whole sides are periodic, not parts of them: see [flood.edges]".into()
            })?;
            self.edge(&format!("{key}.edge"), &part.edge)?;
        }
        for (index, line) in flood.edge_line.iter().enumerate() {
            let key = format!("flood.edge_line.{index}");
            self.line(&format!("{key}.line"), &line.line)?;
            self.require(&format!("{key}.edge"), line.edge != Edge::Periodic, || {
                "a line is joined to nothing: periodic sides are in [flood.edges]".into()
            })?;
            self.edge(&format!("{key}.edge"), &line.edge)?;
        }
        self.periodic(("west", &edges.west), ("east", &edges.east))?;
        self.periodic(("south", &edges.south), ("north", &edges.north))
    }

    /// What happens at a side or a part of one.
    fn edge(&self, key: &str, edge: &Edge) -> Checked {
        match edge {
            Edge::Open | Edge::Wall | Edge::Periodic => Ok(()),
            Edge::Stage(level) => self.series(&format!("{key}.stage"), level),
            Edge::Discharge(discharge) => self.series(&format!("{key}.discharge"), discharge),
            Edge::NormalDepth(slope) => self.above(&format!("{key}.normal_depth"), *slope, 0.0),
            Edge::Paddle(motion) => self.paddle(&format!("{key}.paddle"), motion),
            Edge::Rating(rows) => self.rating(&format!("{key}.rating"), "level, discharge", rows),
            Edge::Wave(wave) => {
                let key = format!("{key}.wave");
                self.at_least(&format!("{key}.rest_level_m"), wave.rest_level_m, f64::MIN)?;
                self.require(&key, wave.level_m.is_some() || wave.velocity_m_per_s.is_some(), || {
                    "must give level_m, velocity_m_per_s, or both".into()
                })?;
                for (name, series) in [("level_m", &wave.level_m), ("velocity_m_per_s", &wave.velocity_m_per_s)] {
                    if let Some(series) = series {
                        self.series(&format!("{key}.{name}"), series)?;
                    }
                }
                Ok(())
            }
        }
    }

    fn paddle(&self, key: &str, motion: &Series) -> Checked {
        self.series(key, motion)?;
        let Series::Table(rows) = motion else { return Ok(()) };
        self.require(&format!("{key}.0"), rows[0][1] == 0.0, || {
            "must begin with a displacement of 0: the wall stands at the side of the terrain".into()
        })?;
        let jump = rows.windows(2).position(|pair| pair[0][0] == pair[1][0] && pair[0][1] != pair[1][1]);
        jump.map_or(Ok(()), |row| {
            Err(self
                .problem(&format!("{key}.{}", row + 1), "a wall cannot jump: give it a later time than the row before"))
        })
    }

    /// What leaves at one side comes in at the other, so both are periodic or neither.
    fn periodic(&self, one: (&str, &Edge), other: (&str, &Edge)) -> Checked {
        for ((side, edge), (opposite, opposite_edge)) in [(one, other), (other, one)] {
            let alone = *edge == Edge::Periodic && *opposite_edge != Edge::Periodic;
            self.require(&format!("flood.edges.{side}"), !alone, || {
                format!("the opposite side must be periodic too: give {opposite} = \"periodic\"")
            })?;
        }
        Ok(())
    }

    fn water(&self, key: &str, water: &Water) -> Checked {
        self.exactly_one(
            key,
            &[
                ("level_m", water.level_m.is_some()),
                ("depth_m", water.depth_m.is_some()),
                ("depth_raster", water.depth_raster.is_some()),
                ("block", water.block.is_some()),
            ],
        )?;
        if let Some(depth) = water.depth_m.as_ref().and_then(Field::number) {
            self.above(&format!("{key}.depth_m"), depth, 0.0)?;
        }
        if let Some(polygon) = &water.polygon {
            self.polygon(&format!("{key}.polygon"), polygon)?;
        }
        let Some(block) = &water.block else { return Ok(()) };
        self.require(&format!("{key}.polygon"), water.polygon.is_none(), || {
            "a block has its own corners; leave the polygon out".into()
        })?;
        let is_raster = matches!(water.velocity_m_per_s, StartVelocity::Rasters(_));
        self.require(&format!("{key}.velocity_m_per_s"), !is_raster, || {
            "the velocity of a block is two numbers or expressions, not rasters".into()
        })?;
        self.block(&format!("{key}.block"), block)
    }

    fn block(&self, key: &str, block: &Block) -> Checked {
        let ordered = block.from[0] < block.to[0] && block.from[1] < block.to[1];
        self.require(&format!("{key}.to"), ordered, || {
            format!("must be larger than from = {:?} in both x and y", block.from)
        })?;
        self.at_least(&format!("{key}.height_m"), block.height_m, 0.0)?;
        self.at_least(&format!("{key}.layers"), block.layers as f64, 1.0)
    }

    fn inflow(&self, key: &str, inflow: &Inflow) -> Checked {
        self.exactly_one(key, &[("at", inflow.at.is_some()), ("line", inflow.line.is_some())])?;
        if let Some(line) = &inflow.line {
            self.line(&format!("{key}.line"), line)?;
        }
        let key = format!("{key}.discharge_m3_per_s");
        self.series(&key, &inflow.discharge_m3_per_s)?;
        let smallest = match &inflow.discharge_m3_per_s {
            Series::Constant(value) => *value,
            Series::Table(rows) => rows.iter().map(|row| row[1]).fold(f64::INFINITY, f64::min),
            Series::File { .. } => 0.0,
        };
        self.require(&key, smallest >= 0.0, || {
            format!("a discharge must not be negative ({smallest} here): water leaves over open edges")
        })
    }

    fn gauge(&self, key: &str, gauge: &Gauge) -> Checked {
        self.exactly_one(key, &[("at", gauge.at.is_some()), ("lon_lat", gauge.lon_lat.is_some())])?;
        let Some([longitude, latitude]) = gauge.lon_lat else { return Ok(()) };
        let on_earth = (-180.0..=360.0).contains(&longitude) && (-90.0..=90.0).contains(&latitude);
        self.require(&format!("{key}.lon_lat"), on_earth, || {
            "must be longitude, -180 to 180, then latitude, -90 to 90, in degrees".into()
        })
    }

    fn line(&self, key: &str, line: &[[f64; 2]]) -> Checked {
        self.require(key, line.len() >= 2, || "a line needs at least two points".into())?;
        let double = line.windows(2).position(|pair| pair[0] == pair[1]);
        self.require(key, double.is_none(), || {
            format!(
                "points {0} and {1} of the line (from 0) are the same",
                double.unwrap_or(0),
                double.unwrap_or(0) + 1
            )
        })
    }

    fn obstacle(&self, key: &str, obstacle: &Obstacle) -> Checked {
        self.exactly_one(
            key,
            &[
                ("polygon", obstacle.polygon.is_some()),
                ("circle", obstacle.circle.is_some()),
                ("line", obstacle.line.is_some()),
                ("file", obstacle.file.is_some()),
            ],
        )?;
        if let Some(polygon) = &obstacle.polygon {
            self.polygon(&format!("{key}.polygon"), polygon)?;
        }
        if let Some(circle) = obstacle.circle {
            self.above(&format!("{key}.circle.radius_m"), circle.radius_m, 0.0)?;
        }
        if let Some(line) = &obstacle.line {
            self.line(&format!("{key}.line"), line)?;
        }
        self.require(&format!("{key}.crest_m"), obstacle.crest_m.is_none() || obstacle.line.is_some(), || {
            "only a line has a crest; give height_m".into()
        })?;
        self.require(&format!("{key}.crest_m"), obstacle.crest_m.is_none() || obstacle.height_m.is_none(), || {
            "give crest_m or height_m, not both".into()
        })?;
        obstacle.height_m.map_or(Ok(()), |height| self.above(&format!("{key}.height_m"), height, 0.0))
    }

    fn polygon(&self, key: &str, corners: &[[f64; 2]]) -> Checked {
        self.require(key, corners.len() >= 3, || {
            format!("a polygon needs at least three corners, not {}", corners.len())
        })?;
        let [x0, y0] = corners[0];
        let next = corners.iter().cycle().skip(1);
        let twice_area: f64 =
            corners.iter().zip(next).map(|(a, b)| (a[0] - x0) * (b[1] - y0) - (b[0] - x0) * (a[1] - y0)).sum();
        self.require(key, twice_area != 0.0, || "a polygon must have an area: its corners are on one line, or its sides cross and enclose as much to the left as to the right".into())
    }

    /// Names are fit for headers of tables and unique.
    fn names(&self, flood: &Flood) -> Checked {
        let gauges = flood.gauge.iter().map(|gauge| &gauge.name);
        let sections = flood.section.iter().map(|section| &section.name);
        let inflows = flood.inflow.iter().map(|inflow| &inflow.name);
        let outflows = flood.outflow.iter().map(|outflow| &outflow.name);
        let stages = flood.stage.iter().map(|stage| &stage.name);
        let links = flood.link.iter().map(|link| &link.name);
        let obstacles = flood.obstacle.iter().map(|obstacle| &obstacle.name);
        let mut seen = HashMap::new();
        let all = (gauges.enumerate().map(|named| ("gauge", named)))
            .chain(sections.enumerate().map(|named| ("section", named)))
            .chain(inflows.enumerate().map(|named| ("inflow", named)))
            .chain(outflows.enumerate().map(|named| ("outflow", named)))
            .chain(stages.enumerate().map(|named| ("stage", named)))
            .chain(links.enumerate().map(|named| ("link", named)))
            .chain(obstacles.enumerate().map(|named| ("obstacle", named)));
        for (kind, (index, name)) in all {
            let key = format!("flood.{kind}.{index}.name");
            self.name(&key, name)?;
            if let Some(other) = seen.insert(name, key.clone()) {
                return Err(Problem::new(key, format!(" = {name:?}: this name is taken by {other}; give another")));
            }
        }
        Ok(())
    }
}

//! The columns of the gauge table.

use super::Dew;
use crate::fogging::Cover;
use crate::humid_air::is_frost;
use crate::measures::Totals;
use corpuscle_model::{CompensatedSum, GaugeColumn};

/// Times measured at a surface.
const COVER: [&str; 3] = ["fogged_at", "clear_at", "time_to_clear"];

/// They, s; not numbers where they are not known yet.
fn times(cover: &Cover) -> [f64; 3] {
    [cover.fogged, cover.clear, cover.time_to_clear()].map(|time| time.unwrap_or(f64::NAN))
}

impl Dew {
    pub(crate) fn measured_columns(&self) -> Vec<GaugeColumn> {
        let column = |gauge: &str, quantity, unit| GaugeColumn { gauge: gauge.into(), quantity, unit };
        let mut columns = vec![
            column("water", "vapour", "kg"),
            column("water", "fog", "kg"),
            column("water", "on_solids", "kg"),
            column("air", "particles", ""),
            column("air", "mean_temperature", "K"),
            column("air", "largest_speed", "m_per_s"),
            column("solids", "covered_area", "m2"),
            column("solids", "heat_from_held", "J"),
        ];
        if self.wetting.is_some() {
            columns.extend([
                column("drops", "number", ""),
                column("drops", "largest_radius", "m"),
                column("drops", "mean_radius", "m"),
                column("drops", "first_at", "s"),
                column("drops", "merged", ""),
                column("drops", "left", "kg"),
            ]);
        }
        for (body, name) in self.names.iter().enumerate() {
            columns.extend([
                column(name, "water", "kg"),
                column(name, "mean_temperature", "K"),
                column(name, "heat_given", "J"),
                column(name, "heat_flow", "W"),
            ]);
            let named = self.sources_of(body).map(|(quantity, _)| column(name, quantity, "J"));
            columns.extend(named);
            let of_layer = |(layer, _)| column(&format!("{name}.outside.{layer}"), "mean_temperature", "K");
            columns.extend(self.solids.layer_temperatures(body, &self.state.temperatures).into_iter().map(of_layer));
            if self.wetting.is_some() {
                columns.extend([
                    column(name, "water_per_area", "kg_per_m2"),
                    column(name, "covered_part", ""),
                    column(name, "drops", ""),
                    column(name, "drop_radius", "m"),
                    column(name, "polydispersity", ""),
                    column(name, "first_drop_at", "s"),
                ]);
                columns.extend(COVER.map(|quantity| column(name, quantity, "s")));
            }
            for (face, _) in self.wetting.iter().flat_map(|wetting| wetting.faces_of(body)) {
                let name = format!("{name}.{}", face.name);
                columns.extend([
                    column(&name, "mean_temperature", "K"),
                    column(&name, "water_per_area", "kg_per_m2"),
                    column(&name, "covered_part", ""),
                ]);
                columns.extend(COVER.map(|quantity| column(&name, quantity, "s")));
            }
            if self.layers[body].is_some() {
                columns.extend([
                    column(name, "nearest_air", "m"),
                    column(name, "gap", "m"),
                    column(name, "wall_pairs", ""),
                ]);
            }
        }
        columns
    }

    /// The air as it stands here.
    pub(crate) fn totals(&self) -> Totals {
        Totals::of(self.inside(), self.inside_count(), &self.processes)
    }

    /// The values of the columns, from totals of the air.
    pub(crate) fn measured(&self, air: &Totals) -> Vec<f64> {
        let mass = self.particle_mass();
        let particles = self.solids().particles.iter().zip(&self.state.water_on);
        let wet = || particles.filter(|(_, water)| **water > 0.0).map(|(particle, _)| particle.area).sum();
        let stories = self.wetting.as_ref().map(|wetting| wetting.stories());
        let mut row = vec![
            mass * air.vapour,
            mass * air.fog,
            self.water_on_all(),
            air.count,
            air.temperature / air.count,
            air.fastest,
            stories.map_or_else(wet, |stories| stories.iter().map(|story| story.covered).sum()),
            self.state.held_heat.iter().map(CompensatedSum::value).sum(),
        ];
        row.extend(self.measured_drops());
        (0..self.names.len()).for_each(|body| row.extend(self.measured_of(body)));
        row
    }

    fn measured_drops(&self) -> Vec<f64> {
        let Some(wetting) = &self.wetting else { return Vec::new() };
        let drops = wetting.drops();
        let radii = drops.drops().iter().map(|drop| drop.radius);
        let number = drops.drops().len() as f64;
        let firsts = wetting.stories().iter().filter_map(|story| story.first);
        let first = firsts.min_by(f64::total_cmp).unwrap_or(f64::NAN);
        vec![
            number,
            radii.clone().fold(0.0, f64::max),
            radii.sum::<f64>() / number,
            first,
            drops.merged() as f64,
            drops.dripped(),
        ]
    }

    fn measured_of(&self, body: usize) -> Vec<f64> {
        let [water, temperature] = self.totals_of(body);
        let mut row = vec![water, temperature, self.heat_from(body), self.state.heat_flow[body]];
        row.extend(self.sources_of(body).map(|(_, joules)| joules));
        row.extend(
            self.solids.layer_temperatures(body, &self.state.temperatures).into_iter().map(|(_, kelvin)| kelvin),
        );
        if let Some(wetting) = &self.wetting {
            let (story, area) = (wetting.stories()[body], wetting.open_area(body));
            let or_none = |value: f64| if story.drops > 0 { value } else { f64::NAN };
            row.extend([water / area, story.covered / area, story.drops as f64]);
            row.extend([or_none(story.mean_radius), or_none(story.polydispersity)]);
            row.push(story.first.unwrap_or(f64::NAN));
            row.extend(times(&story.cover));
            for (face, cover) in wetting.faces_of(body) {
                let [water, temperature] = wetting.water_and_temperature(face, &self.state.temperatures);
                row.extend([temperature, water, cover.part]);
                row.extend(times(cover));
            }
        }
        if let Some(layer) = &self.layers[body] {
            let air = self.inside().map(|particle| particle.position);
            let found = layer.find(air, [&self.contact, &self.ghosts], |position| self.owns(position), &self.processes);
            row.extend([found.nearest, found.gap, found.pairs]);
        }
        row
    }

    /// Names of the heats that a body gets from sources that it has, and how much it has got, J.
    fn sources_of(&self, body: usize) -> impl Iterator<Item = (&'static str, f64)> {
        let sources = self.sources.bodies.get(body);
        let has_wall = self.solids.wall_behind(body).is_some();
        let has = sources
            .map_or([false; 3], |of| [of.heater.is_some(), has_wall || of.outside.is_some(), of.radiation.is_some()]);
        let all =
            ["heat_from_heater", "heat_from_outside", "heat_by_radiation"].into_iter().zip(self.heat_supplied(body));
        all.zip(has).filter_map(|(heat, has)| has.then_some(heat))
    }

    /// Says on which solids water would be ice now.
    pub(crate) fn frost(&self) -> Vec<String> {
        let is_wet = |body: usize| match &self.wetting {
            Some(wetting) => wetting.stories()[body].covered > 0.0,
            None => self.water_on_body(body) > 0.0,
        };
        let is_cold = |body: usize| {
            let particles = self.solids.particles.iter().zip(&self.state.temperatures);
            let mut surface =
                particles.filter(|(particle, _)| particle.body as usize == body && particle.normal.is_some());
            surface.any(|(_, &temperature)| is_frost(temperature))
        };
        let frozen = self.names.iter().enumerate().filter(|(body, _)| is_wet(*body) && is_cold(*body));
        frozen
            .map(|(_, name)| {
                format!(
                    "there is water on the solid \"{name}\", and some of its surface is below 0 °C: it would be frost, which is out of scope, and is taken as \
                     water"
                )
            })
            .collect()
    }

    /// Water on a body, kg, and its mean temperature, K.
    fn totals_of(&self, body: usize) -> [f64; 2] {
        let of_body = |at: &usize| self.solids.particles[*at].body as usize == body;
        let (mut water, mut heat, mut volume) = (0.0, 0.0, 0.0);
        for at in (0..self.solids.particles.len()).filter(of_body) {
            water += self.state.water_on[at];
            heat += self.solids.particles[at].volume * self.state.temperatures[at];
            volume += self.solids.particles[at].volume;
        }
        [water, heat / volume]
    }
}

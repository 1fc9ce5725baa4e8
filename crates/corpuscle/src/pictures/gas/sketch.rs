//! A gas as discs and lines.

use super::{GasPicture, IN_WINDOW, INK, OWN_VIEW, TRAJECTORY, View, so_far, speed};
use crate::pictures::{Disc, Line, Moment, Sketch, SketchView, Sketcher};
use corpuscle_model::{Container, ParticleSet};
use corpuscle_output::gas_key;
use corpuscle_render::{KeyPosition, box_edges};

impl Sketcher for GasPicture {
    fn sketch(&mut self, seen: &SketchView, title: &str, moment: &Moment<'_>) -> Sketch {
        let key = gas_key(&self.gas, moment.frame);
        let (stage, container) = self.stage(moment);
        let is_flat = self.gas.dimensions() == 2;
        let camera = if is_flat { seen.plan(&stage, IN_WINDOW) } else { seen.orbit(&stage, &OWN_VIEW) };
        let view = View { stage, camera, container, key_position: KeyPosition::Corner };
        let overlay = self.overlay(title, moment, &key, &view, String::new());
        let balls = |(number, set): (usize, &ParticleSet)| {
            let colours = Self::colours(number, &key);
            let ball = |at: usize| Disc {
                position: set.position[at],
                radius: set.radius[at],
                colour: colours.colour(speed(set, at) as f32),
                has_rim: true,
            };
            (0..set.len()).map(ball).collect::<Vec<_>>()
        };
        let discs = moment.frame.sets.iter().enumerate().flat_map(balls).collect();
        let Container { from, to } = container;
        let edges = if is_flat { Vec::new() } else { box_edges(from, to) };
        let paths = moment.paths.iter().map(|path| so_far(path, moment.frame.time).to_vec());
        let lines = edges.into_iter().map(|points| Line { points, colour: INK });
        let lines = lines.chain(paths.map(|points| Line { points, colour: TRAJECTORY })).collect();
        Sketch { shown: seen.shown(stage, camera, overlay), patches: Vec::new(), discs, lines }
    }

    fn lift_partition(&mut self, time: f64) {
        self.lift(time);
    }
}

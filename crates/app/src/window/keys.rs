//! Handling of keys and of the controls of the strip.

use super::open::QUALITIES;
use super::{Panels, Window};
use crate::Source;
use crate::physics::{Command, default_pace};
use crate::transport::Pressed;
use egui::{Key, Ui};

/// Visibility of one of the panels.
type Panel = fn(&mut Panels) -> &mut bool;

impl Window {
    pub(super) fn keys(&mut self, ui: &Ui) {
        if ui.ctx().egui_wants_keyboard_input() {
            return;
        }
        let pressed = |key: Key| ui.input(|input| input.key_pressed(key) && input.modifiers.is_none());
        let keys = [(Key::Space, Pressed::Play), (Key::ArrowRight, Pressed::Step), (Key::R, Pressed::Restart)];
        for (key, what) in keys {
            if pressed(key) {
                self.press(what);
            }
        }
        let panels: [(Key, Panel); 3] = [
            (Key::G, |panels| &mut panels.scenes),
            (Key::P, |panels| &mut panels.parameters),
            (Key::L, |panels| &mut panels.plots),
        ];
        // Within another page the picture stays alone.
        for (key, panel) in panels.into_iter().filter(|_| self.embedded.is_none()) {
            if pressed(key) {
                self.panels.toggle(panel, self.is_narrow);
            }
        }
        if cfg!(feature = "film") && pressed(Key::V) {
            self.film();
        }
        if pressed(Key::S) {
            self.save_still();
        }
        let help = ui.input(|input| input.key_pressed(Key::F1) || input.key_pressed(Key::Questionmark));
        self.help |= help;
        let Some(open) = &mut self.open else { return };
        if pressed(Key::F) {
            open.picture.reset();
        }
        if pressed(Key::T) && !open.is_flat() {
            open.picture.camera_offset.plan = !open.picture.camera_offset.plan;
        }
        if pressed(Key::M) {
            open.instruments.toggle_ruler();
        }
        if pressed(Key::W) {
            open.instruments.toggle_stopwatch();
        }
        if pressed(Key::Escape) {
            (open.picked, open.spot, open.clicked) = (None, None, None);
        }
        for (key, (quality, ..)) in [Key::Num1, Key::Num2, Key::Num3].into_iter().zip(QUALITIES) {
            if pressed(key) {
                open.picture.quality = quality;
            }
        }
    }

    pub(super) fn press(&mut self, pressed: Pressed) {
        let Some(open) = &mut self.open else { return };
        match pressed {
            Pressed::Play => {
                let playing = !open.playing;
                self.play(playing);
            }
            Pressed::Step => {
                open.playing = false;
                self.physics.send(Command::Step(open.times * default_pace(open.end) / 30.0));
            }
            Pressed::Restart if open.recorded => self.physics.send(Command::Seek(0.0)),
            Pressed::Restart => {
                let changes = open.parameters.changes().to_vec();
                let source = Source { changes, ..open.source.clone() };
                self.open(source);
            }
            Pressed::Seek(time) => self.physics.send(Command::Seek(time)),
            Pressed::Pace(times) => {
                open.times = times;
                self.physics.send(Command::Pace(times * default_pace(open.end)));
            }
        }
    }
}

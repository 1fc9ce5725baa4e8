//! What comes from the physics and from the darkroom.

use super::Window;
use crate::darkroom::Print;
use crate::physics::Event;

impl Window {
    /// Takes what the physics told, and the pictures of the darkroom.
    pub(super) fn listen(&mut self) {
        self.look_for_dropped();
        for event in self.physics.events() {
            match event {
                Event::Opened(opened) => self.take(*opened),
                Event::Refused(what) => {
                    self.awaited = None;
                    self.fault = Some(what);
                }
                Event::NotChanged(what) => self.fault = Some(what),
                Event::Filmed(film) => self.filmed(film),
                Event::Ended => self.stopped(),
                Event::Fault(what) => {
                    self.fault = Some(what);
                    self.stopped();
                }
            }
        }
        self.take_prints();
        let newest = self.physics.newest();
        if let (Some(open), Some(newest)) = (&mut self.open, newest)
            && newest.number == open.number
        {
            open.plots.take(&newest);
            if let Some(picked) = &mut open.picked {
                picked.follow(&newest.known);
            }
            self.physics.follow(open.picked.is_some() || open.clicked.is_some());
            open.snapshot = Some(newest);
        }
    }

    fn stopped(&mut self) {
        if let Some(open) = &mut self.open {
            open.playing = false;
        }
    }

    fn take_prints(&mut self) {
        for print in self.darkroom.prints() {
            match (print, &mut self.open) {
                (Print::Still(still), _) => self.wrote(still),
                (Print::Rest(number, print), Some(open)) => open.picture.take(number, print),
                (Print::Rest(..), None) => {}
            }
        }
    }
}

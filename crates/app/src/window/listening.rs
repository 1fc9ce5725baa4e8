//! Events of the physics thread and pictures of the offscreen renderer.

use super::{Pending, Window};
use crate::offscreen::RenderResult;
use crate::physics::Event;

impl Window {
    /// Handles the events of the physics thread, and takes the pictures of the offscreen renderer.
    pub(super) fn listen(&mut self) {
        self.check_dropped();
        for event in self.physics.events() {
            match event {
                Event::Opened(opened) => self.take(*opened),
                Event::Refused(what) => {
                    self.not_opened();
                    self.fault = Some(what);
                }
                Event::NotChanged(what) => self.fault = Some(what),
                Event::Filmed(film) => self.filmed(film),
                Event::Ended => self.stopped(),
                Event::Fault(what) => {
                    self.fault = Some(what);
                    self.stopped();
                }
                Event::Broken(what) => {
                    self.not_opened();
                    self.fault = Some(what);
                    self.stopped();
                }
            }
        }
        self.take_pictures();
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

    /// Nothing is being opened any more but a file that is still being read.
    fn not_opened(&mut self) {
        self.pending.take_if(|pending| !matches!(pending, Pending::Dropped(_)));
    }

    fn stopped(&mut self) {
        if let Some(open) = &mut self.open {
            open.playing = false;
        }
    }

    fn take_pictures(&mut self) {
        for result in self.offscreen.results() {
            match (result, &mut self.open) {
                (RenderResult::Still(still), _) => self.wrote(still),
                (RenderResult::Paused(number, picture), Some(open)) => open.picture.take(number, picture),
                (RenderResult::Paused(..), None) => {}
            }
        }
    }
}

//! The picture of what rests: asked of the darkroom, and taken from it.

use super::{Drawn, Picture};
use crate::darkroom::{Darkroom, Finish, Sitting};
use crate::physics::Snapshot;
use crate::screen::OnScreen;
use crate::sight::Sight;
use corpuscle::gpu::Image;
use corpuscle::pictures::Shown;
use std::sync::Arc;

impl Picture {
    /// Asks the darkroom for a picture, unless it was asked for it already.
    pub(super) fn wish(&mut self, snapshot: &Arc<Snapshot>, drawn: Drawn, paper: [f32; 3], darkroom: &Darkroom) {
        if self.wished.as_ref().is_none_or(|(_, wished)| *wished != drawn) {
            let finish = Finish { look: drawn.look, size: drawn.size, samples: drawn.samples, paper };
            self.wished = Some((darkroom.rest(self.sitting(snapshot), finish), drawn));
        }
    }

    /// Takes a picture of the darkroom, by its number. One that is out of date is dropped: something changed since it was asked for.
    pub fn take(&mut self, number: u64, print: Result<Box<(Shown, Image)>, String>) {
        let Some((_, drawn)) = self.wished.clone().filter(|(wished, _)| *wished == number) else { return };
        let laid = print.and_then(|print| {
            let (shown, image) = *print;
            let inlay = self.screen.inlays.image(&self.screen.gpu, &image).map_err(|error| error.to_string())?;
            Ok((shown, OnScreen(inlay)))
        });
        match laid {
            Ok((shown, on_screen)) => {
                (self.shown, self.on_screen, self.drawn) = (Some(shown), Some(on_screen), Some(drawn));
            }
            Err(error) => self.fault = Some(error),
        }
    }

    /// How it is seen.
    pub fn sight(&self) -> Sight {
        Sight { hand: self.hand, lifted: self.lifted }
    }

    /// A snapshot as it is seen now.
    pub fn sitting(&self, snapshot: &Arc<Snapshot>) -> Sitting {
        Sitting { scenery: self.scenery.clone(), snapshot: snapshot.clone(), sight: self.sight() }
    }
}

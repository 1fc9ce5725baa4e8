//! The arrow towards north.

use super::{MARGIN, Page};
use corpuscle_drawing::svg::Anchor;

/// Radius of the arrow's panel; distances of its tip, its two corners behind and the notch between them from the middle; how far the
/// corners stand to the side; and how far the letter is from the middle, CSS pixels.
const RADIUS: f64 = 26.0;
const TIP: f64 = 5.0;
const CORNERS: f64 = -18.0;
const NOTCH: f64 = -12.0;
const ASIDE: f64 = 7.0;
const LETTER: f64 = 15.0;
/// Space between the panel and the time above it.
const BELOW_TIME: f64 = 32.0;
/// Step northwards by which the direction on the page is found, of the stage's half diagonal.
const STEP: f64 = 1e-3;

/// Draws it in the upper right corner, below the time.
pub(super) fn draw(page: &mut Page<'_>) {
    let Some([right, down]) = direction(page) else { return };
    let middle = [page.size[0] - MARGIN - RADIUS, MARGIN + BELOW_TIME + RADIUS];
    let at =
        |along: f64, aside: f64| [middle[0] + along * right - aside * down, middle[1] + along * down + aside * right];
    page.svg.circle(middle, RADIUS, "panel");
    page.svg.path([at(TIP, 0.0), at(CORNERS, ASIDE), at(NOTCH, 0.0), at(CORNERS, -ASIDE)], true, "north");
    let [x, y] = at(LETTER, 0.0);
    page.svg.text([x, y + 5.0], Anchor::Middle, "over", "N");
}

/// The direction of north on the page, `[to the right, downwards]`, of length 1; none where one looks along it.
fn direction(page: &Page<'_>) -> Option<[f64; 2]> {
    let centre: [f64; 3] = page.stage.centre().into();
    let step = STEP * page.stage.unit();
    let from = page.position(centre)?;
    let to = page.position([centre[0], centre[1] + step, centre[2]])?;
    let (right, down) = (to[0] - from[0], to[1] - from[1]);
    let length = right.hypot(down);
    (length > 0.0).then(|| [right / length, down / length])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Camera, Stage};
    use corpuscle_drawing::svg::Svg;

    fn direction_of(stage: &Stage, camera: &Camera) -> [f64; 2] {
        direction(&Page { svg: Svg::default(), size: [1280.0, 720.0], stage, camera }).unwrap()
    }

    #[test]
    fn north_is_up_in_plans_and_turns_with_the_camera() {
        let stage = Stage::new([0.0; 3], [400.0, 300.0, 20.0]);
        let near = |found: [f64; 2], right: f64, down: f64| (found[0] - right).hypot(found[1] - down) < 1e-3;
        assert!(near(direction_of(&stage, &Camera::plan(&stage, 16.0 / 9.0, [0.1; 4])), 0.0, -1.0));
        // From the south, the east, the north and the west: azimuths of the camera from east over north.
        for (quarter, right, down) in [(3.0, 0.0, -1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 1.0), (2.0, -1.0, 0.0)] {
            let azimuth = 0.5 * std::f64::consts::PI * quarter;
            let camera = Camera::orbit(&stage, [azimuth, 0.6], 0.5, 16.0 / 9.0, 0.05);
            let found = direction_of(&stage, &camera);
            assert!(near(found, right, down), "{azimuth}: {found:?}");
        }
    }
}

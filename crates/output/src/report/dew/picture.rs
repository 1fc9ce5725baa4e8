//! Pictures of the solids: the drops on them true to scale, and maps of where they are wet.

use crate::picture::{Cap, Figure, SolidsPicture, Vector, View, number};
use corpuscle_model::{Model, ParticleSet, Surface, Values};

/// Largest width and height of the picture of all solids, of a moment, and of a map, CSS pixels.
const WHOLE: [f64; 2] = [940.0, 640.0];
const MOMENT: [f64; 2] = [314.0, 260.0];
const MAP: [f64; 2] = [470.0, 380.0];

/// Maps are drawn of no more solids than this, the wettest.
const MOST_MAPS: usize = 4;

/// Drops at the time that the model shows, on all solids.
///
/// # Errors
/// What cannot be encoded.
pub(super) fn drops(model: &dyn Model) -> Result<Option<Figure>, String> {
    let caps = caps(model);
    let count = number(caps.len() as f64).replace(".00", "").replace(".0", "");
    let words = if caps.is_empty() { "No drops".into() } else { format!("{count} drops, true to scale") };
    let note = if caps.is_empty() { "" } else { "White mist: drops too small to be seen one by one" };
    draw(model, &caps, WHOLE, [&words, note])
}

/// The same, small, with a caption.
///
/// # Errors
/// What cannot be encoded.
pub(super) fn moment(model: &dyn Model, caption: &str) -> Result<Option<Figure>, String> {
    draw(model, &caps(model), MOMENT, [caption, ""])
}

fn draw(model: &dyn Model, caps: &[Cap], most: [f64; 2], [caption, note]: [&str; 2]) -> Result<Option<Figure>, String> {
    let surfaces = model.surfaces();
    if surfaces.is_empty() {
        return Ok(None);
    }
    // The view does not depend on where drops are, so that it stays the same while they come and go.
    let view = View::of(&surfaces, |surface| vec![1.0; surface.position.len()]);
    let picture = SolidsPicture { surfaces: &surfaces, room: room(model), view, most };
    picture.drops(caps, caption, note).map(Some)
}

/// Maps of the solids that were ever wet: name of the file and figure.
///
/// # Errors
/// What cannot be encoded.
pub(super) fn maps(model: &dyn Model) -> Result<Vec<(String, Figure)>, String> {
    let mut wet: Vec<(f64, Surface)> =
        model.surfaces().into_iter().map(|surface| (most_water(&surface), surface)).collect();
    wet.retain(|(most, _)| *most > 0.0);
    wet.sort_by(|a, b| b.0.total_cmp(&a.0));
    wet.truncate(MOST_MAPS);
    let maps = wet.iter().map(|(_, surface)| maps_of(surface, room(model)));
    Ok(maps.collect::<Result<Vec<_>, String>>()?.into_iter().flatten().collect())
}

fn maps_of(surface: &Surface, room: [Vector; 2]) -> Result<Vec<(String, Figure)>, String> {
    let column = |name: &str| surface.scalar(name).unwrap_or_default().to_vec();
    let most = column("most_water_kg_per_m2");
    let view = View::square_on(surface, &most);
    let picture = SolidsPicture { surfaces: std::slice::from_ref(surface), room, view, most: MAP };
    let name = &surface.name;
    // Where a solid is clear again the maps show how wet it was.
    let water = column("water_kg_per_m2");
    let is_wet = water.iter().any(|&water| water > 1e-3 * most.iter().copied().fold(0.0, f64::max));
    let grams = |values: Vec<f64>| values.into_iter().map(|value| 1e3 * value).collect::<Vec<_>>();
    let [first, second] = if is_wet {
        [
            picture.field(&grams(water), &format!("{name}: water, g/m²"))?,
            picture.field(&column("covered_part"), &format!("{name}: part that drops cover"))?,
        ]
    } else {
        [
            picture.field(&grams(most), &format!("{name}: largest amount of water, g/m²"))?,
            picture.field(&column("wet_for_s"), &format!("{name}: duration of wetting, s"))?,
        ]
    };
    let file = name.replace(' ', "_");
    let mut maps = vec![(format!("{file}_water"), first), (format!("{file}_covered"), second)];
    let times =
        [("fogged_at", "time when drops first covered a tenth, s"), ("clear_at", "time when it was clear again, s")];
    for (which, title) in times {
        let times = column(&format!("{which}_s"));
        // Where nothing happened there is no time.
        if times.iter().any(|time| time.is_finite()) {
            maps.push((format!("{file}_{which}"), picture.field(&times, &format!("{name}: {title}"))?));
        }
    }
    Ok(maps)
}

fn most_water(surface: &Surface) -> f64 {
    let most = surface.scalar("most_water_kg_per_m2").unwrap_or_default();
    most.iter().zip(&surface.half_width).map(|(water, half)| 4.0 * half * half * water).sum()
}

fn room(model: &dyn Model) -> [Vector; 2] {
    model.container().map_or([[f64::NEG_INFINITY; 3], [f64::INFINITY; 3]], |room| [room.from, room.to])
}

fn caps(model: &dyn Model) -> Vec<Cap> {
    let frame = model.frame();
    frame.sets.iter().find(|set| set.name == "drops").map(caps_of).unwrap_or_default()
}

fn caps_of(set: &ParticleSet) -> Vec<Cap> {
    let column = |name: &str| set.columns.iter().find(|column| column.name == name).map(|column| &column.values);
    let (Some(Values::Scalar(height)), Some(Values::Vector(normal))) = (column("height"), column("normal")) else {
        return Vec::new();
    };
    let cap =
        |at: usize| Cap { position: set.position[at], normal: normal[at], radius: set.radius[at], height: height[at] };
    (0..set.len()).map(cap).collect()
}

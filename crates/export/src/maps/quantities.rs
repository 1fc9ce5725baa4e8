//! What maps show, by name.

/// Name, title and unit of the maps of floods, as the models give them. Files of maps have names alone.
const QUANTITIES: [(&str, &str, &str); 12] = [
    ("depth", "Depth", "m"),
    ("max_depth", "Maximum depth", "m"),
    ("max_speed", "Maximum speed", "m/s"),
    ("arrival_s", "Arrival", "s"),
    ("duration_s", "Duration", "s"),
    ("hazard", "Hazard: depth x (speed + 0.5)", "m2/s"),
    ("max_level", "Highest level", "m"),
    ("velocity_east", "Velocity at the end, eastwards", "m/s"),
    ("velocity_north", "Velocity at the end, northwards", "m/s"),
    ("fastest_east", "Velocity at the highest speed, eastwards", "m/s"),
    ("fastest_north", "Velocity at the highest speed, northwards", "m/s"),
    ("infiltration", "Infiltration", "m"),
];

/// Title and unit of a map; of one that is not of this program its name in words, and no unit.
pub(super) fn quantity(name: &str) -> (String, Option<&'static str>) {
    match QUANTITIES.iter().find(|(known, ..)| *known == name) {
        Some((_, title, unit)) => ((*title).to_owned(), Some(unit)),
        None => (name.replace('_', " "), None),
    }
}

//! Refuses values that are not finite before they are written. NaN stays where it means that there is no value: in maps, where nothing is
//! wet, and in times at which nothing happened yet.

use crate::OutputError;
use corpuscle_model::{Column, Frame, Map, Surface, Values};

/// Refuses a frame with a value that is not finite.
pub(crate) fn check_frame(frame: &Frame) -> Result<(), OutputError> {
    for set in &frame.sets {
        let refused = |(quantity, number, value): (&str, usize, f64)| {
            let id = set.id.get(number).map_or(number as u64, |id| *id);
            let position = set.position.get(number).copied().unwrap_or([f64::NAN; 3]);
            let time = frame.time;
            OutputError::NotFinite {
                what: format!("the {quantity} of `{}` {id} at {position:.6?}, t = {time} s, is {value}", set.name),
            }
        };
        let vectors = [("position", &set.position), ("velocity", &set.velocity)];
        let scalars = [("radius", &set.radius), ("mass", &set.mass)];
        let own = || vectors.into_iter().find_map(|(name, values)| first_vector(name, values));
        let bad = own()
            .or_else(|| scalars.into_iter().find_map(|(name, values)| first(name, values, f64::is_finite)))
            .or_else(|| set.columns.iter().find_map(|column| first_in(column, f64::is_finite)));
        bad.map_or(Ok(()), |bad| Err(refused(bad)))?;
    }
    Ok(())
}

/// Refuses a surface with a value that is not finite; a time of nothing yet is NaN.
pub(crate) fn check_surface(surface: &Surface) -> Result<(), OutputError> {
    let is_allowed =
        |column: &Column| if column.unit == "s" { |value: f64| !value.is_infinite() } else { f64::is_finite };
    let vectors = [("position", &surface.position), ("normal", &surface.normal)];
    let bad = vectors
        .into_iter()
        .find_map(|(name, values)| first_vector(name, values))
        .or_else(|| first("size", &surface.half_width, f64::is_finite))
        .or_else(|| surface.columns.iter().find_map(|column| first_in(column, is_allowed(column))));
    bad.map_or(Ok(()), |(quantity, patch, value)| {
        let position = surface.position.get(patch).copied().unwrap_or([f64::NAN; 3]);
        let what = format!("the {quantity} of the surface of `{}` at {position:.6?} is {value}", surface.name);
        Err(OutputError::NotFinite { what })
    })
}

/// Refuses a map with a value that is infinite; where there is nothing a map is NaN.
pub(crate) fn check_map(map: &Map) -> Result<(), OutputError> {
    let Some(cell) = map.values.iter().position(|value| value.is_infinite()) else { return Ok(()) };
    let (row, column) = (cell / map.columns.max(1), cell % map.columns.max(1));
    let what = format!("the map {} in row {row}, column {column} is {}", map.name, map.values[cell]);
    Err(OutputError::NotFinite { what })
}

/// A value that is refused: its quantity, the number of the particle, and the value.
type Refused<'a> = (&'a str, usize, f64);

fn first<'a>(name: &'a str, values: &[f64], is_allowed: impl Fn(f64) -> bool) -> Option<Refused<'a>> {
    let number = values.iter().position(|value| !is_allowed(*value))?;
    Some((name, number, values[number]))
}

fn first_vector<'a>(name: &'a str, values: &[[f64; 3]]) -> Option<Refused<'a>> {
    let (name, number, value) = first(name, values.as_flattened(), f64::is_finite)?;
    Some((name, number / 3, value))
}

fn first_in(column: &Column, is_allowed: impl Fn(f64) -> bool) -> Option<Refused<'_>> {
    match &column.values {
        Values::Scalar(values) => first(column.name, values, is_allowed),
        Values::Vector(values) => first_vector(column.name, values),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_model::ParticleSet;

    fn column(name: &'static str, unit: &'static str, value: f64) -> Column {
        Column { name, unit, values: Values::Scalar(vec![1.0, value]) }
    }

    fn set() -> ParticleSet {
        ParticleSet {
            name: "air".into(),
            id: vec![3, 8],
            position: vec![[0.5, 0.25, 0.0]; 2],
            velocity: vec![[0.0; 3]; 2],
            radius: vec![1.0; 2],
            mass: vec![1.0; 2],
            columns: vec![column("temperature", "K", 300.0)],
        }
    }

    #[test]
    fn a_frame_is_refused_with_the_quantity_the_particle_its_position_and_the_time() {
        let refusal =
            |set: ParticleSet| check_frame(&Frame { time: 2.5, sets: vec![set] }).map_err(|error| error.to_string());
        assert_eq!(refusal(set()), Ok(()));
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let broken: [(&str, ParticleSet); 5] = [
                ("position", ParticleSet { position: vec![[0.5, 0.25, 0.0], [0.5, 0.25, bad]], ..set() }),
                ("velocity", ParticleSet { velocity: vec![[0.0; 3], [bad, 0.0, 0.0]], ..set() }),
                ("radius", ParticleSet { radius: vec![1.0, bad], ..set() }),
                ("mass", ParticleSet { mass: vec![1.0, bad], ..set() }),
                ("temperature", ParticleSet { columns: vec![column("temperature", "K", bad)], ..set() }),
            ];
            for (quantity, set) in broken {
                let told = refusal(set).unwrap_err();
                let words = [quantity, "`air` 8 at [0.500000, 0.250000", "t = 2.5 s"];
                assert!(words.iter().all(|word| told.contains(word)), "{told}");
            }
        }
    }

    #[test]
    fn no_value_is_written_where_it_means_none() {
        let map =
            |value| Map { name: "arrival_s", title: "", unit: "s", columns: 2, rows: 1, values: vec![0.0, value] };
        assert!(check_map(&map(f32::NAN)).is_ok());
        let told = check_map(&map(f32::INFINITY)).unwrap_err().to_string();
        assert!(told.contains("arrival_s in row 0, column 1"), "{told}");
        let surface = |column| Surface {
            name: "pane".into(),
            position: vec![[0.5; 3]; 2],
            normal: vec![[0.0, 0.0, 1.0]; 2],
            half_width: vec![0.1; 2],
            columns: vec![column],
            shape: Default::default(),
        };
        assert!(check_surface(&surface(column("clear_at_s", "s", f64::NAN))).is_ok());
        for (column, name) in [
            (column("clear_at_s", "s", f64::INFINITY), "clear_at_s"),
            (column("water_kg_per_m2", "kg/m2", f64::NAN), "water_kg_per_m2"),
        ] {
            let told = check_surface(&surface(column)).unwrap_err().to_string();
            assert!(told.contains(name) && told.contains("`pane` at [0.5"), "{told}");
        }
    }
}

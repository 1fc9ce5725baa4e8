//! Heat properties of common materials.

/// A material at room temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Name as written in a scene.
    pub name: &'static str,
    /// Conductivity of heat, W/(m K).
    pub conductivity: f64,
    /// Heat capacity, J/(kg K).
    pub heat_capacity: f64,
    /// Density, kg/m³.
    pub density: f64,
    /// Where the numbers come from.
    pub source: &'static str,
}

impl Material {
    /// Diffusivity of heat, m²/s.
    pub fn diffusivity(&self) -> f64 {
        self.conductivity / (self.density * self.heat_capacity)
    }
}

const INCROPERA: &str =
    "Incropera & DeWitt, Fundamentals of Heat and Mass Transfer, 6th edition, tables A.1 and A.3, 300 K";
const ISO: &str = "ISO 10456:2007, table 3 (design values)";

/// The materials that a scene may name.
pub const MATERIALS: &[Material] = &[
    material_of("glass", 1.4, 750.0, 2500.0, INCROPERA),
    material_of("steel", 60.5, 434.0, 7854.0, INCROPERA),
    material_of("stainless-steel", 14.9, 477.0, 7900.0, INCROPERA),
    material_of("copper", 401.0, 385.0, 8933.0, INCROPERA),
    material_of("aluminium", 237.0, 903.0, 2702.0, INCROPERA),
    material_of("oak", 0.17, 2385.0, 545.0, INCROPERA),
    material_of("pmma", 0.18, 1500.0, 1180.0, ISO),
    material_of("polycarbonate", 0.20, 1200.0, 1200.0, ISO),
    material_of("wood", 0.13, 1600.0, 500.0, ISO),
    material_of("concrete", 2.0, 1000.0, 2400.0, ISO),
];

const fn material_of(
    name: &'static str,
    conductivity: f64,
    heat_capacity: f64,
    density: f64,
    source: &'static str,
) -> Material {
    Material { name, conductivity, heat_capacity, density, source }
}

/// The material of that name; none where there is none.
pub fn material(name: &str) -> Option<&'static Material> {
    MATERIALS.iter().find(|material| material.name == name)
}

#[cfg(test)]
mod tests {
    use super::{MATERIALS, material};

    #[test]
    fn diffusivities_are_as_tabulated() {
        // Incropera & DeWitt, table A.1: 117e-6 and 17.7e-6 m2/s at 300 K.
        assert!((material("copper").unwrap().diffusivity() / 117e-6 - 1.0).abs() < 0.005);
        assert!((material("steel").unwrap().diffusivity() / 17.7e-6 - 1.0).abs() < 0.005);
        assert!(material("butter").is_none());
    }

    #[test]
    fn names_are_unique() {
        let mut names: Vec<_> = MATERIALS.iter().map(|material| material.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), MATERIALS.len());
    }
}

//! Discharge through culverts and over weirs.

use corpuscle_scene::{Table, Weir};

/// How much water a link leads.
#[derive(Debug, Clone)]
pub(crate) enum Law {
    Culvert(Culvert),
    Weir(Weir),
    /// Discharge, m3/s, over the difference of the levels, m.
    Rating(Table),
}

/// A culvert, its numbers worked out.
#[derive(Debug, Clone)]
pub(crate) struct Culvert {
    /// Inner height, m.
    height: f64,
    /// Area of one barrel, m2.
    area: f64,
    /// Hydraulic radius of a full barrel, m.
    radius: f64,
    length: f64,
    /// Levels of the floor at both ends, m.
    floor: [f64; 2],
    manning: f64,
    entrance_loss: f64,
    barrels: f64,
}

/// Coefficient of an orifice (Bodhaine 1968, the middle of his range for culverts).
pub(crate) const ORIFICE: f64 = 0.6;

/// Depth over the height of the culvert from which its inlet is an orifice (Henderson 1966, section 7.6).
pub(crate) const SUBMERGED: f64 = 1.2;

impl Law {
    /// Discharge, m3/s, from the end where the water stands at `upper`, m, to where it stands at `lower` or is away; `ends` are
    /// the numbers of the two ends, 0 for `from`.
    pub fn discharge(&self, upper: f64, lower: Option<f64>, ends: [usize; 2], gravity: f64) -> f64 {
        match self {
            Self::Culvert(culvert) => culvert.discharge(upper, lower, ends, gravity),
            Self::Weir(weir) => over_weir(weir, upper, lower),
            Self::Rating(table) => {
                // Where it has run dry the fall is not known: as from the same ground.
                let head = lower.map_or(0.0, |lower| upper - lower);
                table.at(head)
            }
        }
    }
}

/// Exponent of the part of its free discharge that a submerged weir lets over (Villemonte 1947).
pub(crate) const SUBMERGENCE_EXPONENT: f64 = 0.385;

/// Poleni's formula Q = C b h1^(3/2), less what the water behind the crest holds back: (1 - (h2/h1)^(3/2))^0.385 (Villemonte
/// 1947).
pub(crate) fn over_weir(weir: &Weir, upper: f64, lower: Option<f64>) -> f64 {
    let head = (upper - weir.crest_m).max(0.0);
    let behind = (lower.unwrap_or(f64::NEG_INFINITY) - weir.crest_m).clamp(0.0, head);
    if head == 0.0 {
        return 0.0;
    }
    let free = weir.coefficient * weir.width_m * head.powf(1.5);
    free * (1.0 - (behind / head).powf(1.5)).powf(SUBMERGENCE_EXPONENT)
}

impl Culvert {
    /// A culvert between two ends `distance` m apart on ground of the given levels, m.
    pub fn new(scene: &corpuscle_scene::Culvert, distance: f64, ground: [f64; 2]) -> Self {
        let (height, area, perimeter) = match (scene.diameter_m, scene.width_m, scene.height_m) {
            (None, Some(width), Some(height)) => (height, width * height, 2.0 * (width + height)),
            (diameter, ..) => {
                let diameter = diameter.unwrap_or(1.0);
                let around = std::f64::consts::PI * diameter;
                (diameter, 0.25 * around * diameter, around)
            }
        };
        Self {
            height,
            area,
            radius: area / perimeter,
            length: scene.length_m.unwrap_or(distance),
            floor: scene.floor_m.unwrap_or(ground),
            manning: scene.manning,
            entrance_loss: scene.entrance_loss,
            barrels: scene.barrels as f64,
        }
    }

    /// The numbers as shaders have them, levels above `level`, m.
    #[cfg(feature = "gpu")]
    pub fn numbers(&self, level: f64) -> [f64; 9] {
        let Self { height, area, radius, length, floor, manning, entrance_loss, barrels } = self;
        [*height, *area, *radius, *length, floor[0] - level, floor[1] - level, *manning, *entrance_loss, *barrels]
    }

    fn discharge(&self, upper: f64, lower: Option<f64>, [from, to]: [usize; 2], gravity: f64) -> f64 {
        let depth = (upper - self.floor[from]).max(0.0);
        let inlet = self.inlet(depth, gravity);
        // Sought by halving: the discharge that needs no more than the level there is.
        let needed = |discharge: f64| self.outlet_level(discharge, lower, to, gravity);
        let (mut low, mut high) = (0.0, inlet);
        if needed(high) > upper {
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if needed(middle) > upper { high = middle } else { low = middle }
            }
        } else {
            low = inlet;
        }
        self.barrels * low
    }

    /// Discharge of one barrel, m3/s, where its inlet decides, with water `depth` m deep before it: critical flow over a sill
    /// as wide as a box of its area, Q = b (2 h/3)^(3/2) g^(1/2); an orifice, Q = C A (2 g (h - D/2))^(1/2), once it is under
    /// water. At h = 1.2 D the two are within one per cent.
    fn inlet(&self, depth: f64, gravity: f64) -> f64 {
        let sill = |depth: f64| self.area / self.height * (2.0 / 3.0 * depth).powf(1.5) * gravity.sqrt();
        let transition = SUBMERGED * self.height;
        if depth < transition {
            return sill(depth);
        }
        let orifice = |depth: f64| ORIFICE * self.area * (2.0 * gravity * (depth - 0.5 * self.height)).sqrt();
        sill(transition) * orifice(depth) / orifice(transition)
    }

    /// The level that a discharge through one barrel needs above it where the outlet decides: that behind it, or critical depth
    /// in it, and the losses of a full barrel, (1 + k + 2 g n^2 L / R^(4/3)) v^2 / (2 g) (Schall et al. 2012, HDS-5, equation 3.6b).
    fn outlet_level(&self, discharge: f64, lower: Option<f64>, to: usize, gravity: f64) -> f64 {
        let per_width = discharge * self.height / self.area;
        let critical = (per_width * per_width / gravity).cbrt().min(self.height);
        let behind = (self.floor[to] + critical).max(lower.unwrap_or(f64::NEG_INFINITY));
        let velocity = discharge / self.area;
        let friction = 2.0 * gravity * self.manning.powi(2) * self.length / self.radius.powf(4.0 / 3.0);
        behind + (1.0 + self.entrance_loss + friction) * velocity * velocity / (2.0 * gravity)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_scene::Series;
    use std::path::Path;

    const G: f64 = 9.81;

    fn pipe(length: f64) -> Culvert {
        let scene: corpuscle_scene::Culvert = corpuscle_scene::Culvert {
            diameter_m: Some(1.0),
            width_m: None,
            height_m: None,
            length_m: Some(length),
            floor_m: Some([10.0, 9.9]),
            manning: 0.012,
            entrance_loss: 0.5,
            barrels: 2,
        };
        Culvert::new(&scene, 1.0, [0.0; 2])
    }

    #[test]
    fn a_drowned_culvert_runs_full_as_manning_says() {
        let (upper, lower) = (12.0, 11.5);
        let friction = 2.0 * G * 0.012_f64.powi(2) * 40.0 / 0.25_f64.powf(4.0 / 3.0);
        let exact = 2.0 * std::f64::consts::FRAC_PI_4 * (2.0 * G * 0.5 / (1.5 + friction)).sqrt();
        let found = Law::Culvert(pipe(40.0)).discharge(upper, Some(lower), [0, 1], G);
        assert!((found / exact - 1.0).abs() < 1e-9, "{found} {exact}");
        let level = Law::Culvert(pipe(40.0)).discharge(upper, Some(upper), [0, 1], G);
        assert!(level < 1e-6);
    }

    #[test]
    fn a_short_steep_culvert_is_ruled_by_its_inlet() {
        let law = Law::Culvert(pipe(1.0));
        // A sill while it is low, an orifice when it is high, and no leap between.
        let sill = 2.0 * std::f64::consts::FRAC_PI_4 * (2.0 / 3.0 * 0.5_f64).powf(1.5) * G.sqrt();
        assert!((law.discharge(10.5, None, [0, 1], G) / sill - 1.0).abs() < 1e-9);
        let orifice = 2.0 * 0.6 * std::f64::consts::FRAC_PI_4 * (2.0 * G * 2.5).sqrt();
        assert!((law.discharge(13.0, None, [0, 1], G) / orifice - 1.0).abs() < 0.02);
        let [below, above] = [11.1999, 11.2001].map(|level| law.discharge(level, None, [0, 1], G));
        assert!((above / below - 1.0).abs() < 1e-3);
        assert_eq!(law.discharge(9.95, None, [0, 1], G), 0.0);
    }

    #[test]
    fn a_weir_drowns_as_villemonte_says() {
        let weir = Weir { crest_m: 5.0, width_m: 3.0, coefficient: 1.8 };
        let law = Law::Weir(weir);
        let free = 1.8 * 3.0 * 0.4_f64.powf(1.5);
        assert!((law.discharge(5.4, Some(4.0), [0, 1], G) - free).abs() < 1e-12);
        let drowned = law.discharge(5.4, Some(5.3), [0, 1], G);
        assert!((drowned / free - (1.0 - 0.75_f64.powf(1.5)).powf(0.385)).abs() < 1e-12);
        assert_eq!(law.discharge(5.4, Some(5.4), [0, 1], G), 0.0);
        assert_eq!(law.discharge(4.9, None, [0, 1], G), 0.0);
    }

    #[test]
    fn a_rating_is_read_by_the_difference() {
        let table = Series::Table(vec![[0.0, 0.0], [1.0, 2.0]]).load(Path::new("")).unwrap();
        assert_eq!(Law::Rating(table).discharge(7.5, Some(7.0), [0, 1], G), 1.0);
    }
}

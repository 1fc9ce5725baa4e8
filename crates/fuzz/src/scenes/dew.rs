//! Scenes of dew.

use super::Maker;
use corpuscle_scene::dew::{
    Air, AirInflow, Boundary, Dew, Drops, Face, Faces, Fan, Heater, HumidityTransport, LowUtility, Material, Mean,
    Output, Outside, Radiation, Scheme, Shape, Side, Solid, SolidFace, Transport, Treatment, WallLayer, Wetting,
};
use corpuscle_scene::{KernelName, Series};

/// Humid air of some hundred particles, with one or two solids.
pub(super) fn scene(maker: &mut Maker<'_>) -> String {
    let until = 1.0;
    let spacing = maker.one_of(&[0.003, 0.005, 0.008]);
    let size: [f64; 3] = std::array::from_fn(|_| spacing * (6 + maker.random.below(4)) as f64);
    let scheme = if maker.has(0.3) { Scheme::ParticleCondensation } else { Scheme::Physical };
    let faces = faces(maker);
    let all = [&faces.x_min, &faces.x_max, &faces.y_min, &faces.y_max, &faces.z_min, &faces.z_max];
    let leaves = all.iter().any(|face| matches!(face, Face::Outflow | Face::Open));
    let dew = Dew {
        size_m: size,
        spacing_m: spacing,
        scheme,
        kernel: maker.one_of(&[KernelName::Mueller, KernelName::CubicSpline, KernelName::WendlandC2]),
        gravity_m_per_s2: [0.0, 0.0, if maker.has(0.1) { 0.0 } else { -9.81 }],
        buoyancy: !maker.has(0.3),
        time_factor: maker.maybe(0.3, |maker| maker.between(1.0, 20.0)).unwrap_or(1.0),
        air: air(maker),
        fan: maker.list(0.2, 1, |maker, _| Fan {
            position_m: size.map(|length| 0.5 * length),
            size_m: size.map(|length| 0.4 * length),
            velocity_m_per_s: std::array::from_fn(|_| maker.between(-0.3, 0.3)),
        }),
        boundary: Boundary {
            // The treatment `virtual-force` may break down: see the page on limits.
            treatment: maker.one_of(&[
                Treatment::DensityCorrection,
                Treatment::DensityCorrection,
                Treatment::Ghost,
                Treatment::VirtualForce,
                Treatment::None,
            ]),
            colour_threshold: 0.15,
            kappa: maker.maybe(0.3, |maker| maker.between(0.8, 1.2)).unwrap_or(1.0),
        },
        transport: transport(maker, scheme),
        drops: drops(maker),
        low_utility: maker
            .maybe(0.2, |maker| LowUtility { distance: maker.between(1.0, 6.0), after_s: maker.between(0.01, 1.0) })
            .filter(|_| leaves),
        output: Output { air: !maker.has(0.2), solids: !maker.has(0.2) },
        solid: solids(maker, scheme, size, spacing, &all, until),
        faces: faces.clone(),
    };
    super::text(maker, until, &[("dew", &dew)])
}

/// The sides of a box, those of an axis beside each other.
const SIDES: [Side; 6] = [Side::XMin, Side::XMax, Side::YMin, Side::YMax, Side::ZMin, Side::ZMax];

fn air(maker: &mut Maker<'_>) -> Air {
    let celsius = maker.between(-20.0, 60.0);
    let (relative, below, ratio) = (maker.between(0.0, 1.0), maker.between(0.0, 20.0), maker.between(0.0, 0.002));
    let kind = maker.random.below(3);
    Air {
        temperature_c: celsius,
        relative_humidity: (kind == 0).then_some(relative),
        dew_point_c: (kind == 1).then_some(celsius - below),
        mixing_ratio: (kind == 2).then_some(0.2 * ratio),
        pressure_pa: maker.maybe(0.3, |maker| maker.between(5e4, 2e5)).unwrap_or(101_325.0),
        velocity_m_per_s: maker
            .maybe(0.3, |maker| std::array::from_fn(|_| maker.between(-0.1, 0.1)))
            .unwrap_or_default(),
    }
}

fn faces(maker: &mut Maker<'_>) -> Faces {
    let mut pair = |axis: usize| {
        let is_periodic = maker.has(0.15);
        let mut side = |inwards: f64| {
            let speed = maker.between(0.02, 0.3);
            let (by, relative, below) = (maker.random.below(4), maker.between(0.0, 0.5), maker.between(0.0, 20.0));
            let ratio = maker.between(0.0, 0.002);
            let inflow = AirInflow {
                velocity_m_per_s: std::array::from_fn(|k| if k == axis { inwards * speed } else { 0.0 }),
                temperature_c: maker.maybe(0.5, |maker| {
                    let (celsius, later) = (maker.between(0.0, 40.0), maker.between(0.0, 40.0));
                    let changes = maker.has(0.3);
                    if changes { Series::Table(vec![[0.0, celsius], [0.02, later]]) } else { Series::Constant(celsius) }
                }),
                relative_humidity: (by == 1).then_some(Series::Constant(relative)),
                dew_point_c: (by == 2).then_some(Series::Constant(-below)),
                mixing_ratio: (by == 3).then_some(Series::Constant(ratio)),
            };
            let kind = maker.random.below(4);
            let is_other = maker.has(0.25);
            match kind {
                _ if is_periodic => Face::Periodic,
                0 if is_other => Face::Open,
                1 if is_other => Face::Outflow,
                2 if is_other => Face::Inflow(inflow),
                _ => Face::Wall,
            }
        };
        [side(1.0), side(-1.0)]
    };
    let [[x_min, x_max], [y_min, mut y_max], [z_min, z_max]] = [pair(0), pair(1), pair(2)];
    // Air that comes in must be able to leave.
    let all = [&x_min, &x_max, &y_min, &y_max, &z_min, &z_max];
    let enters = all.iter().any(|face| matches!(face, Face::Inflow(_)));
    let leaves = all.iter().any(|face| matches!(face, Face::Outflow | Face::Open));
    if enters && !leaves && y_max != Face::Periodic {
        y_max = Face::Open;
    }
    Faces { x_min, x_max, y_min, y_max, z_min, z_max }
}

fn transport(maker: &mut Maker<'_>, scheme: Scheme) -> Transport {
    let humidity =
        maker.maybe(0.3, |maker| maker.one_of(&[HumidityTransport::MassFraction, HumidityTransport::RelativeHumidity]));
    Transport {
        conductivity_mean: maker.maybe(0.3, |maker| maker.one_of(&[Mean::Harmonic, Mean::Arithmetic])),
        humidity: humidity.filter(|_| scheme == Scheme::ParticleCondensation),
        latent_heat: maker.maybe(0.3, |maker| maker.random.chance(0.5)),
        vapour_diffusivity_m2_per_s: maker.maybe(0.2, |maker| maker.between(1e-6, 1e-4)),
        air_conductivity_w_per_m_k: maker.maybe(0.2, |maker| maker.between(0.005, 0.1)),
        air_heat_capacity_j_per_kg_k: maker.maybe(0.2, |maker| maker.between(500.0, 2000.0)),
        air_viscosity_pa_s: maker.maybe(0.2, |maker| maker.between(1e-6, 1e-4)),
    }
}

fn drops(maker: &mut Maker<'_>) -> Drops {
    let contact = maker.between(10.0, 120.0);
    let friction = maker.maybe(0.2, |maker| maker.between(1e-5, 1e-3));
    let angles = maker.maybe(0.3, |maker| [maker.between(0.3, 1.0), maker.between(1.0, 1.4)]);
    let angles = angles.filter(|_| friction.is_none());
    Drops {
        contact_angle_deg: contact,
        receding_angle_deg: angles.map(|[part, _]| part * contact),
        advancing_angle_deg: angles.map(|[_, part]| part * contact),
        friction,
        viscosity_pa_s: maker.maybe(0.2, |maker| maker.between(1e-4, 1e-2)).unwrap_or(1.0016e-3),
        surface_tension_n_per_m: maker.maybe(0.2, |maker| maker.between(0.02, 0.1)).unwrap_or(0.0728),
        smallest_radius_m: maker.maybe(0.3, |maker| maker.between(1e-5, 1e-4)),
        // Fewer than usual: the sites of a small box take longer to lay than its air to move.
        sites_per_m2: maker.between(1e4, 1e6),
    }
}

fn solids(
    maker: &mut Maker<'_>,
    scheme: Scheme,
    size: [f64; 3],
    spacing: f64,
    faces: &[&Face; 6],
    until: f64,
) -> Vec<Solid> {
    let shape = |maker: &mut Maker<'_>| {
        let (a, b) = (maker.between(1.0, 1.6), maker.between(1.0, 2.0));
        match maker.random.below(4) {
            0 => Shape::Box { size_m: [2.0 * a * spacing, 2.0 * b * spacing, 2.0 * a * spacing] },
            1 => Shape::Sphere { radius_m: a * spacing },
            2 => Shape::Cylinder { radius_m: a * spacing, height_m: 2.0 * b * spacing },
            _ => Shape::Revolution {
                profile_m: vec![[0.0, 0.0], [a * spacing, 0.0], [a * spacing, b * spacing], [0.0, b * spacing]],
            },
        }
    };
    let whole = |maker: &mut Maker<'_>, name: &str, shape: Shape, position_m: [f64; 3], outside: Option<Outside>| {
        let held = maker.has(0.5);
        let (watts, density) = (maker.series(0.0, 0.05, until), maker.series(0.0, 50.0, until));
        let by_area = maker.random.chance(0.5);
        let heater = maker.maybe(0.3, |_| Heater {
            power_w: (!by_area).then_some(watts),
            power_w_per_m2: by_area.then_some(density),
        });
        let radiation = maker.maybe(0.3, |maker| Radiation {
            emissivity: maker.between(0.0, 1.0),
            surroundings_c: maker.series(-30.0, 50.0, until),
        });
        let wetting = match scheme {
            Scheme::Physical if maker.has(0.25) => Wetting::Film,
            _ => Wetting::Drops,
        };
        let sites = maker.maybe(0.2, |maker| maker.between(1e4, 1e6));
        Solid {
            name: name.into(),
            shape,
            material: maker.one_of(&[
                Material::Named("glass".into()),
                Material::Own {
                    conductivity_w_per_m_k: 10.0,
                    heat_capacity_j_per_kg_k: 900.0,
                    density_kg_per_m3: 2000.0,
                },
            ]),
            position_m,
            rotation_deg: if outside.is_none() {
                std::array::from_fn(|_| maker.maybe(0.3, |maker| maker.between(-180.0, 180.0)).unwrap_or(0.0))
            } else {
                [0.0; 3]
            },
            temperature_c: if held {
                maker.series(1.0, 40.0, until)
            } else {
                corpuscle_scene::Series::Constant(maker.between(1.0, 40.0))
            },
            held,
            layers: maker.maybe(0.3, |maker| 1 + maker.random.below(3) as u32),
            heater: heater.filter(|_| !held),
            outside: outside.filter(|_| !held),
            radiation: radiation.filter(|_| !held),
            treatment: maker.maybe(0.2, |maker| maker.one_of(&[Treatment::DensityCorrection, Treatment::Ghost])),
            sites_per_m2: sites.filter(|_| wetting == Wetting::Drops),
            wetting,
            face: Vec::new(),
        }
    };
    let mut solids = Vec::new();
    let floor = maker.has(0.5);
    let number = if maker.has(0.5) { 4 } else { maker.random.below(6) };
    let (axis, is_high) = (number / 2, number % 2 == 1);
    let outside = Outside { side: SIDES[number], ..outside(maker, until) };
    let of_pane = |along: usize| if along == axis { spacing } else { size[along] };
    let middle = |along: usize| match along == axis {
        true if is_high => size[along] - 0.5 * spacing,
        true => 0.5 * spacing,
        false => 0.5 * size[along],
    };
    let shape_of_pane = Shape::Box { size_m: std::array::from_fn(of_pane) };
    let mut pane = whole(maker, "pane", shape_of_pane, std::array::from_fn(middle), Some(outside));
    // The side that faces the air.
    pane.face = maker.list(0.5, 1, |_, _| SolidFace { name: "inner".into(), side: SIDES[number ^ 1] });
    if floor && *faces[number] == Face::Wall {
        solids.push(pane);
    }
    let other = maker.has(0.7);
    let shape = shape(maker);
    let body = whole(maker, "body", shape, size.map(|length| 0.55 * length), None);
    if other {
        solids.push(body);
    }
    solids
}

fn outside(maker: &mut Maker<'_>, until: f64) -> Outside {
    let (thickness, resistance) = (maker.between(0.001, 0.05), maker.between(0.01, 1.0));
    let is_gap = maker.random.chance(0.5);
    Outside {
        side: Side::ZMin,
        temperature_c: maker.series(-20.0, 40.0, until),
        h_w_per_m2_k: maker.between(0.0, 30.0),
        emissivity: maker.between(0.0, 1.0),
        surroundings_c: maker.maybe(0.3, |maker| maker.series(-40.0, 40.0, until)),
        layers: maker.list(0.3, 1, |_, _| WallLayer {
            material: (!is_gap).then(|| Material::Named("glass".into())),
            thickness_m: (!is_gap).then_some(thickness),
            resistance_m2_k_per_w: is_gap.then_some(resistance),
        }),
    }
}

//! Scenes of floods.

use super::Maker;
use corpuscle_scene::{
    Adaptive, Block, Bowl, Bump, Circle, ConstantInfiltration, Culvert, Edge, EdgeLine, EdgePart, Edges, Expression,
    Extent, Field, Finer, Flood, FloodUnits, Friction, Gauge, GreenAmpt, Horton, Infiltration, Inflow, KernelName,
    Link, LinkLaw, Manning, Obstacle, Outflow, Plane, Rain, RoughHills, Scheme, Section, Side, SmoothingForm, SphSwe,
    Stage, StartVelocity, Storage, Terrain, TimeSteps, Valley, Water, Wave, Weir, us_name,
};

/// Length and width of the terrain, m.
const SIDE: f64 = 60.0;

/// A flood of some hundred cells or particles.
pub(super) fn scene(maker: &mut Maker<'_>, is_sph_swe: bool) -> String {
    let until = 200.0;
    let terrain = terrain(maker);
    let mut flood = flood(maker, until);
    if is_sph_swe {
        flood = Flood {
            scheme: Scheme::SphSwe,
            spacing_depth_m: Some(maker.between(0.5, 2.0)),
            infiltration: None,
            rain: None,
            finer: Vec::new(),
            adaptive: None,
            storage: Storage::Mean,
            time_steps: TimeSteps::Global,
            edges: plain_edges(maker),
            edge_part: Vec::new(),
            edge_line: Vec::new(),
            outflow: Vec::new(),
            stage: Vec::new(),
            link: Vec::new(),
            obstacle: flood.obstacle.into_iter().filter(|obstacle| obstacle.line.is_none()).collect(),
            ..flood
        };
        let volume = flood.spacing_m.unwrap_or(1.0).powi(2) * flood.spacing_depth_m.unwrap_or(1.0);
        flood.sph_swe.smoothing_length_m = maker.maybe(0.3, |maker| maker.between(1.7, 4.0) * volume.sqrt());
    }
    written(maker, until, &terrain, &flood)
}

/// Closed on all sides, without anything that comes in; half of them at rest.
pub(super) fn lake(maker: &mut Maker<'_>) -> String {
    let until = 200.0;
    let (terrain, made) = (terrain(maker), flood(maker, until));
    let level = maker.between(0.3, 4.0);
    let velocity = maker.maybe(0.5, |maker| [maker.between(-0.5, 0.5), maker.between(-0.5, 0.5)]).unwrap_or_default();
    let water = Water { level_m: Some(level.into()), velocity_m_per_s: velocity.into(), ..Water::default() };
    let wall = || Edge::Wall;
    let flood = Flood {
        adaptive: None,
        infiltration: None,
        rain: None,
        edges: Edges { west: wall(), east: wall(), south: wall(), north: wall() },
        edge_part: Vec::new(),
        edge_line: Vec::new(),
        water: vec![water],
        inflow: Vec::new(),
        outflow: Vec::new(),
        stage: Vec::new(),
        link: Vec::new(),
        ..made
    };
    written(maker, until, &terrain, &flood)
}

/// The text of a scene; in feet its numbers stay, and its keys change.
fn written(maker: &mut Maker<'_>, until: f64, terrain: &Terrain, flood: &Flood) -> String {
    let mut value = toml::Value::try_from(flood).expect("a flood can be written");
    if flood.units == FloodUnits::Us {
        name_in_feet(&mut value);
    }
    super::text(maker, until, &[("terrain", terrain), ("flood", &value)])
}

fn name_in_feet(value: &mut toml::Value) {
    match value {
        toml::Value::Table(table) => {
            for (key, mut value) in std::mem::take(table) {
                name_in_feet(&mut value);
                table.insert(us_name(&key).unwrap_or(key), value);
            }
        }
        toml::Value::Array(items) => items.iter_mut().for_each(name_in_feet),
        _ => {}
    }
}

fn terrain(maker: &mut Maker<'_>) -> Terrain {
    let extent = Extent { length_m: SIDE, width_m: SIDE, cell_m: maker.one_of(&[2.0, 5.0]) };
    let (a, b, c) = (maker.between(-0.05, 0.05), maker.between(-0.05, 0.05), maker.between(0.0, 3.0));
    match maker.random.below(5) {
        0 => Terrain::Valley(Valley {
            extent,
            slope: a.abs(),
            channel_width_m: 10.0,
            channel_depth_m: c,
            plain_width_m: 15.0,
            meander_m: 5.0,
            meander_length_m: 40.0,
            hills_m: c,
        }),
        1 => Terrain::RoughHills(RoughHills { extent, relief_m: c, hill_size_m: 15.0, roughness: 0.5 }),
        2 => Terrain::Plane(Plane { extent, slope_east: a, slope_north: b, height_m: c }),
        3 => Terrain::Bump(Bump { extent, height_m: c, width_m: 12.0, at: maker.maybe(0.5, |maker| position(maker)) }),
        _ => Terrain::Bowl(Bowl { extent, depth_m: c + 0.1, radius_m: 20.0 }),
    }
}

fn position(maker: &mut Maker<'_>) -> [f64; 2] {
    [maker.between(0.05 * SIDE, 0.95 * SIDE), maker.between(0.05 * SIDE, 0.95 * SIDE)]
}

fn line(maker: &mut Maker<'_>) -> Vec<[f64; 2]> {
    let count = 2 + maker.random.below(3);
    (0..count).map(|_| position(maker)).collect()
}

fn polygon(maker: &mut Maker<'_>) -> Vec<[f64; 2]> {
    let [x, y] = [maker.between(5.0, SIDE - 25.0), maker.between(5.0, SIDE - 25.0)];
    let [dx, dy] = [maker.between(3.0, 18.0), maker.between(3.0, 18.0)];
    vec![[x, y], [x + dx, y + 0.1 * dy], [x + 0.9 * dx, y + dy], [x, y + 0.8 * dy]]
}

fn circle(maker: &mut Maker<'_>) -> Circle {
    Circle { centre: position(maker), radius_m: maker.between(2.0, 8.0) }
}

fn rating(maker: &mut Maker<'_>) -> Vec<[f64; 2]> {
    let (from, most) = (maker.between(0.0, 1.0), maker.between(0.0, 5.0));
    vec![[from, 0.0], [from + 0.5, 0.4 * most], [from + 2.0, most]]
}

fn flood(maker: &mut Maker<'_>, until: f64) -> Flood {
    let spacing = maker.one_of(&[3.0, 4.0, 6.0]);
    let obstacle = maker.list(0.3, 3, obstacle);
    Flood {
        scheme: Scheme::Voronoi,
        units: if maker.has(0.1) { FloodUnits::Us } else { FloodUnits::Si },
        spacing_m: Some(spacing),
        spacing_depth_m: maker.maybe(0.3, |maker| maker.between(0.3, 3.0)),
        gravity_m_per_s2: maker.maybe(0.2, |maker| maker.between(0.1, 20.0)).unwrap_or(9.81),
        manning: Manning::Number(maker.maybe(0.5, |maker| maker.between(0.0, 0.2)).unwrap_or(0.03)),
        friction: maker.maybe(0.2, |maker| {
            let (chezy, linear) = (maker.between(1.0, 80.0), maker.between(0.0, 1.0));
            maker.one_of(&[Friction::Chezy(chezy), Friction::Linear(linear)])
        }),
        land_use: None,
        infiltration: maker.maybe(0.3, infiltration),
        rain: maker.maybe(0.3, |maker| Rain { intensity_mm_per_h: maker.series(0.0, 300.0, until), raster: None }),
        finer: finer(maker, spacing, !obstacle.is_empty()),
        adaptive: maker.maybe(0.25, |maker| Adaptive {
            finest_m: spacing * maker.one_of(&[0.5, 0.25]),
            rise_over_depth: maker.between(0.05, 2.0),
            fronts: maker.has(0.5),
            every_steps: 1 + maker.random.below(20) as u32,
        }),
        storage: if maker.has(0.3) { Storage::LevelVolume } else { Storage::Mean },
        time_steps: if maker.has(0.3) { TimeSteps::Local } else { TimeSteps::Global },
        wet_depth_m: maker.between(1e-4, 0.05),
        map_every_s: maker.maybe(0.3, |maker| maker.between(0.1, 10.0)),
        sph_swe: sph_swe(maker),
        edges: edges(maker, until),
        edge_part: maker.list(0.2, 2, |maker, _| {
            let from = maker.between(0.0, 0.6 * SIDE);
            let side = maker.one_of(&[Side::West, Side::East, Side::South, Side::North]);
            EdgePart { side, from, to: from + maker.between(5.0, 20.0), edge: edge(maker, until) }
        }),
        edge_line: maker.list(0.1, 1, |maker, _| EdgeLine { line: line(maker), edge: edge(maker, until) }),
        water: maker.list(0.6, 3, |maker, number| water(maker, number)),
        inflow: maker.list(0.4, 2, |maker, number| {
            let is_line = maker.random.chance(0.5);
            let (at, line) = (position(maker), line(maker));
            Inflow {
                name: format!("inflow {number}"),
                at: (!is_line).then_some(at),
                line: is_line.then_some(line),
                discharge_m3_per_s: maker.series(0.0, 20.0, until),
                velocity_m_per_s: [maker.between(-2.0, 2.0), maker.between(-2.0, 2.0)],
            }
        }),
        outflow: maker.list(0.2, 2, |maker, number| {
            let kind = maker.random.below(3);
            let (at, line, polygon) = (position(maker), line(maker), polygon(maker));
            Outflow {
                name: format!("outflow {number}"),
                at: (kind == 0).then_some(at),
                line: (kind == 1).then_some(line),
                polygon: (kind == 2).then_some(polygon),
                rating: rating(maker),
            }
        }),
        stage: maker.list(0.15, 1, |maker, number| {
            let is_line = maker.random.chance(0.5);
            let (line, polygon) = (line(maker), polygon(maker));
            Stage {
                name: format!("stage {number}"),
                line: is_line.then_some(line),
                polygon: (!is_line).then_some(polygon),
                level_m: maker.series(0.0, 3.0, until),
            }
        }),
        link: maker.list(0.2, 2, link),
        obstacle,
        gauge: maker.list(0.4, 2, |maker, number| Gauge {
            name: format!("gauge {number}"),
            at: Some(position(maker)),
            lon_lat: None,
        }),
        section: maker.list(0.3, 1, |maker, number| Section { name: format!("section {number}"), line: line(maker) }),
        observed_extent: None,
    }
}

fn infiltration(maker: &mut Maker<'_>) -> Infiltration {
    let (a, b, c) = (maker.between(0.0, 100.0), maker.between(0.0, 1.0), maker.between(0.1, 10.0));
    match maker.random.below(3) {
        0 => Infiltration::Constant(ConstantInfiltration { rate_mm_per_h: a }),
        1 => Infiltration::Horton(Horton { first_mm_per_h: a, last_mm_per_h: a * b, decay_per_h: c }),
        _ => Infiltration::GreenAmpt(GreenAmpt { conductivity_mm_per_h: a, suction_m: b, deficit: 0.1 * c.min(9.0) }),
    }
}

fn finer(maker: &mut Maker<'_>, spacing: f64, has_obstacles: bool) -> Vec<Finer> {
    maker.list(0.2, 2, |maker, _| {
        let kind = maker.random.below(4);
        let (polygon, circle, line) = (polygon(maker), circle(maker), line(maker));
        let walls = kind == 3 && has_obstacles;
        Finer {
            spacing_m: spacing * maker.one_of(&[0.5, 0.25]),
            polygon: (kind == 0 || kind == 3 && !walls).then_some(polygon),
            circle: (kind == 1).then_some(circle),
            file: None,
            line: (kind == 2).then_some(line),
            walls,
            within_m: maker.between(1.0, 6.0),
        }
    })
}

fn sph_swe(maker: &mut Maker<'_>) -> SphSwe {
    SphSwe {
        time_step_s: 0.02,
        // By the volume of the particles, once that is known.
        smoothing_length_m: None,
        smoothing: if maker.has(0.3) { SmoothingForm::Rate } else { SmoothingForm::Density },
        kernel: maker.one_of(&[KernelName::Mueller, KernelName::CubicSpline, KernelName::WendlandC2]),
        density_kg_per_m3: 1000.0,
        gas_constant: maker.between(1.0, 10.0),
        viscosity: maker.between(0.0, 0.2),
        radius_m: maker.maybe(0.3, |maker| maker.between(0.1, 3.0)),
        control_force: !maker.has(0.3),
        control_strength: maker.between(0.0, 1.5),
        control_square: maker.between(0.2, 1.0),
        clip_negative_pressure: !maker.has(0.3),
        largest_smoothing: maker.between(1.0, 5.0),
    }
}

fn edge(maker: &mut Maker<'_>, until: f64) -> Edge {
    let kind = maker.random.below(8);
    let (level, velocity) = (maker.series(0.5, 3.0, until), maker.series(-0.5, 0.5, until));
    let (discharge, slope, rating) = (maker.series(0.0, 20.0, until), maker.between(1e-4, 0.05), rating(maker));
    let paddle = maker.between(0.1, 1.0);
    let gives = maker.random.below(3);
    match kind {
        0 => Edge::Open,
        1 => Edge::Wall,
        2 => Edge::Stage(level),
        3 => Edge::Discharge(discharge),
        4 => Edge::Wave(Wave {
            rest_level_m: 1.0,
            level_m: (gives != 0).then_some(level),
            velocity_m_per_s: (gives != 1).then_some(velocity),
        }),
        5 => Edge::NormalDepth(slope),
        6 => Edge::Paddle(corpuscle_scene::Series::Table(vec![[0.0, 0.0], [2.0, paddle], [until, -paddle]])),
        _ => Edge::Rating(rating),
    }
}

fn edges(maker: &mut Maker<'_>, until: f64) -> Edges {
    let periodic = [maker.has(0.1), maker.has(0.1)];
    let mut side = |is_periodic: bool| {
        let made = maker.maybe(0.5, |maker| edge(maker, until)).unwrap_or(Edge::Wall);
        if is_periodic { Edge::Periodic } else { made }
    };
    let [west, east] = [side(periodic[0]), side(periodic[0])];
    let [south, north] = [side(periodic[1]), side(periodic[1])];
    Edges { west, east, south, north }
}

fn plain_edges(maker: &mut Maker<'_>) -> Edges {
    let periodic = [maker.has(0.2), maker.has(0.2)];
    let mut side = |is_periodic: bool| {
        let is_open = maker.has(0.5);
        if is_periodic {
            Edge::Periodic
        } else if is_open {
            Edge::Open
        } else {
            Edge::Wall
        }
    };
    let [west, east] = [side(periodic[0]), side(periodic[0])];
    let [south, north] = [side(periodic[1]), side(periodic[1])];
    Edges { west, east, south, north }
}

fn water(maker: &mut Maker<'_>, number: usize) -> Water {
    let kind = maker.random.below(4);
    let (level, depth) = (maker.between(0.5, 4.0), maker.between(0.1, 2.0));
    let expression =
        Expression::parse("1 + 0.5 * exp(-((x - 30)^2 + (y - 30)^2) / 50)").expect("the expression is valid");
    let polygon = maker.maybe(0.4, polygon);
    let velocity = [maker.between(-2.0, 2.0), maker.between(-2.0, 2.0)];
    let whirl = ["-0.02 * (y - 30)", "0.02 * (x - 30)"]
        .map(|text| Field::Expression(Expression::parse(text).expect("the expression is valid")));
    let is_whirl = maker.has(0.2);
    let velocity = maker.maybe(0.4, |_| StartVelocity::from(velocity)).unwrap_or_default();
    let velocity = if is_whirl { StartVelocity::Components(whirl) } else { velocity };
    let corner = [maker.between(5.0, 40.0), maker.between(5.0, 40.0)];
    let block = Block {
        from: corner,
        to: corner.map(|x| x + 12.0),
        height_m: maker.between(0.5, 5.0),
        layers: 1 + maker.random.below(3),
    };
    let is_block = kind == 3 && number == 2;
    Water {
        level_m: (kind == 0 || kind == 3 && !is_block).then_some(level.into()),
        depth_m: match kind {
            1 => Some(depth.into()),
            2 => Some(Field::Expression(expression)),
            _ => None,
        },
        depth_raster: None,
        polygon: polygon.filter(|_| !is_block),
        block: is_block.then_some(block),
        velocity_m_per_s: velocity,
    }
}

fn link(maker: &mut Maker<'_>, number: usize) -> Link {
    let (diameter, width, height) = (maker.between(0.2, 2.0), maker.between(0.2, 2.0), maker.between(0.2, 2.0));
    let is_round = maker.random.chance(0.5);
    let culvert = Culvert {
        diameter_m: is_round.then_some(diameter),
        width_m: (!is_round).then_some(width),
        height_m: (!is_round).then_some(height),
        length_m: maker.maybe(0.5, |maker| maker.between(5.0, 60.0)),
        floor_m: maker.maybe(0.3, |maker| [maker.between(-1.0, 1.0), maker.between(-1.0, 1.0)]),
        manning: maker.between(0.0, 0.05),
        entrance_loss: maker.between(0.0, 1.0),
        barrels: 1 + maker.random.below(3),
    };
    let weir = Weir {
        crest_m: maker.between(0.0, 2.0),
        width_m: maker.between(0.5, 10.0),
        coefficient: maker.between(0.5, 2.5),
    };
    let law = match maker.random.below(3) {
        0 => LinkLaw::Culvert(culvert),
        1 => LinkLaw::Weir(weir),
        _ => LinkLaw::Rating(rating(maker)),
    };
    // Ends far enough apart for what they take their water from.
    let (y, other) = (maker.between(5.0, 55.0), maker.between(5.0, 55.0));
    Link { name: format!("link {number}"), from: [6.0, y], to: [54.0, other], both_ways: maker.has(0.5), law }
}

fn obstacle(maker: &mut Maker<'_>, number: usize) -> Obstacle {
    let kind = maker.random.below(3);
    let (polygon, circle, line) = (polygon(maker), circle(maker), line(maker));
    let (height, crest) = (maker.between(0.2, 4.0), maker.between(0.0, 3.0));
    let has_crest = kind == 2 && maker.random.chance(0.5);
    let height = maker.maybe(0.5, |_| height);
    Obstacle {
        name: format!("obstacle {number}"),
        polygon: (kind == 0).then_some(polygon),
        circle: (kind == 1).then_some(circle),
        line: (kind == 2).then_some(line),
        file: None,
        height_m: height.filter(|_| !has_crest),
        crest_m: has_crest.then_some(crest),
    }
}

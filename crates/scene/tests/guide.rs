//! The guide's pages on the scene file list every key, no other, and its default.

use corpuscle_scene::dew::{self, Air, AirInflow, Dew, Face, Faces, LowUtility, Material, MeshFile, Shape, Solid};
use corpuscle_scene::*;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use toml::Value;

/// A key: its table as headed in the guide, and its name.
type Key = (String, String);

/// The text of the guide's pages on the scene file, one after another. Each begins with a heading.
fn pages() -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/src");
    let names = ["scene", "scene-terrain", "scene-flood", "scene-gas", "scene-dew"];
    names.map(|name| std::fs::read_to_string(folder.join(format!("{name}.md"))).unwrap()).join("\n")
}

/// The keys in the guide, with their defaults: rows of the tables below headings with a name in ticks.
fn told() -> BTreeMap<Key, String> {
    let in_ticks = |text: &str| text.split('`').nth(1).map(str::to_owned);
    let mut table = None;
    let mut keys = BTreeMap::new();
    for line in pages().lines() {
        if line.starts_with('#') {
            table = in_ticks(line).map(|name| name.trim_matches(['[', ']']).to_owned());
        } else if let (Some(table), true) = (&table, line.starts_with("| `")) {
            let cells: Vec<_> = line.split('|').map(str::trim).collect();
            let default = in_ticks(cells[3]).unwrap_or_else(|| cells[3].to_owned());
            let key = (table.clone(), in_ticks(cells[1]).unwrap());
            assert_eq!(keys.insert(key.clone(), default), None, "{key:?} has two rows");
        }
    }
    keys
}

/// Puts the keys below `value`, a table called `name`, into `keys`, with their values. Rows of a list of tables are alike.
fn collect(name: &str, value: &Value, keys: &mut BTreeMap<Key, Value>) {
    for (key, value) in value.as_table().unwrap() {
        let below = match (name, key.as_str()) {
            ("scene", key) => key.to_owned(),
            (_, "extent") => "extent".to_owned(),
            ("gas.walls", _) => "side".to_owned(),
            ("dew.faces", _) => "face".to_owned(),
            (name, key) => format!("{name}.{key}"),
        };
        match value {
            Value::Table(_) => collect(&below, value, keys),
            Value::Array(rows) if rows.iter().any(Value::is_table) => {
                rows.iter().for_each(|row| collect(&below, row, keys));
            }
            value => _ = keys.insert((name.to_owned(), key.clone()), value.clone()),
        }
    }
}

fn keys_of(scene: &Scene) -> BTreeMap<Key, Value> {
    keys_of_value("scene", &Value::try_from(scene).unwrap())
}

fn keys_of_value(name: &str, value: &Value) -> BTreeMap<Key, Value> {
    let mut keys = BTreeMap::new();
    collect(name, value, &mut keys);
    keys
}

fn all_terrains() -> [Terrain; 8] {
    [
        Terrain::File(TerrainFile { path: "a".into(), crs: Some("EPSG:27700".into()), no_data: NoData::Fill }),
        Terrain::Tiles(TerrainTiles { paths: vec!["a".into()], crs: Some("EPSG:27700".into()), no_data: NoData::Fill }),
        Terrain::Fetch(TerrainFetch { bbox: [0.0; 4], no_data: NoData::Fill }),
        Terrain::Valley(Valley::default()),
        Terrain::RoughHills(RoughHills::default()),
        Terrain::Plane(Plane::default()),
        // Named one by one, so that a new field does not compile until it is named here.
        Terrain::Bump(Bump { extent: Extent::default(), height_m: 1.0, width_m: 1.0, at: Some([0.0; 2]) }),
        Terrain::Bowl(Bowl::default()),
    ]
}

fn full_wave() -> Edge {
    let one = || Some(Series::Constant(1.0));
    Edge::Wave(Wave { rest_level_m: 1.0, level_m: one(), velocity_m_per_s: one() })
}

/// A scene with every key written, whether or not they go together. No field is left to a default.
fn full(terrain: Terrain) -> Scene {
    let block = Block { from: [0.0; 2], to: [1.0; 2], height_m: 1.0, layers: 1 };
    let water = Water {
        level_m: Some(Field::Number(1.0)),
        depth_m: Some(Field::Number(1.0)),
        depth_raster: Some("a".into()),
        polygon: Some(vec![[0.0; 2]]),
        block: None,
        velocity_m_per_s: [0.0; 2].into(),
    };
    let rasters = StartVelocity::Rasters(VelocityRasters { east: "a".into(), north: "a".into() });
    let in_the_air = Water { block: Some(block), velocity_m_per_s: rasters, ..water.clone() };
    let position = Some([0.0; 2]);
    let flood = Flood {
        scheme: Scheme::Voronoi,
        units: FloodUnits::Si,
        spacing_m: Some(1.0),
        spacing_depth_m: Some(1.0),
        sph_swe: SphSwe { smoothing_length_m: Some(1.0), radius_m: Some(1.0), ..SphSwe::default() },
        gravity_m_per_s2: 1.0,
        manning: Manning::Number(0.0),
        friction: None,
        land_use: Some(LandUse {
            raster: "a".into(),
            class: vec![LandClass { code: 1, name: "a".into(), manning: Some(0.1), infiltration: None }],
        }),
        infiltration: None,
        rain: Some(Rain { intensity_mm_per_h: Series::Constant(1.0), raster: Some("a".into()) }),
        wet_depth_m: 1.0,
        map_every_s: Some(1.0),
        edges: Edges::default(),
        // What happens at a side is a word or a table.
        edge_part: vec![
            EdgePart { side: Side::West, from: 0.0, to: 1.0, edge: Edge::Wall },
            EdgePart { side: Side::West, from: 1.0, to: 2.0, edge: full_wave() },
        ],
        edge_line: vec![EdgeLine { line: vec![[0.0; 2]], edge: Edge::Wall }],
        water: vec![water, in_the_air],
        inflow: vec![Inflow {
            name: "a".into(),
            at: position,
            line: Some(vec![[0.0; 2]]),
            discharge_m3_per_s: Series::Constant(1.0),
            velocity_m_per_s: [0.0; 2],
        }],
        outflow: vec![Outflow {
            name: "a".into(),
            at: position,
            line: Some(vec![[0.0; 2]]),
            polygon: Some(vec![[0.0; 2]]),
            rating: vec![[0.0; 2]],
        }],
        stage: vec![Stage {
            name: "a".into(),
            line: Some(vec![[0.0; 2]]),
            polygon: Some(vec![[0.0; 2]]),
            level_m: Series::Constant(1.0),
        }],
        link: full_links(),
        obstacle: vec![Obstacle {
            name: "a".into(),
            polygon: Some(vec![[0.0; 2]]),
            circle: Some(Circle { centre: [0.0; 2], radius_m: 1.0 }),
            line: Some(vec![[0.0; 2]]),
            file: Some("a".into()),
            height_m: Some(1.0),
            crest_m: Some(1.0),
        }],
        storage: Storage::LevelVolume,
        time_steps: TimeSteps::Local,
        finer: vec![Finer {
            spacing_m: 1.0,
            polygon: Some(vec![[0.0; 2]]),
            circle: Some(Circle { centre: [0.0; 2], radius_m: 1.0 }),
            file: Some("a".into()),
            line: Some(vec![[0.0; 2]]),
            walls: true,
            within_m: 1.0,
        }],
        adaptive: Some(Adaptive { finest_m: 1.0, rise_over_depth: 1.0, fronts: true, every_steps: 1 }),
        gauge: vec![Gauge { name: "a".into(), at: position, lon_lat: position }],
        section: vec![Section { name: "a".into(), line: vec![[0.0; 2]] }],
        observed_extent: Some("a".into()),
    };
    let run = Run { until_s: 1.0, frame_every_s: Some(1.0), gauge_every_s: Some(1.0), checkpoint_every_wall_s: 1.0 };
    let model = ModelTables::new(FloodScene { terrain, flood });
    Scene { title: String::new(), description: String::new(), seed: 1, run, model, notes: Vec::new() }
}

/// A link of each kind.
fn full_links() -> Vec<Link> {
    let culvert = Culvert {
        diameter_m: Some(1.0),
        width_m: Some(1.0),
        height_m: Some(1.0),
        length_m: Some(1.0),
        floor_m: Some([0.0; 2]),
        manning: 0.1,
        entrance_loss: 1.0,
        barrels: 1,
    };
    let weir = Weir { crest_m: 1.0, width_m: 1.0, coefficient: 1.0 };
    let laws = [LinkLaw::Culvert(culvert), LinkLaw::Weir(weir), LinkLaw::Rating(vec![[0.0; 2]])];
    let link = |law| Link { name: "a".into(), from: [0.0; 2], to: [0.0; 2], both_ways: true, law };
    laws.into_iter().map(link).collect()
}

/// Floods with each law of infiltration and friction.
fn soils() -> Vec<Scene> {
    let constant = Infiltration::Constant(ConstantInfiltration { rate_mm_per_h: 1.0 });
    let horton = Infiltration::Horton(Horton { first_mm_per_h: 1.0, last_mm_per_h: 1.0, decay_per_h: 1.0 });
    let green_ampt = Infiltration::GreenAmpt(GreenAmpt { conductivity_mm_per_h: 1.0, suction_m: 1.0, deficit: 1.0 });
    let with = |(infiltration, friction)| {
        let mut scene = full(Terrain::Plane(Plane::default()));
        let FloodScene { flood, .. } = scene.model.get_mut().unwrap();
        (flood.infiltration, flood.friction) = (Some(infiltration), Some(friction));
        scene
    };
    let frictions = [Friction::Chezy(1.0), Friction::Linear(1.0), Friction::Linear(1.0)];
    [constant, horton, green_ampt].into_iter().zip(frictions).map(with).collect()
}

/// A gas with every key written, whether or not they go together. No field is left to a default.
fn full_gas(method: Method) -> Scene {
    let both = Some(vec![0.0; 2]);
    let moving = Wall::Moving { velocity: 1.0, until_s: Some(1.0) };
    let walls = Walls {
        x_min: Wall::Thermal { temperature: 1.0 },
        x_max: Wall::Piston { mass: 1.0, pressure: 1.0, velocity: 1.0 },
        y_min: moving,
        y_max: Wall::Motion(Motion::Sinusoid { amplitude: 1.0, period_s: 1.0 }),
        z_min: Some(Wall::Motion(Motion::Displacement(Series::Constant(0.0)))),
        z_max: Some(Wall::Fixed),
    };
    let hole = Some(Hole { from: vec![0.0], to: vec![1.0] });
    let gas = Gas {
        size: vec![1.0; 2],
        units: Units::Si,
        method,
        gravity: both.clone(),
        restitution: 1.0,
        contact_time_s: Some(1.0),
        shear: Some(Shear { rate_per_s: 1.0, temperature: Some(1.0) }),
        well: Some(SquareWell { depth: 1.0, width: 2.0 }),
        reversed_at_s: Some(1.0),
        follow: Some(0),
        walls,
        partition: Some(Partition { axis: Axis::X, at: 0.5, lifted_at_s: Some(1.0), hole }),
        measure: Measure {
            from_s: Some(1.0),
            speed_bins: 1,
            profile_axis: Axis::X,
            profile_bins: 1,
            pair_distance: Some(1.0),
            pair_bins: 1,
            lag_collisions: 1.0,
            region: vec![NamedRegion { name: "a".into(), from: vec![0.0; 2], to: both.clone().unwrap_or_default() }],
        },
        start_file: Some("a".into()),
        ball: vec![Ball {
            name: "a".into(),
            position: vec![0.0; 2],
            velocity: both.clone(),
            radius: 1.0,
            mass: 1.0,
            colour: Some("a".into()),
        }],
        species: vec![Species {
            name: "a".into(),
            count: Some(1),
            packing: Some(1.0),
            radius: 1.0,
            mass: 1.0,
            temperature: 1.0,
            speeds: Speeds::Maxwell,
            velocity: both,
            region: Some(Region { from: vec![0.0; 2], to: vec![1.0; 2] }),
            start: Start::Random,
            colour: Some("a".into()),
        }],
    };
    let run = Run { until_s: 1.0, frame_every_s: Some(1.0), gauge_every_s: Some(1.0), checkpoint_every_wall_s: 1.0 };
    let model = ModelTables::new(gas);
    Scene { title: String::new(), description: String::new(), seed: 1, run, model, notes: Vec::new() }
}

/// A dew scene with every key written, whether or not they go together. No field is left to a default.
fn full_dew() -> Scene {
    let air = Air {
        temperature_c: 1.0,
        relative_humidity: Some(0.5),
        dew_point_c: Some(1.0),
        mixing_ratio: Some(0.5),
        pressure_pa: 1.0,
        velocity_m_per_s: [0.0; 3],
    };
    let inflow = Face::Inflow(AirInflow {
        velocity_m_per_s: [1.0; 3],
        temperature_c: Some(Series::Constant(1.0)),
        relative_humidity: Some(Series::Constant(0.5)),
        dew_point_c: Some(Series::Constant(1.0)),
        mixing_ratio: Some(Series::Constant(0.5)),
    });
    let own = Material::Own { conductivity_w_per_m_k: 1.0, heat_capacity_j_per_kg_k: 1.0, density_kg_per_m3: 1.0 };
    let shapes = [
        Shape::Box { size_m: [1.0; 3] },
        Shape::Sphere { radius_m: 1.0 },
        Shape::Cylinder { radius_m: 1.0, height_m: 1.0 },
        Shape::Revolution { profile_m: vec![[0.0; 2]] },
        Shape::WineGlass(dew::WineGlass::default()),
        Shape::Mesh(MeshFile { path: "a".into(), unit: Some(dew::LengthUnit::Mm) }),
    ];
    let solid = |(at, shape)| Solid {
        name: "a".into(),
        shape,
        material: if at == 0 { Material::default() } else { own.clone() },
        position_m: [0.0; 3],
        rotation_deg: [0.0; 3],
        temperature_c: Series::Constant(1.0),
        held: true,
        layers: Some(1),
        heater: Some(dew::Heater { power_w: Some(Series::Constant(1.0)), power_w_per_m2: Some(Series::Constant(1.0)) }),
        outside: Some(dew::Outside {
            side: dew::Side::XMin,
            temperature_c: Series::Constant(1.0),
            h_w_per_m2_k: 1.0,
            emissivity: 0.5,
            surroundings_c: Some(Series::Constant(1.0)),
            layers: vec![dew::WallLayer {
                material: Some(Material::default()),
                thickness_m: Some(1.0),
                resistance_m2_k_per_w: Some(1.0),
            }],
        }),
        radiation: Some(dew::Radiation { emissivity: 0.5, surroundings_c: Series::Constant(1.0) }),
        treatment: Some(dew::Treatment::VirtualForce),
        sites_per_m2: Some(1.0),
        wetting: dew::Wetting::Film,
        face: vec![dew::SolidFace { name: "a".into(), side: dew::Side::XMax }],
    };
    let dew = Dew {
        size_m: [1.0; 3],
        spacing_m: 1.0,
        scheme: dew::Scheme::ParticleCondensation,
        kernel: KernelName::WendlandC2,
        gravity_m_per_s2: [0.0; 3],
        buoyancy: true,
        time_factor: 1.0,
        air,
        faces: Faces { x_min: inflow, ..Faces::default() },
        fan: vec![dew::Fan { position_m: [1.0; 3], size_m: [1.0; 3], velocity_m_per_s: [1.0; 3] }],
        boundary: dew::Boundary { treatment: dew::Treatment::Ghost, colour_threshold: 1.0, kappa: 1.0 },
        transport: dew::Transport {
            conductivity_mean: Some(dew::Mean::Harmonic),
            humidity: Some(dew::HumidityTransport::MassFraction),
            latent_heat: Some(true),
            vapour_diffusivity_m2_per_s: Some(1.0),
            air_conductivity_w_per_m_k: Some(1.0),
            air_heat_capacity_j_per_kg_k: Some(1.0),
            air_viscosity_pa_s: Some(1.0),
        },
        drops: dew::Drops {
            contact_angle_deg: 1.0,
            receding_angle_deg: Some(1.0),
            advancing_angle_deg: Some(1.0),
            friction: Some(1.0),
            viscosity_pa_s: 1.0,
            surface_tension_n_per_m: 1.0,
            smallest_radius_m: Some(1.0),
            sites_per_m2: 1.0,
        },
        low_utility: Some(LowUtility { distance: 1.0, after_s: 1.0 }),
        output: dew::Output { air: true, solids: true },
        solid: shapes.into_iter().enumerate().map(solid).collect(),
    };
    let run = Run { until_s: 1.0, frame_every_s: Some(1.0), gauge_every_s: Some(1.0), checkpoint_every_wall_s: 1.0 };
    let model = ModelTables::new(dew);
    Scene { title: String::new(), description: String::new(), seed: 1, run, model, notes: Vec::new() }
}

#[test]
fn the_guide_tells_every_key_and_no_other() {
    let floods = all_terrains().map(full);
    let gases = [Method::EventDriven, Method::FixedStep { time_step_s: 1.0 }].map(full_gas);
    let dew = [full_dew()];
    let soils = soils();
    let scenes = floods.iter().chain(&soils).chain(&gases).chain(&dew);
    let mut known: BTreeSet<Key> = scenes.flat_map(|scene| keys_of(scene).into_keys()).collect();
    // A side is one of several tables, or a word.
    let fixed = Walls { z_min: Some(Wall::Fixed), z_max: Some(Wall::Fixed), ..Walls::default() };
    known.extend(keys_of_value("gas.walls", &Value::try_from(fixed).unwrap()).into_keys());
    // A face is a word or a table.
    known.extend(keys_of_value("dew.faces", &Value::try_from(Faces::default()).unwrap()).into_keys());
    let mut told: BTreeSet<Key> = told().into_keys().collect();
    // Its value is the table that follows.
    assert!(told.remove(&("flood.water".into(), "block".into())));
    let missing: Vec<_> = known.difference(&told).collect();
    let unknown: Vec<_> = told.difference(&known).collect();
    assert!(missing.is_empty() && unknown.is_empty(), "not told: {missing:?}\ntold but not known: {unknown:?}");
}

#[test]
fn the_guide_tells_the_defaults() {
    let told = told();
    let mut compared = 0;
    let files = ["file = { path = \"a\" }", "tiles = { paths = [\"a\"] }", "fetch = { bbox = [0, 0, 1, 1] }"];
    for kind in files.into_iter().chain(["valley = {}", "rough-hills = {}", "plane = {}", "bump = {}", "bowl = {}"]) {
        let text = format!("run.until_s = 1\nflood = {{ water = [{{ level_m = 1 }}] }}\nterrain.{kind}");
        let scene = Scene::parse(&text, "smallest", &[]).unwrap();
        compared += compare_defaults(&scene, &told);
    }
    let rain = "run.until_s = 1\nterrain.plane = {}\n[flood]\nrain.intensity_mm_per_h = 1\nlink = [{ name = \"a\", from = [0, \
                0], to = [9, 9], law = { culvert = { diameter_m = 1 } } }, { name = \"b\", from = [0, 0], to = [9, 9], law = \
                { weir = { crest_m = 1, width_m = 1 } } }]\nland_use = { raster = \"a\", class = [{ code = 1 }] }";
    compared += compare_defaults(&Scene::parse(rain, "smallest", &[]).unwrap(), &told);
    let finer = "run.until_s = 1\nterrain.plane = {}\n[flood]\nscheme = \"voronoi\"\nfiner = [{ spacing_m = 3, polygon = [[0, 0], [9, 0], [9, 9]] }]\nadaptive = { finest_m = 3 }";
    compared += compare_defaults(&Scene::parse(finer, "smallest", &[]).unwrap(), &told);
    let gas = "run.until_s = 1\ngas = { size = [9, 9], ball = [{ position = [2, 2], radius = 1, mass = 1 }], species = [\
               { name = \"a\", count = 1, radius = 1, mass = 1, temperature = 1 }], walls = { x_max = { piston = { \
               mass = 1, pressure = 1 } } } }";
    compared += compare_defaults(&Scene::parse(gas, "smallest", &[]).unwrap(), &told);
    let dew = "run.until_s = 1\n[dew]\nsize_m = [1, 1, 1]\nspacing_m = 0.1\nlow_utility = {}\nair = { temperature_c = 20, \
               relative_humidity = 0.5 }\nsolid = [{ name = \"a\", temperature_c = 5, shape = { wine-glass = {} } }]";
    compared += compare_defaults(&Scene::parse(dew, "smallest", &[]).unwrap(), &told);
    assert!(compared > 90, "{compared}");
}

/// Compares the values of keys that the scene does not give with what is told; gives their number.
fn compare_defaults(scene: &Scene, told: &BTreeMap<Key, String>) -> usize {
    let given = [
        "level_m",
        "water",
        "inflow",
        "outflow",
        "stage",
        "link",
        "obstacle",
        "diameter_m",
        "gauge",
        "section",
        "edge_part",
        "edge_line",
        "finer",
        "polygon",
        "scheme",
        "count",
        "relative_humidity",
    ];
    let is_default = |key: &Key| !given.contains(&key.1.as_str()) && told[key] != "required";
    let mut compared = 0;
    for (key, default) in keys_of(scene).into_iter().filter(|(key, _)| is_default(key)) {
        assert_eq!(told[&key], default.to_string(), "{key:?}");
        compared += 1;
    }
    compared
}

#[test]
fn the_guide_tells_the_forms_of_values() {
    let text = pages();
    let forms = [
        "{ raster = ",
        "{ chezy = ",
        "{ culvert = ",
        "{ weir = ",
        "{ rating = ",
        "green-ampt = ",
        "{ csv = ",
        "factor = ",
        "\"us\"",
        "{ stage = ",
        "{ thermal = ",
        "{ piston = ",
        "{ moving = ",
        "{ motion = ",
        "\"si\"",
        "{ inflow = ",
        "{ mesh = ",
        "\"density-correction\"",
        "\"virtual-force\"",
        "\"ghost\"",
        "\"harmonic\"",
        "\"relative-humidity\"",
        "\"mm\"",
        "\"list\"",
        "\"lattice\"",
        "\"open\"",
        "\"wall\"",
        "\"periodic\"",
        "\"fill\"",
        "\"sph-swe\"",
    ];
    for form in forms {
        assert!(text.contains(form), "{form}");
    }
}

/// A block of TOML that says when the run ends is a whole scene.
#[test]
fn whole_scenes_in_the_guide_are_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/src");
    let mut read = 0;
    for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if path.extension().is_none_or(|ending| ending != "md") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let blocks = text.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next());
        for block in blocks.filter(|block| block.contains("until_s")) {
            let scene = Scene::parse(block, "scene", &[]);
            assert!(scene.is_ok(), "{}: {}", path.display(), scene.unwrap_err());
            read += 1;
        }
    }
    assert!(read >= 5, "{read}");
}

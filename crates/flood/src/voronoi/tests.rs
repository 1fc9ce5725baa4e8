//! What the passes do together, on small pieces of ground.

use super::State;
use super::boundaries::Now;
use super::domain::Counts;
use super::friction::Slowing;
use super::mesh::{Ground, Layout, Mesh, SOLID};
use super::solver::{BorderFlux, Solver};
use super::water::{Column, Water};
use crate::VoronoiFlood;
use crate::friction::Law;
use corpuscle_model::Model;
use corpuscle_scene::Scene;
use corpuscle_terrain::{Bounds, Terrain};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

const G: f64 = 9.81;

/// Ground from a function, its mean from points all over the cell.
struct Function<F: Fn(f64, f64) -> f64 + Sync>(F, [f64; 2]);

impl<F: Fn(f64, f64) -> f64 + Sync> Ground for Function<F> {
    fn mean(&self, polygon: &[[f64; 2]]) -> f64 {
        let centre = [0, 1].map(|axis| polygon.iter().map(|r| r[axis]).sum::<f64>() / polygon.len() as f64);
        let (mut sum, mut area) = (0.0, 0.0);
        for k in 0..polygon.len() {
            let [a, b] = [polygon[k], polygon[(k + 1) % polygon.len()]];
            let part = (a[0] - centre[0]) * (b[1] - centre[1]) - (b[0] - centre[0]) * (a[1] - centre[1]);
            let middles = [[a, b], [b, centre], [centre, a]];
            let mean =
                middles.map(|[p, q]| (self.0)(0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]))).iter().sum::<f64>() / 3.0;
            (sum, area) = (sum + part * mean, area + part);
        }
        sum / area
    }

    fn is_there(&self, _: [f64; 2]) -> bool {
        true
    }

    fn mirrors(&self, border: u8) -> bool {
        border <= SOLID
    }

    fn lift(&self) -> [f64; 2] {
        self.1
    }
}

fn solver(size: [f64; 2], periodic: [bool; 2], spacing: f64, seed: u64, manning: f64, ground: &impl Ground) -> Solver {
    let bounds = Bounds { x_min: 0.0, x_max: size[0], y_min: 0.0, y_max: size[1] };
    let mut mesh = Mesh::new(Layout::new(bounds, periodic, spacing, seed));
    let tiles: Vec<usize> = (0..mesh.layout.tiles[0] * mesh.layout.tiles[1]).collect();
    mesh.make(&tiles, ground);
    Solver::new(mesh, G, Slowing::even(Law::Manning, G * manning * manning), 10.0, [false; 6])
}

impl Solver {
    fn fill(&mut self, column: impl Fn(f64, [f64; 2], f64, usize) -> Column) {
        for cell in 0..self.mesh.len() {
            self.columns[cell] = column(self.mesh.area[cell], self.mesh.centroid[cell], self.mesh.bed[cell], cell);
        }
    }

    fn run(&mut self, until: f64) -> usize {
        let mut time = 0.0;
        let mut step = 0.1 * self.update_water();
        let mut steps = 0;
        while time < until {
            let taken = step.min(until - time);
            self.step(taken, &|_, _| Now::Wall, &mut |_, _: BorderFlux| (), &mut |_, _| ());
            step = self.plan();
            time += taken;
            steps += 1;
        }
        steps
    }

    fn volume(&self) -> f64 {
        self.columns.iter().map(|column| column.volume).sum()
    }

    fn rms(&self) -> f64 {
        let kinetic: f64 = self.columns.iter().map(Column::kinetic).sum();
        (2.0 * kinetic / self.volume()).sqrt()
    }
}

fn random(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

/// Blocks of 6 m at heights of 0 to 3 m; a lake at 1.5 m, stirred by 1e-6 m/s.
#[test]
fn a_lake_on_blocks_stays_at_rest() {
    let mut heights = random(7);
    let heights: Vec<f64> = (0..100).map(|_| heights.random_range(0.0..3.0)).collect();
    let block =
        move |x: f64, y: f64| heights[(y.rem_euclid(60.0) / 6.0) as usize * 10 + (x.rem_euclid(60.0) / 6.0) as usize];
    for (seed, periodic) in [(1, true), (2, false)] {
        let ground = Function(&block, [0.0; 2]);
        let mut solver = solver([60.0; 2], [periodic; 2], 1.5, seed, 0.0, &ground);
        let mut stir = random(seed);
        let stirred: Vec<[f64; 2]> =
            (0..solver.mesh.len()).map(|_| [(); 2].map(|()| stir.random_range(-1e-6..1e-6))).collect();
        solver.fill(|area, _, bed, cell| {
            let volume = area * (1.5 - bed).max(0.0);
            Column { volume, momentum: stirred[cell].map(|u| u * volume) }
        });
        let before = solver.volume();
        solver.run(30.0);
        assert!(solver.rms() < 1e-6, "{}", solver.rms());
        assert!((solver.volume() / before - 1.0).abs() < 1e-13);
    }
}

/// Momentum of water that splashes in a flat periodic box.
#[test]
fn momentum_is_kept_on_flat_ground() {
    let ground = Function(|_, _| 1.0, [0.0; 2]);
    let mut solver = solver([40.0; 2], [true; 2], 1.0, 5, 0.0, &ground);
    solver.fill(|area, [x, y], _, _| {
        let depth = 2.0 + 0.4 * (x * 0.05 * std::f64::consts::PI).sin() * (y * 0.05 * std::f64::consts::PI).cos();
        Column { volume: area * depth, momentum: [0.7 * area * depth, -0.3 * area] }
    });
    let sum = |solver: &Solver, axis: usize| solver.columns.iter().map(|column| column.momentum[axis]).sum::<f64>();
    let before = [0, 1].map(|axis| sum(&solver, axis));
    solver.run(10.0);
    for (axis, before) in before.into_iter().enumerate() {
        let drift = sum(&solver, axis) / before - 1.0;
        assert!(drift.abs() < 1e-12, "{drift}");
    }
}

/// Sheets on slopes, 20 % noise: Manning's velocity.
#[test]
fn sheets_run_at_the_velocity_of_normal_flow() {
    for slope in [0.05, 0.3] {
        let ground = Function(move |x: f64, _| -slope * x, [-slope * 60.0, 0.0]);
        let mut solver = solver([60.0, 24.0], [true; 2], 2.0, 4, 0.03, &ground);
        let mut noise = random(3);
        let noise: Vec<f64> = (0..solver.mesh.len()).map(|_| noise.random_range(-0.2..0.2)).collect();
        solver.fill(|area, _, _, cell| Column { volume: area * 0.02 * (1.0 + noise[cell]), momentum: [0.0; 2] });
        solver.run(60.0);
        let momentum: f64 = solver.columns.iter().map(|column| column.momentum[0]).sum();
        let normal = 0.02_f64.powf(2.0 / 3.0) * f64::sqrt(slope) / 0.03;
        let off = momentum / solver.volume() / normal - 1.0;
        assert!(off.abs() < 0.01, "{off}");
        assert!(solver.water.iter().all(|water| water.depth > 0.005));
    }
}

/// The second stage may be sound again: a lost number would empty its cell unseen.
#[test]
fn a_first_stage_that_comes_to_no_number_is_told() {
    let mut solver = solver([20.0, 10.0], [false; 2], 1.0, 1, 0.0, &Function(|_, _| 0.0, [0.0; 2]));
    solver.fill(|area, _, _, _| Column { volume: area, momentum: [0.0; 2] });
    let step = 0.1 * solver.update_water();
    let now = |stage: usize, _| if stage == 0 { Now::Discharge(f64::NAN) } else { Now::Wall };
    solver.step(step, &now, &mut |_, _: BorderFlux| (), &mut |_, _| ());
    assert!(solver.is_broken() && solver.broken_cell().is_some());
    solver.take_back();
    assert!(!solver.is_broken() && solver.columns.iter().all(|column| column.volume > 0.0));
}

/// A flood by scheme voronoi.
fn flood(scene: &str, seed: u64) -> VoronoiFlood {
    let mut scene = Scene::parse(scene, "scene", &[]).unwrap();
    scene.resolve_defaults();
    let scene = scene.flood().unwrap();
    let terrain = Terrain::open(&scene.terrain, seed, Path::new("")).unwrap();
    VoronoiFlood::new(&scene.flood, seed, Path::new(""), Arc::new(terrain)).unwrap()
}

/// Obstacles across regions where cells grow: a whole cell may be smaller there than a piece of a larger one that is joined to it.
#[test]
fn cells_close_where_walls_cut_cells_of_several_sizes() {
    for seed in (0..20).chain([142_053]) {
        let scene = r#"
            run.until_s = 1
            terrain.plane = { extent = { length_m = 60, width_m = 60, cell_m = 2 }, height_m = 1.914, slope_east = 0.003849, slope_north = 0.03095 }
            [flood]
            spacing_m = 3
            wet_depth_m = 0.0465
            edges = { west = "wall", east = "wall", south = "wall", north = "wall" }
            water = [{ level_m = 2.76 }]
            finer = [{ line = [[35.6, 28.47], [4.687, 33.02], [43.58, 45.4]], spacing_m = 1.5, within_m = 3.672 }]
            [[flood.obstacle]]
            name = "house"
            polygon = [[32, 23.69], [37.044, 25.432], [36.5396, 41.11], [32, 37.626]]
            "#;
        let flood = flood(scene, seed);
        let mesh = &flood.solver.mesh;
        let mut sums = vec![[0.0; 2]; mesh.len()];
        for face in &mesh.faces {
            let mut add = |cell: u32, sign: f64| {
                let sum = &mut sums[cell as usize];
                *sum = [0, 1].map(|axis| sum[axis] + sign * face.normal[axis]);
            };
            add(face.cells[0], 1.0);
            if face.border().is_none() {
                add(face.cells[1], -1.0);
            }
        }
        let most = sums.iter().map(|sum| sum[0].hypot(sum[1])).fold(0.0, f64::max);
        assert!(most < 1e-10, "seed {seed}: {most} m");
    }
}

/// The ground beside a part of the wall stands higher than its crest and than the lake.
#[test]
fn a_lake_beside_a_wall_below_the_ground_stays_at_rest() {
    for storage in ["mean", "level-volume"] {
        let scene = format!(
            r#"
            run.until_s = 1
            terrain.rough-hills = {{ extent = {{ length_m = 60, width_m = 60, cell_m = 2 }}, hill_size_m = 15, relief_m = 2.771, roughness = 0.5 }}
            [flood]
            spacing_m = 6
            storage = "{storage}"
            edges = {{ west = "wall", east = "wall", south = "wall", north = "wall" }}
            water = [{{ level_m = 2.173 }}]
            obstacle = [{{ name = "dyke", line = [[42.51, 16.13], [34.94, 29.8], [4.979, 28.04]], crest_m = 0.07 }}]
            "#
        );
        for seed in [93_849, 1, 2, 3] {
            let mut flood = flood(&scene, seed);
            flood.advance_to(1.0, &AtomicBool::new(false)).unwrap();
            let fastest = flood.solver.water.iter().map(Water::speed).fold(0.0, f64::max);
            assert!(fastest < 1e-12, "{storage}, seed {seed}: {fastest} m/s");
        }
    }
}

/// A hump of water runs out over hills in the rain, over films too thin to carry what momentum it brings.
#[test]
fn momentum_that_films_cannot_carry_is_in_the_ledger() {
    let scene = r#"
        run.until_s = 60
        terrain.rough-hills = { extent = { length_m = 60, width_m = 60, cell_m = 5 }, hill_size_m = 15, relief_m = 2.3, roughness = 0.5 }
        [flood]
        spacing_m = 6
        friction.chezy = 61.8
        rain.intensity_mm_per_h = 131
        edges = { west = "open", east = "wall", south = "wall", north = { normal_depth = 0.0425 } }
        water = [{ depth_m = 0.7 }, { depth_m = "1 + 0.5 * exp(-((x - 30)^2 + (y - 30)^2) / 50)" }]
        "#;
    for seed in [1, 2, 3] {
        let mut flood = flood(scene, seed);
        flood.advance_to(45.0, &AtomicBool::new(false)).unwrap();
        let ledger = flood.ledger();
        let momentum = ledger.balances.iter().find(|balance| balance.quantity == "momentum").unwrap();
        assert!(momentum.relative_error().abs() < 1e-9, "seed {seed}: {momentum:?}");
    }
}

/// A line with a crest that crosses itself encloses a triangle of one cell; the water that comes in over the crest comes to rest there.
#[test]
fn water_in_a_cell_that_walls_enclose_comes_to_rest() {
    let scene = r#"
        run.until_s = 60
        terrain.valley = { extent = { length_m = 60, width_m = 60, cell_m = 5 }, channel_depth_m = 0.49, channel_width_m = 10, hills_m = 0.49, meander_length_m = 40, meander_m = 5, plain_width_m = 15, slope = 0.0392 }
        [flood]
        spacing_m = 3
        manning = 0.03
        water = [{ depth_m = 1 }]
        obstacle = [{ name = "fold", crest_m = 1.05, line = [[20.8, 54.3], [21.2, 21.8], [18.3, 27.1], [33.3, 11.6]] }]
        "#;
    for seed in [1, 2, 3] {
        let mut flood = flood(scene, seed);
        flood.advance_to(8.0, &AtomicBool::new(false)).unwrap();
        let fastest = flood.solver.water.iter().map(Water::speed).fold(0.0, f64::max);
        assert!(fastest < 4.0, "seed {seed}: {fastest} m/s");
    }
}

/// Rain has left a film on ground below the level that a part of the side holds.
#[test]
fn a_held_level_floods_land_with_a_film_on_it() {
    let scene = r#"
        run.until_s = 10
        terrain.bowl = { extent = { length_m = 60, width_m = 60, cell_m = 5 }, depth_m = 1.5, radius_m = 20 }
        [flood]
        spacing_m = 6
        friction.linear = 0.66
        rain.intensity_mm_per_h = 32
        edges = { west = "wall", east = "wall", south = "wall", north = "wall" }
        edge_part = [{ side = "north", from = 25, to = 39.5, edge = { stage = [[0, 0], [5, 0], [5.01, 2.5]] } }]
        "#;
    for seed in [1, 2, 3] {
        let mut flood = flood(scene, seed);
        flood.advance_to(10.0, &AtomicBool::new(false)).unwrap();
        let fastest = flood.solver.water.iter().map(Water::speed).fold(0.0, f64::max);
        assert!(fastest < 10.0, "seed {seed}: {fastest} m/s");
        let ledger = flood.ledger();
        let rained = 32e-3 / 3600.0 * 10.0 * 60.0 * 60.0;
        assert!(ledger.balances[0].now > 10.0 * rained, "seed {seed}: {:?}", ledger.balances[0]);
        let errors = ledger.balances.iter().map(|balance| balance.relative_error().abs());
        assert!(errors.fold(0.0, f64::max) < 1e-6, "seed {seed}: {:?}", ledger.balances);
    }
}

/// A state with a value that no computation gives is refused before anything is looked at.
#[test]
fn forged_states_with_values_that_are_no_numbers_are_refused() {
    let scene = "run.until_s = 10\nterrain.plane.extent = { length_m = 60, width_m = 60, cell_m = 5 }\n[flood]\n\
                 spacing_m = 3\nwater = [{ depth_m = 1, polygon = [[0, 0], [20, 0], [20, 20], [0, 20]] }]";
    let mut flood = flood(scene, 1);
    let saved = flood.save();
    let forged: [fn(&mut State); 6] = [
        |state| state.records[3].max_depth = f32::NAN,
        |state| state.columns[0][3].volume = f64::NAN,
        |state| state.columns[1][3].momentum[1] = f64::INFINITY,
        |state| state.columns[0][5].volume = 1e200,
        |state| state.time_step = f64::NAN,
        |state| state.beyond[0] = f64::NAN,
    ];
    for (number, forge) in forged.into_iter().enumerate() {
        let (shown, mut state): (f64, State) = postcard::from_bytes(&saved).unwrap();
        forge(&mut state);
        let error = flood.restore(&postcard::to_stdvec(&(shown, state)).unwrap()).unwrap_err();
        assert!(error.to_string().contains("not a number"), "{number}: {error}");
    }
    flood.restore(&saved).unwrap();
}

/// A state that lists all tiles of the ground, or one of them twice, with next to no cells.
#[test]
fn forged_states_are_refused_before_their_cells_are_made() {
    let scene = "run.until_s = 10\nterrain.plane.extent = { length_m = 3000, width_m = 3000, cell_m = 50 }\n[flood]\n\
                 scheme = \"voronoi\"\nspacing_m = 2\nwater = [{ depth_m = 1, polygon = [[0, 0], [20, 0], [20, 20], [0, 20]] }]";
    let mut flood = flood(scene, 1);
    let (made, saved) = (flood.solver.mesh.len(), flood.save());
    let tiles = flood.solver.mesh.layout.tiles;
    let none = Counts { cells: 0, borders: 0 };
    type Forge<'a> = &'a dyn Fn(&mut State);
    let forged: [(&str, Forge<'_>); 5] = [
        ("all tiles, without counts", &|state| state.tiles = (0..(tiles[0] * tiles[1]) as u32).collect()),
        ("all tiles, of no cells", &|state| {
            let others = (0..(tiles[0] * tiles[1]) as u32).filter(|tile| !state.tiles.contains(tile));
            let others: Vec<u32> = others.collect();
            state.tiles.extend(others);
            state.counts.resize(state.tiles.len(), none);
        }),
        ("a tile twice", &|state| {
            state.tiles.push(state.tiles[0]);
            state.counts.push(none);
        }),
        ("a tile that there is not", &|state| {
            state.tiles.push(u32::MAX);
            state.counts.push(none);
        }),
        ("infiltration of one cell", &|state| state.soaked.depth = vec![0.0]),
    ];
    for (what, forge) in forged {
        let (shown, mut state): (f64, State) = postcard::from_bytes(&saved).unwrap();
        forge(&mut state);
        let error = flood.restore(&postcard::to_stdvec(&(shown, state)).unwrap()).unwrap_err();
        assert!(error.to_string().contains("another scene"), "{what}: {error}");
        assert!(flood.solver.mesh.len() < made + 20_000, "{what}: {} cells", flood.solver.mesh.len());
    }
}

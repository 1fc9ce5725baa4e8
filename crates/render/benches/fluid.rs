//! What a frame of water costs, pass by pass: `cargo bench -p corpuscle-render --bench fluid`.
//!
//! A square of rippled water, 1 m from particle to particle's neighbour and 1 m deep, seen from above at an angle so that it just
//! fits. Each row is the best of [`ROUNDS`] pictures after one to warm up, one sample a pixel; each pass is timed from the start of
//! its encoding to its end on the device.

use corpuscle_gpu::Gpu;
use corpuscle_render::{
    Camera, Drawable, Droplet, FluidPainter, FluidPass, FluidStyle, Light, Renderer, Stage, Target,
};
use std::time::Duration;

const ROUNDS: usize = 3;
const PARTICLES: [usize; 3] = [12_000, 60_000, 1_000_000];
const SIZES: [[u32; 2]; 2] = [[1280, 720], [1920, 1080]];

fn main() {
    let gpu = match Gpu::open() {
        Ok(gpu) => gpu,
        Err(error) => return eprintln!("{error}"),
    };
    println!("on {}\n", gpu.name);
    let names: String = FluidPass::ALL.iter().map(|pass| format!(" {:>10} |", format!("{pass:?}"))).collect();
    println!("| particles |      pixels | frame, ms |{names}");
    println!("|---|---|---|{}", "---|".repeat(FluidPass::ALL.len()));
    for particles in PARTICLES {
        for size in SIZES {
            row(&gpu, particles, size);
        }
    }
}

fn row(gpu: &Gpu, particles: usize, size: [u32; 2]) {
    let side = (particles as f64).sqrt();
    let stage = Stage::new([0.0, 0.0, -1.0], [side, side, 1.0]);
    let renderer = Renderer::new(gpu);
    let camera = Camera::orbit(&stage, [-1.2, 0.7], 0.6, f64::from(size[0]) / f64::from(size[1]), 0.0);
    let target = Target::new(gpu, size, 1).expect("within every device's limits");
    let mut fluid = FluidPainter::new(&renderer).fluid(gpu, &stage, FluidStyle::water(0.5)).unwrap();
    fluid.fill(gpu, (0..particles).map(|index| droplet(index, side as usize)));
    fluid.measure();
    let mut best: Option<Vec<(FluidPass, Duration)>> = None;
    let whole = |times: &[(FluidPass, Duration)]| times.iter().map(|(_, time)| *time).sum::<Duration>();
    for _ in 0..=ROUNDS {
        renderer.draw(&target, &stage, &camera, &Light::day(), &mut [&mut fluid as &mut dyn Drawable], None);
        let times = fluid.times();
        if best.as_ref().is_none_or(|best| whole(times) < whole(best)) {
            best = Some(times.to_vec());
        }
    }
    let best = best.unwrap_or_default();
    let total = whole(&best).as_secs_f64();
    let shares: String =
        best.iter().map(|(_, time)| format!(" {:>8.0} % |", 100.0 * time.as_secs_f64() / total)).collect();
    println!("| {particles:>9} | {:>4} x {:>4} | {:>9.1} |{shares}", size[0], size[1], 1e3 * total);
}

fn droplet(index: usize, side: usize) -> Droplet {
    let (x, y) = ((index % side) as f64, (index / side) as f64);
    let slope = 0.06 * (0.3 * x).cos();
    Droplet {
        position: [x, y, 0.2 * (0.3 * x).sin()],
        radius: 1.4,
        normal: [-slope, 0.0, 1.0],
        flatness: 0.12,
        volume: 1.0,
        reach: 2.0,
        foam: 0.0,
        flow: [1.0, 0.5],
        id: index as u64,
    }
}

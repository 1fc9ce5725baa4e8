//! Scratch.
use super::*;
#[doc(hidden)]
pub fn island() {
    let bounds = Bounds { x_min: 0.0, x_max: 100.0, y_min: 0.0, y_max: 100.0 };
    let terrain = Arc::new(Terrain::analytic(bounds, 1.0, |x, y| {
        let (dx, dy, width) = (x - 50.0, y - 50.0, 10.0);
        let height = 5.0 * (-0.5 * (dx * dx + dy * dy) / (width * width)).exp();
        (height, [-dx, -dy].map(|d| d / (width * width) * height))
    }));
    let walls = Edges { west: Edge::Wall, east: Edge::Wall, south: Edge::Wall, north: Edge::Wall };
    let scene = scene(60.0, 1.0, 6.0, walls);
    let ground = Arc::clone(&terrain);
    let water = water_everywhere(bounds, move |x, y| 4.0 - ground.height(x, y), |_, _| [0.0; 2]);
    let mut flood = Flood::with_water(&scene, Path::new("."), terrain, &[water]).unwrap();
    for k in 0..16 {
        let mut p: Vec<_> = flood.particles().iter().map(|p| (p.speed() + p.ax.hypot(p.ay), (p.next_h - p.h) / p.h, p.h, p.depth, p.surface() - 4.0, p.x, p.y, p.id)).collect();
        p.sort_by(|a, b| b.0.total_cmp(&a.0));
        println!("{k} n {}", p.len());
        for q in &p[..4] { println!("  speed+a {:.2e} dh/h {:.2e} h {:.3} depth {:.4} s-4 {:.2e} at {:.2} {:.2} id {}", q.0, q.1, q.2, q.3, q.4, q.5, q.6, q.7); }
        let t = flood.time() + 2.5;
        flood.advance_to(t, &AtomicBool::new(false)).unwrap();
    }
}

//! Scratch.
use corpuscle_flood::{balanced::*, edges::*, particle::*, seeding::*};
use corpuscle_terrain::{Bounds, Terrain};
use std::time::Instant;

fn stoker(xs: f64, hl: f64, hr: f64, t: f64, g: f64) -> (f64, f64) {
    // depth, velocity at xs from the dam
    let c0 = (g * hl).sqrt();
    if hr == 0.0 {
        let s = xs / t;
        if s < -c0 { return (hl, 0.0) }
        if s > 2.0 * c0 { return (0.0, 0.0) }
        return ((2.0 * c0 - s).powi(2) / (9.0 * g), 2.0 / 3.0 * (c0 + s));
    }
    let (mut a, mut b) = (hr, hl);
    for _ in 0..200 {
        let m = 0.5 * (a + b);
        let u2 = 2.0 * (c0 - (g * m).sqrt());
        let ub = (m - hr) * (0.5 * g * (m + hr) / (m * hr)).sqrt();
        if u2 > ub { a = m } else { b = m }
    }
    let hm = 0.5 * (a + b);
    let u = 2.0 * (c0 - (g * hm).sqrt());
    let shock = u * hm / (hm - hr);
    let s = xs / t;
    if s < -c0 { (hl, 0.0) } else if s < u - (g * hm).sqrt() { ((2.0 * c0 - s).powi(2) / (9.0 * g), 2.0 / 3.0 * (c0 + s)) } else if s < shock { (hm, u) } else { (hr, 0.0) }
}

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let dx: f64 = args[1].parse().unwrap();
    let hr: f64 = args[2].parse().unwrap();
    let cfl: f64 = args.get(3).map_or(0.4, |s| s.parse().unwrap());
    let g = 9.81;
    let width = 14.0 * dx;
    let bounds = Bounds { x_min: 0.0, x_max: 1000.0, y_min: 0.0, y_max: width };
    let edges = EdgeRules { bounds, rules: [EdgeRule::Wall, EdgeRule::Wall, EdgeRule::Periodic, EdgeRule::Periodic] };
    let terrain = Terrain::analytic(bounds, dx, |_, _| (0.0, [0.0, 0.0]));
    let volume = dx * dx * 10.0;
    let eta = 1.25;
    let body = |depth: f64, left: bool| {
        let b = if left { Bounds { x_max: 500.0, ..bounds } } else { Bounds { x_min: 500.0, ..bounds } };
        Body { depth: Box::leak(Box::new(move |_x: f64, _y: f64| depth)), inside: Box::leak(Box::new(move |x: f64, _: f64| (x < 500.0) == left)), within: b, volume, eta, largest_h: 6.0 * eta * dx, shallowest: 0.001 }
    };
    let t0 = Instant::now();
    let mut p = body(10.0, true).fill(&edges, 1);
    if hr > 0.0 { p.extend(body(hr, false).fill(&edges, 2)); }
    println!("{} particles seeded in {:?}; mean volume/nominal {}", p.len(), t0.elapsed(), p.iter().map(|p| p.volume).sum::<f64>() / p.len() as f64 / volume);
    let mut scheme = Balanced::new(Parameters { gravity: g, eta, largest_h: 6.0 * eta * dx, cfl });
    let mut dt = scheme.evaluate(&mut p, &edges, &terrain, 0.0);
    let (mut t, mut steps) = (0.0, 0);
    let end = 20.0;
    let t0 = Instant::now();
    let mut work = 0;
    while t < end {
        let step = f64::min(dt, end - t);
        for q in &mut p {
            q.u += 0.5 * step * q.ax;
            q.v += 0.5 * step * q.ay;
            let mut place = [q.x + step * q.u, q.y + step * q.v];
            let mut vel = [q.u, q.v];
            edges.keep(&mut place, &mut vel);
            [q.x, q.y] = place;
            [q.u, q.v] = vel;
        }
        dt = scheme.evaluate(&mut p, &edges, &terrain, 0.5 * step);
        for q in &mut p {
            q.u += 0.5 * step * q.ax;
            q.v += 0.5 * step * q.ay;
        }
        t += step;
        steps += 1;
        work += p.len();
        if steps % 200 == 0 { println!("t {t:.2} dt {dt:.4} umax {:.3}", p.iter().map(|q| q.u.hypot(q.v)).fold(0.0, f64::max)); }
    }
    let wall = t0.elapsed().as_secs_f64();
    println!("{steps} steps, {wall:.1} s, {:.3} M particle-steps/s", work as f64 / wall / 1e6);
    // sample
    let (mut e_sum, mut e_shep, mut norm) = (0.0, 0.0, 0.0);
    let rows = 7;
    for k in 0..1000 {
        let x = k as f64 + 0.5;
        let (he, _) = stoker(x - 500.0, 10.0, hr, end, g);
        norm += he;
        for r in 0..rows {
            let y = width * (r as f64 + 0.5) / rows as f64;
            let (mut s, mut w0, mut d0) = (0.0, 0.0, 0.0);
            for range in scheme.arrangement.cells.ranges(x, y, scheme.arrangement.cells.reach_at(x, y)) {
                for j in range {
                    let a = scheme.arrangement.entries[j];
                    let _ = a;
                    let (xj, yj) = (scheme.arrangement.x[j], scheme.arrangement.y[j]);
                    let c = scheme.probe(j);
                    let w = corpuscle_sph::kernel::cubic_spline::value_of_one((x - xj).hypot(y - yj), c.1);
                    s += w * c.0 * c.2;
                    w0 += w * c.2;
                    d0 += w * c.0 * c.2;
                }
            }
            e_sum += (s - he).abs() / rows as f64;
            e_shep += ((if w0 > 0.5 { d0 / w0 } else { 0.0 }) - he).abs() / rows as f64;
        }
    }
    println!("dx {dx} hr {hr}: kernel sum {:.2e} shepard {:.2e}", e_sum / norm, e_shep / norm);
    let px: f64 = p.iter().map(|q| q.volume * q.u).sum();
    println!("momentum {px:.1}, exact {:.1}", 0.5 * g * width * (100.0 - hr * hr) * end);
}

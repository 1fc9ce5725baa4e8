//! Tries the engine's speed: dimensions, balls, packing, seconds.
use corpuscle_gas::Setup;
use corpuscle_model::Model;
use std::sync::atomic::AtomicBool;

fn cpu() -> f64 {
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap();
    stat.split_whitespace().next().unwrap().parse::<f64>().unwrap() * 1e-9
}

fn rate<const D: usize>(n: usize, packing: f64, seconds: f64) {
    let start = cpu();
    let mut gas = Setup::<D>::fluid(n, packing).build().unwrap();
    let made = cpu() - start;
    let stop = AtomicBool::new(false);
    let go = |gas: &mut corpuscle_gas::Gas<D>, seconds: f64| {
        let (start, before, from, side) = (cpu(), gas.collisions(), gas.time(), gas.side_events());
        let mut step = 1e-3;
        while cpu() - start < seconds {
            let at = cpu();
            gas.advance_to(gas.time() + step, &stop).unwrap();
            step *= (0.05 * seconds / (cpu() - at)).clamp(0.5, 2.0);
        }
        let collisions = (gas.collisions() - before) as f64;
        let after = gas.side_events();
        (
            collisions / (cpu() - start) / 1e3,
            2.0 * collisions / (gas.time() - from) / n as f64,
            (after[0] - side[0]) as f64 / collisions,
            (after[1] - side[1]) as f64 / collisions,
        )
    };
    go(&mut gas, seconds);
    let (rate, per_ball, crossings, disturbed) = go(&mut gas, seconds);
    println!(
        "{D}D n={n} packing {packing}: {rate:.0} k/s, {per_ball:.3} per ball and time, crossings {crossings:.2}, disturbed {disturbed:.2}, {} bytes, made in {made:.1} s",
        gas.bytes() / n
    );
}

fn main() {
    let args: Vec<f64> = std::env::args().skip(1).map(|a| a.parse().unwrap()).collect();
    match args[0] as u32 {
        2 => rate::<2>(args[1] as usize, args[2], args[3]),
        _ => rate::<3>(args[1] as usize, args[2], args[3]),
    }
}

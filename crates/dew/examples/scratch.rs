use corpuscle_dew::air::Properties;
use corpuscle_dew::*;
use corpuscle_model::Model;
use std::f64::consts::PI;
use std::sync::atomic::AtomicBool;

fn go(dew: &mut Dew, t: f64) {
    dew.advance_to(t, &AtomicBool::new(false)).unwrap();
}

fn taylor_green(n: usize, background: f64, c: f64, sw: f64) {
    let d = 1.0 / n as f64;
    let room = Room { low: [0.0; 3], high: [1.0, 1.0, 6.0 * d], faces: [[Face::Periodic; 2]; 3] };
    let mut air = Properties::at_room_temperature(c);
    air.density = 1.0;
    air.viscosity = 0.01;
    air.spreading = background;
    air.conductivity = 1e-6;
    air.vapour_diffusivity = 1e-9;
    let mut settings = Settings::new(d, 300.0, 0.0);
    settings.gravity = [0.0; 3];
    settings.fog = false;
    let _ = sw;
    let mut dew = Dew::new(&Setup { settings, air, room, bodies: vec![], seed: 1 }, |p| [300.0 + p[0], 0.0]).unwrap();
    let u0 = 1.0;
    dew.stir(|p| {
        [
            u0 * (2.0 * PI * p[0]).sin() * (2.0 * PI * p[1]).cos(),
            -u0 * (2.0 * PI * p[0]).cos() * (2.0 * PI * p[1]).sin(),
            0.0,
        ]
    });
    let e0 = dew.air().iter().map(|p| p.speed_squared()).sum::<f64>();
    for k in 1..=5 {
        let t = 0.2 * k as f64;
        go(&mut dew, t);
        let e = dew.air().iter().map(|p| p.speed_squared()).sum::<f64>();
        let exact = (-4.0 * 4.0 * PI * PI * 0.01 * t).exp();
        let rho: Vec<f64> = dew.air().iter().map(|p| p.density).collect();
        let (lo, hi) = (rho.iter().cloned().fold(9.0, f64::min), rho.iter().cloned().fold(0.0, f64::max));
        let mean = rho.iter().sum::<f64>() / rho.len() as f64;
        // nearest pair
        let mut near: f64 = 9.0;
        let a = dew.air();
        for i in (0..a.len()).step_by(37) {
            for j in 0..a.len() {
                if i != j {
                    let mut s = 0.0;
                    for k in 0..3 {
                        let mut x = (a[i].position[k] - a[j].position[k]).abs();
                        let l = room.size()[k];
                        x = x.min(l - x);
                        s += x * x;
                    }
                    near = near.min(s.sqrt());
                }
            }
        }
        let m: Vec<f64> = (0..3).map(|k| a.iter().map(|p| p.velocity[k]).sum::<f64>()).collect();
        println!(
            "n={n} bg={background} c={c} t={t} e/exact={:.4} rho {:.4} {:.4} {:.4} nearest/d={:.3} mom {:?} steps {} dt {:.2e}",
            e / e0 / exact,
            lo,
            mean,
            hi,
            near / d,
            m,
            dew.steps(),
            dew.time_step()
        );
    }
}
fn main() {
    for bg in [0.1, 0.3, 1.0] {
        taylor_green(32, bg, 10.0, 0.0);
    }
}

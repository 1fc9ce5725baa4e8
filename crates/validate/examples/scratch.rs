//! Scratch.
fn main() {
    let name = std::env::args().nth(1).unwrap();
    for c in corpuscle_validate::cases().iter().filter(|c| c.name == name) {
        let t = std::time::Instant::now();
        for r in (c.run)(&Default::default()) {
            println!(
                "{:40} {:.4e} {} {} {:?} {:?}",
                r.measure,
                r.value.unwrap_or(f64::NAN),
                r.relation,
                r.bound,
                r.pass,
                r.reason
            );
        }
        println!("{:.1} s", t.elapsed().as_secs_f64());
    }
}

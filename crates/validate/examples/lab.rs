fn main() {
    let want: Vec<String> = std::env::args().skip(1).collect();
    let options = corpuscle_validate::Options { data: std::env::var_os("CORPUSCLE_DATA").map(Into::into), require_data: false };
    for case in corpuscle_validate::cases() {
        if want.iter().any(|w| case.name.contains(w.as_str())) {
            let t = std::time::Instant::now();
            for r in (case.run)(&options) { println!("{} {} {:?} {} {} {:?} {:?}", r.case, r.measure, r.value, r.relation, r.bound, r.pass, r.reason); }
            println!("   {:?}", t.elapsed());
        }
    }
}

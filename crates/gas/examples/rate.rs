fn main() {
    let args: Vec<f64> = std::env::args().skip(1).map(|a| a.parse().unwrap()).collect();
    if args[0] == 2.0 { corpuscle_gas::trial::rate::<2>(args[1] as usize, args[2], args[3]) } else { corpuscle_gas::trial::rate::<3>(args[1] as usize, args[2], args[3]) }
}

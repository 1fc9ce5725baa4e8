//! Scratch knobs.
use std::sync::OnceLock;
pub fn knob(k: usize, default: f64) -> f64 {
    static K: OnceLock<Vec<Option<f64>>> = OnceLock::new();
    K.get_or_init(|| (0..10).map(|k| std::env::var(format!("KNOB{k}")).ok().and_then(|s| s.parse().ok())).collect())[k].unwrap_or(default)
}

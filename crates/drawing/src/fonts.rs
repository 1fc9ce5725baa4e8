//! The letters of drawings: Inter, by Rasmus Andersson (SIL Open Font License 1.1: `fonts/OFL.txt`).

/// Letters of text, as an OpenType file.
pub const REGULAR: &[u8] = include_bytes!("../fonts/Inter-Regular.otf");
/// Letters that stand out.
pub const SEMI_BOLD: &[u8] = include_bytes!("../fonts/Inter-SemiBold.otf");

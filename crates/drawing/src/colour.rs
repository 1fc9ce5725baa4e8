//! Colours of numbers.

/// A colour: red, green, blue.
pub type Colour = [u8; 3];

/// Viridis (Smith & van der Walt 2015) at equal distances.
pub const VIRIDIS: [u32; 9] =
    [0x440154, 0x472d7b, 0x3b528b, 0x2c728e, 0x21918c, 0x28ae80, 0x5ec962, 0xaddc30, 0xfde725];

/// Red, green and blue of `0xrrggbb`.
pub fn split(colour: u32) -> Colour {
    [(colour >> 16) as u8, (colour >> 8) as u8, colour as u8]
}

/// The colour of a value, as a fraction, 0 to 1, of that of the last colour.
pub fn of_part(part: f64) -> Colour {
    let position = part.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let below = (position as usize).min(VIRIDIS.len() - 2);
    let [low, high] = [split(VIRIDIS[below]), split(VIRIDIS[below + 1])];
    mix(low, high, position - below as f64)
}

/// A colour between two.
pub fn mix(from: Colour, to: Colour, part: f64) -> Colour {
    std::array::from_fn(|k| (f64::from(from[k]) + (f64::from(to[k]) - f64::from(from[k])) * part).round() as u8)
}

/// A colour written as `#rrggbb`; none for another form.
pub fn from_hex(text: &str) -> Option<Colour> {
    u32::from_str_radix(text.strip_prefix('#').filter(|digits| digits.len() == 6)?, 16).ok().map(split)
}

/// A colour as a style sheet has it.
pub fn hex([r, g, b]: Colour) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_go_from_dark_to_light_and_stay_within() {
        assert_eq!(of_part(-1.0), [0x44, 0x01, 0x54]);
        assert_eq!(of_part(0.5), [0x21, 0x91, 0x8c]);
        assert_eq!(of_part(7.0), [0xfd, 0xe7, 0x25]);
        assert_eq!(hex(from_hex("#0072b2").unwrap()), "#0072b2");
        assert_eq!([from_hex("0072b2"), from_hex("#12"), from_hex("#zz72b2")], [None; 3]);
    }
}

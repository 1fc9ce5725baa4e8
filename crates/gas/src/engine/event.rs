//! What happens next to a ball.

/// What happens next to a ball.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(32))]
pub(crate) struct Event<const D: usize> {
    /// When, in the window; infinite for nothing.
    pub time: f64,
    /// With whom.
    pub what: What,
    /// The partner's `bends` when this was predicted; it is out of date when they differ now.
    pub partner_bends: u32,
    /// How often this ball's own path was bent.
    pub bends: u32,
    /// How often this ball's event was replaced: queue entries with another number are out of date.
    pub stamp: u32,
    /// Cell of the ball in the grid of its level, from 1 on along each axis.
    pub cell: [u16; D],
    /// Level of the grid that the ball is in.
    pub level: u8,
}

/// With what a ball meets: another ball, a cell's edge, a wall, or nothing, in one word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct What(pub u32);

impl What {
    pub const NOTHING: What = What(u32::MAX);
    const EDGE: u32 = 1 << 31;
    const WALL: u32 = 3 << 30;
    /// Of a ball: the pair comes to the rim of its well, not to contact.
    const RIM: u32 = 1 << 30;

    #[inline(always)]
    pub fn edge(axis: usize, up: bool) -> What {
        What(Self::EDGE | (axis as u32) << 1 | u32::from(up))
    }

    #[inline(always)]
    pub fn wall(wall: usize) -> What {
        What(Self::WALL | wall as u32)
    }

    #[inline(always)]
    pub fn pair(ball: u32, rim: bool) -> What {
        What(if rim { Self::RIM | ball } else { ball })
    }

    /// The ball, if it is one.
    #[inline(always)]
    pub fn ball(self) -> Option<usize> {
        (self.0 & Self::EDGE == 0).then_some((self.0 & !Self::RIM) as usize)
    }

    /// True where it is a ball at the rim of a well.
    #[inline(always)]
    pub fn is_rim(self) -> bool {
        self.0 & Self::WALL == Self::RIM
    }

    /// The wall, if it is one.
    #[inline(always)]
    pub fn as_wall(self) -> Option<usize> {
        (self.0 & Self::WALL == Self::WALL && self != Self::NOTHING).then_some((self.0 & !Self::WALL) as usize)
    }

    /// Axis and direction of the cell's edge that is crossed, if it is one.
    #[inline(always)]
    pub fn as_edge(self) -> Option<(usize, bool)> {
        (self.0 & Self::WALL == Self::EDGE).then_some(((self.0 as usize & 7) >> 1, self.0 & 1 == 1))
    }
}

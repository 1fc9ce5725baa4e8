//! What the engine keeps for each ball.

use serde::{Deserialize, Serialize};

/// Stands for "no ball" in lists of balls.
pub(crate) const NONE: u32 = u32::MAX;

/// What every prediction reads of a ball: one cache line.
///
/// Balls are asynchronous: each is stored as it was when it last took part in something that bent its path, and flies freely since.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(crate) struct Ball<const D: usize> {
    /// Centre at `time`, in the image of the box where the ball is now.
    pub position: [f64; D],
    /// Velocity at `time`.
    pub velocity: [f64; D],
    /// The ball's own time, in the window.
    pub time: f64,
    /// Row in the table of [`Kind`]s.
    pub kind: u32,
    /// The next ball in the same cell.
    pub next: u32,
}

/// Radius and mass; balls that are alike share a row.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct Kind {
    pub radius: f64,
    pub mass: f64,
}

/// What is read only when a ball crosses the box's edge, and for measuring.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Record<const D: usize> {
    /// The ball's lasting number.
    pub id: u32,
    pub species: u32,
    /// How many box lengths have been taken off the position.
    pub image: [i32; D],
    /// Time of the last collision with a ball, in the window.
    pub collided: f64,
}

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

    #[inline(always)]
    pub fn edge(axis: usize, up: bool) -> What {
        What(Self::EDGE | (axis as u32) << 1 | u32::from(up))
    }

    #[inline(always)]
    pub fn wall(wall: usize) -> What {
        What(Self::WALL | wall as u32)
    }

    /// The ball, if it is one.
    #[inline(always)]
    pub fn ball(self) -> Option<usize> {
        (self.0 & Self::EDGE == 0).then_some(self.0 as usize)
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

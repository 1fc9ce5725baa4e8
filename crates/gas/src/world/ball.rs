//! What is kept of each ball.

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

/// Radius and mass; equal balls share a row.
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

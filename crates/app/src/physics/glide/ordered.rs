//! What the device was asked to do and has not done.

use corpuscle::gpu::{Gpu, wgpu};
use std::collections::VecDeque;
use std::time::Instant;

/// What is ordered and not done takes about so long, s: the window's pictures wait behind it.
const AHEAD: f64 = 0.012;
/// So many steps are ordered and not done, at most.
const MOST: f64 = 64.0;
/// Weight of the newest step in what a step takes.
const NEWEST: f64 = 0.2;

/// Steps that a device was asked for.
pub(super) struct Ordered<'a> {
    gpu: &'a Gpu,
    steps: VecDeque<wgpu::SubmissionIndex>,
    /// What a step takes, s.
    takes: f64,
    /// When the last was ordered.
    last: Instant,
}

impl<'a> Ordered<'a> {
    pub fn new(gpu: &'a Gpu) -> Self {
        Self { gpu, steps: VecDeque::new(), takes: AHEAD, last: Instant::now() }
    }

    /// Another step was ordered: waits until no more are left to do than should be.
    pub fn wait(&mut self) {
        self.steps.push_back(self.gpu.queue.submit([]));
        let ahead = (AHEAD / self.takes.max(1e-9)).clamp(1.0, MOST) as usize;
        while self.steps.len() > ahead {
            let submission_index = self.steps.pop_front();
            // A device that is lost is told of by whoever reads from it next.
            let _ = self.gpu.device.poll(wgpu::PollType::Wait { submission_index, timeout: None });
        }
        self.takes += NEWEST * (self.last.elapsed().as_secs_f64() - self.takes);
    }

    /// From now on a step is ordered.
    pub fn begin(&mut self) {
        self.last = Instant::now();
    }
}

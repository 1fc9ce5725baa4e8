//! Entries that are being moved to their buckets.
//!
//! An entry goes to any of millions of buckets: its slot in the ring is in no cache, nor is the chunk there. So it waits while other
//! events are handled; what it needs is prefetched, first the slot in the ring, then the chunk.

use super::{Queue, Slip};
use crate::memory;

/// Entries that wait.
const ROOM: usize = 16;

/// Entries for buckets nearer to the front than this do not wait.
const FAR: u64 = 200;

/// Entries that wait, in a ring.
#[derive(Debug)]
pub(super) struct Mail {
    letters: [(u64, Slip); ROOM],
    posted: usize,
    /// No bucket that an entry waits for is before this.
    first: u64,
}

impl Mail {
    pub fn new() -> Self {
        Mail { letters: [(0, Slip::default()); ROOM], posted: 0, first: u64::MAX }
    }
}

impl Queue {
    /// True for buckets of the ring far enough from the front.
    #[inline(always)]
    pub(super) fn is_far(&self, bucket: u64) -> bool {
        (self.front_bucket + FAR..self.front_bucket + self.ring.len() as u64).contains(&bucket)
    }

    /// Takes in an entry, and files the one that has waited longest.
    #[inline(always)]
    pub(super) fn post(&mut self, bucket: u64, slip: Slip) {
        let at = self.mail.posted & (ROOM - 1);
        let (longest, half) = (self.mail.letters[at], self.mail.letters[(at + ROOM / 2) & (ROOM - 1)]);
        if self.mail.posted >= ROOM {
            self.file(longest.0, longest.1);
        }
        if self.mail.posted >= ROOM / 2 {
            self.ask_for_chunk(half.0);
        }
        memory::prefetch(&self.ring[bucket as usize & (self.ring.len() - 1)]);
        self.mail.letters[at] = (bucket, slip);
        self.mail.first = self.mail.first.min(bucket);
        self.mail.posted += 1;
    }

    /// Files all that wait, if the front has come near one of their buckets or nothing else is left.
    #[inline(always)]
    pub(super) fn deliver_when_due(&mut self) {
        if self.mail.first <= self.front_bucket + FAR / 2 || self.in_ring == 0 {
            self.deliver();
        }
    }

    #[cold]
    fn deliver(&mut self) {
        for at in self.mail.posted.saturating_sub(ROOM)..self.mail.posted {
            let (bucket, slip) = self.mail.letters[at & (ROOM - 1)];
            self.file(bucket, slip);
        }
        self.mail = Mail::new();
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::event::{Event, What};
    use super::Queue;

    const MANY: usize = 5000;

    /// Numbers without order from 0 to 1: parts of the multiples of the golden ratio (Weyl 1916).
    fn scattered(number: usize) -> f64 {
        (number as f64 * 0.618_033_988_749_894_9).fract()
    }

    #[test]
    fn entries_that_went_by_mail_come_out_in_order() {
        let event = |ball: usize| Event::<3> {
            time: scattered(ball),
            what: What::NOTHING,
            partner_bends: 0,
            bends: 0,
            stamp: 0,
            cell: [1; 3],
            level: 0,
        };
        let mut events: Vec<Event<3>> = (0..MANY).map(event).collect();
        let mut queue = Queue::new(&events, true);
        for (ball, event) in events.iter().enumerate() {
            queue.push(event.time, ball as u32, event.stamp);
        }
        assert!(queue.mail.posted > MANY / 2);
        let (mut last, mut handled) = (0.0, 0);
        let mut seen = vec![None; MANY];
        while let Some((time, ball)) = queue.peek(&events) {
            queue.pop();
            assert!(time >= last && time == events[ball as usize].time);
            seen[ball as usize] = Some(events[ball as usize].stamp);
            (last, handled) = (time, handled + 1);
            // Every third has something else to come, near or far; of others it is put off before its time.
            let event = &mut events[(ball as usize + handled % 3) % MANY];
            if handled < 2 * MANY && handled % 3 != 2 && (handled % 3 == 0 || event.time > time) {
                (event.time, event.stamp) = (time + scattered(handled).powi(4), event.stamp + 1);
                queue.push(event.time, ((ball as usize + handled % 3) % MANY) as u32, event.stamp);
            }
        }
        let lost = seen.iter().zip(&events).filter(|(seen, event)| **seen != Some(event.stamp)).count();
        assert!(lost == 0 && handled > MANY, "{lost} lost of {handled}");
    }
}

//! The queue of coming events, at a cost per event that does not depend on their number.
//!
//! A bounded increasing priority queue (G. Paul, J. Comput. Phys. 221, 2007, 615): a ring of buckets, each for a short
//! span of time. Only the bucket at the front is kept in order. An entry names a ball and the number of its event; the
//! time is in the ball's own record. Entries are not taken out when a ball's event is replaced: their number no longer
//! fits, and they are skipped when their bucket comes up.

mod mail;

use super::event::Event;
use crate::memory;
use crate::world::NONE;
use mail::Mail;

/// How many entries a bucket has when it comes up, about: with few balls; and with many, where coming buckets are prefetched
/// one by one.
const PER_BUCKET: [f64; 2] = [8.0, 3.0];

/// Entries in a chunk; what is left of its cache line links it.
const ROOM: usize = 7;

/// An index in the chunks is the number of a chunk and, in the last bits, of an entry; a full chunk's index has all of these set.
const BITS: u32 = 3;
const FULL: u32 = ROOM as u32;

/// A queue entry.
#[derive(Debug, Clone, Copy, Default)]
struct Slip {
    ball: u32,
    stamp: u32,
}

/// Some entries of a bucket: one cache line.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
struct Chunk {
    slips: [Slip; ROOM],
    /// Index after the last entry of the chunk before, which is full.
    next: u32,
}

/// An entry of the front bucket. Ordered by time, then by ball: the order of equal times is defined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Due {
    /// Bits of the time: for numbers from 0 on they are in the same order.
    time: u64,
    ball: u32,
    stamp: u32,
}

/// Coming events in order of time.
#[derive(Debug)]
pub(crate) struct Queue {
    per_time: f64,
    /// Where the next entry of each bucket goes.
    ring: Vec<u32>,
    chunks: Vec<Chunk>,
    free: u32,
    /// Number of the front bucket; bucket `b` is at `ring[b % ring.len()]`.
    front_bucket: u64,
    /// The front bucket, latest first.
    front: Vec<Due>,
    in_ring: usize,
    /// Entries for times beyond the ring.
    later: Vec<Slip>,
    mail: Mail,
    /// True where entries go by mail.
    many: bool,
}

impl Queue {
    /// An empty queue for times from 0 on, its buckets fit for `events`; with `many` of them, entries go by mail.
    pub fn new<const D: usize>(events: &[Event<D>], many: bool) -> Self {
        let mut times: Vec<f64> = events.iter().map(|event| event.time).filter(|time| time.is_finite()).collect();
        let nth = times.len() / 4;
        let per_time = if times.is_empty() {
            1.0
        } else {
            let (_, soon, _) = times.select_nth_unstable_by(nth, f64::total_cmp);
            ((nth + 1) as f64 / PER_BUCKET[usize::from(many)] / soon.max(f64::MIN_POSITIVE)).min(1e300)
        };
        let buckets = events.len().next_power_of_two().max(64);
        Queue {
            per_time,
            ring: memory::filled(buckets, NONE),
            chunks: memory::reserved(events.len() / 2),
            free: NONE,
            front_bucket: 0,
            front: Vec::with_capacity(64),
            in_ring: 0,
            later: Vec::new(),
            mail: Mail::new(),
            many,
        }
    }

    /// Puts in the event of a ball.
    #[inline(always)]
    pub fn push(&mut self, time: f64, ball: u32, stamp: u32) {
        if time == f64::INFINITY {
            return;
        }
        let bucket = (time * self.per_time) as i64 as u64;
        if bucket <= self.front_bucket {
            let due = Due { time: time.to_bits(), ball, stamp };
            let at = self.front.partition_point(|other| *other > due);
            self.front.insert(at, due);
        } else if self.many && self.is_far(bucket) {
            self.post(bucket, Slip { ball, stamp });
        } else {
            self.file(bucket, Slip { ball, stamp });
        }
    }

    #[inline(always)]
    fn file(&mut self, bucket: u64, slip: Slip) {
        if bucket >= self.front_bucket + self.ring.len() as u64 {
            self.later.push(slip);
            return;
        }
        self.in_ring += 1;
        let slot = bucket as usize & (self.ring.len() - 1);
        let index = self.ring[slot];
        if index & FULL != FULL {
            self.chunks[(index >> BITS) as usize].slips[(index & FULL) as usize] = slip;
            self.ring[slot] = index + 1;
        } else {
            self.ring[slot] = self.new_chunk(slip, index);
        }
    }

    /// A chunk with one entry, before the full one at `next`; where the next entry goes.
    fn new_chunk(&mut self, slip: Slip, next: u32) -> u32 {
        let mut at = self.free;
        if at == NONE {
            at = self.chunks.len() as u32;
            self.chunks.push(Chunk { slips: [Slip::default(); ROOM], next: NONE });
        }
        let chunk = &mut self.chunks[at as usize];
        self.free = chunk.next;
        (chunk.slips[0], chunk.next) = (slip, next);
        at << BITS | 1
    }

    /// Time and ball of the next event that is not out of date, which stays in.
    #[inline(always)]
    pub fn peek<const D: usize>(&mut self, events: &[Event<D>]) -> Option<(f64, u32)> {
        loop {
            while let Some(due) = self.front.last() {
                if events[due.ball as usize].stamp == due.stamp {
                    return Some((f64::from_bits(due.time), due.ball));
                }
                self.front.pop();
            }
            if !self.turn(events) {
                return None;
            }
        }
    }

    /// Takes out what [`Queue::peek`] showed.
    #[inline(always)]
    pub fn pop(&mut self) {
        self.front.pop();
    }

    /// Goes on to the next bucket; false where nothing is left.
    fn turn<const D: usize>(&mut self, events: &[Event<D>]) -> bool {
        let round = self.ring.len() as u64;
        self.deliver_when_due();
        if self.in_ring == 0 && !self.skip(events) {
            return false;
        }
        self.front_bucket += 1;
        if self.front_bucket.is_multiple_of(round) {
            self.bring_in(events);
        }
        let slot = self.front_bucket as usize & (self.ring.len() - 1);
        let mut index = std::mem::replace(&mut self.ring[slot], NONE);
        while index != NONE {
            let (at, len) = (index >> BITS, index & FULL);
            let chunk = self.chunks[at as usize];
            for slip in &chunk.slips[..len as usize] {
                let event = &events[slip.ball as usize];
                if event.stamp == slip.stamp {
                    self.front.push(Due { time: event.time.to_bits(), ball: slip.ball, stamp: slip.stamp });
                }
            }
            self.in_ring -= len as usize;
            self.chunks[at as usize].next = self.free;
            self.free = at;
            index = chunk.next;
        }
        self.front.sort_unstable_by(|a, b| b.cmp(a));
        true
    }

    /// With the ring empty, goes to just before the first later entry.
    #[cold]
    fn skip<const D: usize>(&mut self, events: &[Event<D>]) -> bool {
        self.later.retain(|slip| events[slip.ball as usize].stamp == slip.stamp);
        let bucket = |slip: &Slip| (events[slip.ball as usize].time * self.per_time) as i64 as u64;
        let Some(first) = self.later.iter().map(bucket).min() else { return false };
        self.front_bucket = first - 1;
        self.bring_in(events);
        true
    }

    /// Files the later entries whose buckets are now in the ring.
    #[cold]
    fn bring_in<const D: usize>(&mut self, events: &[Event<D>]) {
        for slip in std::mem::take(&mut self.later) {
            let event = &events[slip.ball as usize];
            if event.stamp == slip.stamp {
                let bucket = (event.time * self.per_time) as i64 as u64;
                self.file(bucket, slip);
            }
        }
    }

    /// Number of the bucket at the front.
    #[inline(always)]
    pub fn front_bucket(&self) -> u64 {
        self.front_bucket
    }

    /// Prefetches the memory of the last chunk of a bucket in the ring.
    #[inline(always)]
    pub fn ask_for_chunk(&self, bucket: u64) {
        let index = self.ring[bucket as usize & (self.ring.len() - 1)];
        if index != NONE {
            memory::prefetch(&self.chunks[(index >> BITS) as usize]);
        }
    }

    /// Calls `visit` with ball and number of the entries in a bucket of the ring.
    #[inline(always)]
    pub fn each_in(&self, bucket: u64, mut visit: impl FnMut(u32, u32)) {
        let mut index = self.ring[bucket as usize & (self.ring.len() - 1)];
        while index != NONE {
            let chunk = &self.chunks[(index >> BITS) as usize];
            chunk.slips[..(index & FULL) as usize].iter().for_each(|slip| visit(slip.ball, slip.stamp));
            index = chunk.next;
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.ring.capacity() * 4 + self.chunks.len() * size_of::<Chunk>() + self.later.capacity() * size_of::<Slip>()
    }
}

//! Processes that `mpirun` started.

use corpuscle_processes::{Link, Processes};
use mpi::Threading;
use mpi::collective::SystemOperation;
use mpi::datatype::PartitionMut;
use mpi::environment::Universe;
use mpi::request::{Request, scope};
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, CommunicatorCollectives, Destination, Source};
use std::sync::Arc;

/// Bytes sent at a time: MPI counts them in 32 bits.
const PIECE: usize = 1 << 30;

/// A process among those of `mpirun`. Messages between two arrive in the order in which they were sent, so that tags are not used.
struct Process {
    rank: usize,
    count: usize,
    /// Ends MPI when it is dropped.
    _universe: Universe,
}

/// The processes that `mpirun` started together with this one; this one alone where it was started by itself, or has joined them before. MPI ends
/// when the last copy is dropped.
pub fn connect() -> Processes {
    // Steps are taken by threads, one at a time.
    let wanted = Threading::Serialized;
    let Some((universe, provided)) = mpi::initialize_with_threading(wanted) else { return Processes::alone() };
    assert!(provided >= wanted, "this MPI library cannot be called from several threads: {provided:?}");
    let world = universe.world();
    let (rank, count) = (world.rank() as usize, world.size() as usize);
    if count > 1 {
        end_all_on_panic();
    }
    Processes::of(Arc::new(Process { rank, count, _universe: universe }))
}

/// Has a panic end all processes: the others would wait for this one.
fn end_all_on_panic() {
    let tell = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        tell(panic);
        world().abort(101);
    }));
}

/// All processes. Not stored: it belongs to the thread that asks.
fn world() -> SimpleCommunicator {
    SimpleCommunicator::world()
}

impl Link for Process {
    fn rank(&self) -> usize {
        self.rank
    }

    fn count(&self) -> usize {
        self.count
    }

    fn exchange(&self, outgoing: &[(usize, Vec<f64>)], incoming: &mut [(usize, Vec<f64>)]) {
        let world = world();
        scope(|scope| {
            let to = |rank: usize| world.process_at_rank(rank as i32);
            let sent: Vec<_> =
                outgoing.iter().map(|(rank, numbers)| to(*rank).immediate_send(scope, &numbers[..])).collect();
            for (from, numbers) in incoming {
                world.process_at_rank(*from as i32).receive_into(&mut numbers[..]);
            }
            sent.into_iter().for_each(Request::wait_without_status);
        });
    }

    fn send_receive(&self, outgoing: &[(usize, &[u8])], from: &[usize]) -> Vec<Vec<u8>> {
        let world = world();
        let lengths: Vec<u64> = outgoing.iter().map(|(_, bytes)| bytes.len() as u64).collect();
        scope(|scope| {
            let to = |rank: usize| world.process_at_rank(rank as i32);
            let of_lengths =
                outgoing.iter().zip(&lengths).map(|((rank, _), length)| to(*rank).immediate_send(scope, length));
            let of_lengths: Vec<_> = of_lengths.collect();
            let pieces = outgoing.iter().flat_map(|(rank, bytes)| bytes.chunks(PIECE).map(|piece| (*rank, piece)));
            let sent: Vec<_> = pieces.map(|(rank, piece)| to(rank).immediate_send(scope, piece)).collect();
            let receive = |from: &usize| {
                let from = world.process_at_rank(*from as i32);
                let (length, _) = from.receive::<u64>();
                let mut bytes = vec![0; length as usize];
                for piece in bytes.chunks_mut(PIECE) {
                    from.receive_into(piece);
                }
                bytes
            };
            let received = from.iter().map(receive).collect();
            of_lengths.into_iter().for_each(Request::wait_without_status);
            sent.into_iter().for_each(Request::wait_without_status);
            received
        })
    }

    fn all_gather(&self, bytes: &[u8]) -> Vec<Vec<u8>> {
        let world = world();
        let mut lengths = vec![0_u64; self.count];
        world.all_gather_into(&(bytes.len() as u64), &mut lengths[..]);
        if lengths.iter().sum::<u64>() > PIECE as u64 {
            let all: Vec<usize> = (0..self.count).collect();
            return self.send_receive(&all.iter().map(|to| (*to, bytes)).collect::<Vec<_>>(), &all);
        }
        let lengths: Vec<i32> = lengths.into_iter().map(|length| length as i32).collect();
        let starts: Vec<i32> =
            lengths.iter().scan(0, |start, length| Some(std::mem::replace(start, *start + length))).collect();
        // One byte more at both: Open MPI takes the address of an empty vector, 1, for that of no buffer at all.
        let own = [bytes, &[0]].concat();
        let mut all = vec![0; 1 + lengths.iter().map(|length| *length as usize).sum::<usize>()];
        let own = &own[..bytes.len()];
        world.all_gather_varcount_into(own, &mut PartitionMut::new(&mut all[..], lengths.clone(), &starts[..]));
        starts.iter().zip(lengths).map(|(start, length)| all[*start as usize..][..length as usize].to_vec()).collect()
    }

    fn min(&self, values: &mut [f64]) {
        let own = values.to_vec();
        world().all_reduce_into(&own[..], values, SystemOperation::min());
    }

    fn sum(&self, values: &mut [i64]) {
        let own = values.to_vec();
        world().all_reduce_into(&own[..], values, SystemOperation::sum());
    }
}

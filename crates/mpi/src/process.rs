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

/// A process among those of `mpirun`. Messages between two arrive in the order in which they were sent, so that they need no names.
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
    let Some((universe, _)) = mpi::initialize_with_threading(Threading::Serialized) else { return Processes::alone() };
    let world = universe.world();
    let (rank, count) = (world.rank() as usize, world.size() as usize);
    Processes::of(Arc::new(Process { rank, count, _universe: universe }))
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

    fn pass(&self, outgoing: &[(usize, Vec<u8>)], from: &[usize]) -> Vec<Vec<u8>> {
        let world = world();
        scope(|scope| {
            let to = |rank: usize| world.process_at_rank(rank as i32);
            let sent: Vec<_> =
                outgoing.iter().map(|(rank, bytes)| to(*rank).immediate_send(scope, &bytes[..])).collect();
            let received = from.iter().map(|from| world.process_at_rank(*from as i32).receive_vec().0).collect();
            sent.into_iter().for_each(Request::wait_without_status);
            received
        })
    }

    fn all_gather(&self, bytes: &[u8]) -> Vec<Vec<u8>> {
        let world = world();
        let mut lengths = vec![0; self.count];
        world.all_gather_into(&(bytes.len() as i32), &mut lengths[..]);
        let starts: Vec<i32> =
            lengths.iter().scan(0, |start, length| Some(std::mem::replace(start, *start + length))).collect();
        // One byte more at both: Open MPI takes the address of an empty vector, 1, for that of no buffer at all.
        let own = [bytes, &[0]].concat();
        let mut all = vec![0; 1 + lengths.iter().map(|length| *length as usize).sum::<usize>()];
        let own = &own[..bytes.len()];
        world.all_gather_varcount_into(own, &mut PartitionMut::new(&mut all[..], lengths.clone(), &starts[..]));
        starts.iter().zip(lengths).map(|(start, length)| all[*start as usize..][..length as usize].to_vec()).collect()
    }

    fn least(&self, values: &mut [f64]) {
        let own = values.to_vec();
        world().all_reduce_into(&own[..], values, SystemOperation::min());
    }

    fn total(&self, values: &mut [i64]) {
        let own = values.to_vec();
        world().all_reduce_into(&own[..], values, SystemOperation::sum());
    }
}

//! The counting sort on the device sorts as one sorts.

use corpuscle_gpu::{CellSort, Gpu, Pass, SortSlots, THREADS, read, require_gpu, sort_blocks, storage, wait_for, wgpu};

/// Sorts particles of the given cells, with keys that run against their numbers; `order` and `start`.
fn sorted(gpu: &Gpu, cell_of: &[u32], cells: usize) -> (Vec<u32>, Vec<u32>) {
    let count = cell_of.len();
    let sizes = storage::<u32>(gpu, "sizes", 2).unwrap();
    let keys = storage::<u32>(gpu, "keys", count).unwrap();
    let groups = storage::<[u32; 3]>(gpu, "groups", 4).unwrap();
    let sort = CellSort::new(gpu, count, cells, &sizes, &keys).unwrap();
    let mut counts = vec![0_u32; cells];
    let slots = cell_of.iter().map(|&cell| {
        counts[cell as usize] += 1;
        [cell, counts[cell as usize] - 1]
    });
    let slots: Vec<[u32; 2]> = slots.collect();
    let threads = |of: usize| [of.div_ceil(THREADS as usize) as u32, 1, 1];
    let write = |buffer: &wgpu::Buffer, bytes: &[u8]| gpu.queue.write_buffer(buffer, 0, bytes);
    write(&sizes, bytemuck::bytes_of(&[count as u32, cells as u32]));
    write(&keys, bytemuck::cast_slice(&(0..count as u32).rev().collect::<Vec<_>>()));
    write(&groups, bytemuck::bytes_of(&[threads(count), threads(cells), [sort_blocks(cells) as u32, 1, 1], [1, 1, 1]]));
    write(&sort.counts, bytemuck::cast_slice(&counts));
    write(&sort.cell_slots, bytemuck::cast_slice(&slots));
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut pass = Pass::begin(&mut encoder, None);
    sort.sort(&mut pass, &groups, SortSlots::FIRST);
    drop(pass);
    gpu.queue.submit([encoder.finish()]);
    assert!(wait_for(read::<u32>(gpu, &sort.counts, cells)).unwrap().iter().all(|&count| count == 0));
    (wait_for(read(gpu, &sort.order, count)).unwrap(), wait_for(read(gpu, &sort.start, cells + 1)).unwrap())
}

#[test]
fn particles_come_by_cell_and_then_by_key() {
    let Some(gpu) = require_gpu("the sort on the device") else { return };
    for (count, cells) in [(0, 1), (1, 1), (300, 1), (257, 3), (70_000, 300_000), (100_000, 5000)] {
        // Multiples of a large prime scatter well.
        let cell_of: Vec<u32> = (0..count as u64).map(|k| (k * 2_654_435_761 % cells as u64) as u32).collect();
        let (order, start) = sorted(&gpu, &cell_of, cells);
        let mut expected: Vec<u32> = (0..count as u32).collect();
        expected.sort_by_key(|&particle| (cell_of[particle as usize], u32::MAX - particle));
        assert!(order == expected, "{count} in {cells} cells");
        let first = |cell: u32| expected.partition_point(|&particle| cell_of[particle as usize] < cell) as u32;
        assert!((0..=cells as u32).all(|cell| start[cell as usize] == first(cell)), "{count} in {cells} cells");
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let Some(gpu) = require_gpu("limits of the device") else { return };
    let sizes = storage::<u32>(&gpu, "sizes", 2).unwrap();
    let error = CellSort::new(&gpu, 20_000_000, 1, &sizes, &sizes).unwrap_err().to_string();
    assert!(error.contains("20000000") && error.contains("--backend cpu"), "{error}");
    let error = storage::<[f32; 16]>(&gpu, "particles", usize::MAX / 128).unwrap_err().to_string();
    assert!(error.contains("particles take") && error.contains(&gpu.name), "{error}");
}

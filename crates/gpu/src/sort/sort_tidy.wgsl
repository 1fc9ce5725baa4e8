// Orders the few particles of each cell by their keys, by insertion. (Software Vulkan goes through a loop 65535 times at most: there
// some 350 particles of one cell are put in order, and what more there are stays as it came.)
#import declared

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) thread: vec3u) {
    let cell = thread.x;
    if cell >= sizes.cells {
        return;
    }
    let first = start[cell];
    let end = start[cell + 1u];
    for (var next = first + 1u; next < end; next++) {
        let particle = order[next];
        let key = keys[particle];
        var index = next;
        while index > first && keys[order[index - 1u]] > key {
            order[index] = order[index - 1u];
            index -= 1u;
        }
        order[index] = particle;
    }
}

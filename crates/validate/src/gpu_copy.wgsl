// Copies a buffer to another, sixteen bytes at a time.
#import declared

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    let first = group.x * GROUP * EACH + thread;
    for (var k = 0u; k < EACH; k++) {
        let at = first + GROUP * k;
        if at < arrayLength(&copied) {
            copied[at] = source[at];
        }
    }
}

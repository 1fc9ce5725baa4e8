// Copies a buffer to another, sixteen bytes at a time.

@group(0) @binding(0) var<storage, read> source: array<vec4u>;
@group(0) @binding(1) var<storage, read_write> copied: array<vec4u>;

// Each thread copies so many of them, so that a gibibyte is within the groups that there can be.
const EACH = 16u;

@compute @workgroup_size(256)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    let first = group.x * 256u * EACH + thread;
    for (var k = 0u; k < EACH; k++) {
        let at = first + 256u * k;
        if at < arrayLength(&copied) {
            copied[at] = source[at];
        }
    }
}

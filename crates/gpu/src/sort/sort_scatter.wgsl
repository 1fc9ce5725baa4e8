// Puts each particle to its place in sorted order.
#import sort_groups

@group(0) @binding(0) var<storage, read> sizes: Sizes;
@group(0) @binding(1) var<storage, read> places: array<vec2u>;
@group(0) @binding(2) var<storage, read> start: array<u32>;
@group(0) @binding(3) var<storage, read_write> order: array<u32>;

@compute @workgroup_size(256)
fn main(@builtin(global_invocation_id) thread: vec3u) {
    let particle = thread.x;
    if particle < sizes.particles {
        let place = places[particle];
        order[start[place.x] + place.y] = particle;
    }
}

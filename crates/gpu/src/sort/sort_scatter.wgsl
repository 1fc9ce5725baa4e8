// Puts each particle to its place in sorted order.
#import declared

@compute @workgroup_size(GROUP)
fn main(@builtin(global_invocation_id) thread: vec3u) {
    let particle = thread.x;
    if particle < sizes.particles {
        let place = places[particle];
        order[start[place.x] + place.y] = particle;
    }
}
